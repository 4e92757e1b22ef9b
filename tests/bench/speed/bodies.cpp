// Error x time on bodies other than the sphere, under the forest and a hard sun, and the same in
// Cycles, flat triangle for flat triangle.

#include "tests/bench/speed/blender.h"
#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"
#include "tests/bench/speed/sunrise.h"
#include "tests/server/temp_folder.h"
#include "tests/support/meshes.h"

namespace translucube::speed {
namespace {

constexpr int body_size = 128;
constexpr Quantity trimmed_error{"relMSE"}, our_cost{"relMSE × CPU s"},
    cycles_cost{"Cycles, relMSE × CPU s"}, gain{"Cycles / ours", "%.1f"},
    mean_ratio{"mean, of Cycles'", "%.3f"}, brightest{"largest pixel / converged", "%.1f"};

struct BenchMaterial {
  const char* name;
  std::uint32_t cycles_samples;
  double target;  ///< Cycles / ours
};
constexpr BenchMaterial bench_materials[] = {{"S1", 32, 30}, {"S10", 16, 30}, {"S100", 4, 30},
                                             {"M", 16, 30},  {"C", 16, 30},   {"R10", 32, 5},
                                             {"R25", 32, 5}};

struct BenchBody {
  const char* name;
  TriangleMesh mesh;
  Vec3 camera;
  std::optional<ObjectSpec> object = {};  ///< the same, where this renderer has it by itself
};

/// Within the unit sphere.
TriangleMesh in_unit_sphere(TriangleMesh mesh) {
  double radius2 = 0;
  for (const Vec3& v : mesh.vertices) radius2 = std::max(radius2, length_squared(v));
  for (Vec3& v : mesh.vertices) v = v * (1 / std::sqrt(radius2));
  return mesh;
}

struct Sky {
  const char* name;
  std::filesystem::path file;
};

void add_rows(Run& run, const BenchBody& body, const Sky& sky, Table& table) {
  const server::test::TempFolder folder;
  test::write_obj(body.mesh, folder / "body.obj");
  std::vector<CyclesTask> tasks;
  for (const auto& [name, samples, target] : bench_materials)
    if (run.chosen(name)) tasks.push_back({name, samples});
  CyclesAnswer cycles;
  if (why_not_cycles(run).empty())
    cycles = render_in_cycles(
        run, sky.file, body_size, tasks,
        "--mesh " + (folder / "body.obj").string() +
            text(" --camera %g,%g,%g", body.camera.x, body.camera.y, body.camera.z));
  for (const auto& [name, samples, target] : bench_materials) {
    if (!run.chosen(name)) continue;
    const Coefficients& c = peer_material(name).coefficients;
    SceneSpec spec = peer_scene(c, body_size, 0);
    spec.object = body.object.value_or(MeshObject{folder / "body.obj", false});
    spec.environment.source = ImageEnvironmentSpec{sky.file};
    spec.camera.position_mm = body.camera;
    const Pair pair =
        render_pair(run, spec, run.material_samples > 0 ? run.material_samples : run.samples(64));
    const RelMse error = pair.error();
    const double cost = error.trimmed * pair.cpu_seconds;
    const std::string row = text("%s, %s, %s", body.name, sky.name, name);
    table.add(row, ns_a_sample, pair.ns_per_sample());
    table.add(row, trimmed_error, error.trimmed);
    table.add(row, untrimmed_cost, error.untrimmed * pair.cpu_seconds);
    table.add(row, our_cost, cost);
    table.add(row, brightest, largest_ratio(pair.a, mean_of({pair.a, pair.b})));
    const auto found = cycles.pairs.find(name);
    if (found == cycles.pairs.end()) continue;
    const CyclesPair& peer = found->second;
    const double theirs =
        rel_mse_of_pair(peer.images.at(0), peer.images.at(1), reference_of(peer.images, c))
            .trimmed *
        peer.cpu_seconds;
    table.add(row, cycles_cost, theirs);
    table.add(row, gain, theirs / cost, at_least(target));
    table.add(row, mean_ratio, mean_value({pair.a, pair.b}) / mean_value(peer.images));
  }
}

}  // namespace

Tables bodies(Run& run) {
  Table table{"bodies", "Other bodies",
              "Meshes within the unit sphere, 128 × 128 pixels, 64 camera samples at full effort: "
              "a knot of 100,000 triangles, a cube (ours: the object), an icosphere of 81,920, "
              "all flat, in Cycles too (`speed --only bodies --cycles`). Largest pixel: over the "
              "mean of two renders, "
              "of at least 0.01."};
  table.remark = why_not_cycles(run);
  const double edge = 2 / std::sqrt(3.0);
  const BenchBody all[] = {
      {"knot", in_unit_sphere(test::knot(1000, 50)), {0, 0, 4.5}},
      {"box", test::box({edge, edge, edge}), {2.2, 1.6, 3.5}, BoxObject{edge, edge, edge}},
      {"icosphere", test::icosphere(6), {0, 0, 4.5}}};
  const SceneSpec peer = peer_scene({}, body_size, 0);
  const Sky skies[] = {{"forest", std::get<ImageEnvironmentSpec>(peer.environment.source).file},
                       {"sunrise", sunrise(run)}};
  for (const BenchBody& body : all)
    for (const Sky& sky : skies)
      if (!sky.file.empty()) add_rows(run, body, sky, table);
  return {table};
}

}  // namespace translucube::speed

// Error x time on bodies other than the sphere, under the forest and a hard sun.

#include <algorithm>

#include "renderer/scene/scene.h"
#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"
#include "tests/bench/speed/sunrise.h"
#include "tests/server/temp_folder.h"
#include "tests/support/meshes.h"

namespace translucube::speed {
namespace bodies_of {

constexpr int body_size = 128;
constexpr Quantity trimmed_of{"relMSE", "%.3g"}, untrimmed_of{"untrimmed", "%.3g"},
    cost_of_body{"relMSE × CPU s"}, largest_of{"largest pixel / converged", "%.1f"},
    mean_of_body{"mean", "%.4f"};

struct BenchBody {
  const char* name;
  ObjectSpec object;
};

/// Within the unit sphere.
TriangleMesh scaled(TriangleMesh mesh) {
  double radius2 = 0;
  for (const Vec3& v : mesh.vertices) radius2 = std::max(radius2, length_squared(v));
  for (Vec3& v : mesh.vertices) v = v * (1 / std::sqrt(radius2));
  return mesh;
}

double ratio_of_largest(const Image& image, const Image& reference) {
  constexpr float visible = 0.01f;
  double ratio = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    ratio = std::max(
        ratio, double(image.pixels[i]) / std::max(double(reference.pixels[i]), double(visible)));
  return ratio;
}

}  // namespace bodies_of
using namespace bodies_of;

Tables bodies(Run& run) {
  Table table{"bodies", "Other bodies", "Lab."};
  const server::test::TempFolder folder;
  test::write_obj(test::icosphere(6), folder / "icosphere.obj");
  test::write_obj(scaled(test::knot(1000, 50)), folder / "knot.obj");
  const double edge = 2 / std::sqrt(3.0);
  const BenchBody all[] = {{"knot", MeshObject{folder / "knot.obj"}},
                           {"box", BoxObject{edge, edge, edge}},
                           {"icosphere", MeshObject{folder / "icosphere.obj"}}};
  struct Sky {
    const char* name;
    std::filesystem::path file;
  };
  const SceneSpec peer = peer_scene({}, body_size, 0);
  const Sky skies[] = {{"forest", std::get<ImageEnvironmentSpec>(peer.environment.source).file},
                       {"sunrise", sunrise(run)}};
  const std::uint32_t samples = run.material_samples > 0 ? run.material_samples : run.samples(64);
  for (const BenchBody& body : all)
    for (const Sky& sky : skies) {
      if (sky.file.empty()) continue;
      for (const char* name : {"S01", "S1", "S10", "S100", "M", "C", "R10", "R25"}) {
        if (!run.chosen(name)) continue;
        SceneSpec spec = peer_scene(peer_material(name).coefficients, body_size, 0);
        spec.object = body.object;
        spec.environment.source = ImageEnvironmentSpec{sky.file};
        if (std::string(body.name) == "box") spec.camera.position_mm = {2.2, 1.6, 3.5};
        render_pair(run, spec, 8);
        const Pair pair = render_pair(run, spec, samples);
        const RelMse error = pair.error();
        const std::string row = text("%s, %s, %s", body.name, sky.name, name);
        table.add(row, ns_a_sample, pair.ns_per_sample());
        table.add(row, trimmed_of, error.trimmed);
        table.add(row, untrimmed_of, error.untrimmed);
        table.add(row, untrimmed_cost, error.untrimmed * pair.cpu_seconds);
        table.add(row, cost_of_body, error.trimmed * pair.cpu_seconds);
        double mean = 0;
        for (const float p : pair.a.pixels) mean += p;
        for (const float p : pair.b.pixels) mean += p;
        table.add(row, mean_of_body, mean / 2 / static_cast<double>(pair.a.pixels.size()));
        table.add(row, largest_of, ratio_of_largest(pair.a, mean_of({pair.a, pair.b})));
        table.add(row, connections,
                  static_cast<double>(pair.counters.light_samples) /
                      static_cast<double>(pair.counters.camera_samples));
        std::printf("%-26s ns %7.0f relmse %9.3g untrimmed %9.3g cost %9.3g mean %.4f\n",
                    row.c_str(), pair.ns_per_sample(), error.trimmed, error.untrimmed,
                    error.trimmed * pair.cpu_seconds,
                    mean / 2 / static_cast<double>(pair.a.pixels.size()));
        std::fflush(stdout);
      }
    }
  return {table};
}

}  // namespace translucube::speed

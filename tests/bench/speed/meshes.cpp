// What a mesh costs next to the analytic sphere.

#include "tests/support/meshes.h"

#include <algorithm>

#include "picture/image_io.h"
#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"
#include "tests/support/repository.h"

namespace translucube::speed {

using namespace test;

namespace {

constexpr Quantity coverage{"coverage", "%.2f"}, over_sphere{"/ sphere", "%.2f"},
    by_hit{"by hit", "%.2f"}, mean_radiance{"mean", "%.4f"}, its_error{"±", "%.4f"};
constexpr double sigmas[] = {1, 10, 100};

constexpr std::uint32_t two_passes = 8;  // tell the error of the mean

/// The bounding sphere just fills the picture.
Scene framed(const AnyShape& shape, const Material& material, const Environment& light,
             std::uint64_t seed) {
  Scene scene = body(shape, material, seed);
  scene.environment = light;
  scene.width = scene.height = 64;
  scene.camera = Camera({1.2, 0.9, 2.5}, {0, 0, 0}, {0, 1, 0}, 40.2, 64, 64);
  return scene;
}

/// Share of the camera samples that meet the body.
double coverage_of(const AnyShape& shape, Run& run) {
  Scene scene = framed(shape, material(1, 0, 0), UniformEnvironment{}, run.next_seed());
  scene.interior = BlackInterior{};
  return 1 - image_mean(test::trace(scene, 16, run.threads)).mean;
}

struct Light {
  const char* name;
  Environment environment;
};

}  // namespace

Tables meshes(Run& run) {
  Table table{
      "meshes", "Meshes",
      "CPU time of a camera sample, ior 1.5, smooth, over the optical radius σ_s R of the "
      "bounding sphere, which just fills the picture; after a first render, in which a mesh "
      "learns its distances. At σR = 10 (S10) a mesh may take three times as long as the "
      "analytic sphere. In the forest the sphere's scatterers look for light and a mesh's "
      "do not; in the white furnace (mean 1 where nothing is lost) neither does, and the "
      "walk alone is compared. By hit: the ratio of the times of camera samples that meet "
      "the body."};
  struct Body {
    std::string name;
    AnyShape shape;
    double coverage;
  };
  std::vector<Body> bodies{{"sphere", Sphere{}, coverage_of(Sphere{}, run)}};
  const auto add = [&](const char* name, const TriangleMesh& mesh) {
    const AnyShape shape = build_mesh(mesh).mesh;
    bodies.push_back(
        {text("%s of %zu", name, mesh.triangles.size()), shape, coverage_of(shape, run)});
  };
  add("box", box({1, 1.5, 2}));
  add("icosphere", icosphere(6));
  add("knot", knot(1000, 50));
  add("knot", knot(4000, 125));
  const Light lights[] = {
      {"forest",
       ImageEnvironment(read_image(in_repository("config/environments/forest.exr")), 0, 1)},
      {"white", UniformEnvironment{}}};
  for (const Light& light : lights)
    for (const double sigma_s : sigmas) {
      double sphere = 0;
      for (const Body& body : bodies) {
        const auto render = [&](std::uint32_t samples) {
          return test::trace(
              framed(body.shape, material(1.5, 0, sigma_s), light.environment, run.next_seed()),
              samples, run.threads);
        };
        render(two_passes);  // distances to a mesh are found when first asked for, and kept
        const Film film = render(std::max(two_passes, run.samples(32)));
        const auto n = static_cast<double>(film.counters.camera_samples);
        const double time = 1e9 * film.cpu_seconds / n;
        if (sphere == 0) sphere = time;
        const Measured picture = image_mean(film);
        const std::string row = text("%s, σR %g, %s", light.name, sigma_s, body.name.c_str());
        const bool judged = sigma_s == 10 && &body != &bodies.front();
        table.add(row, coverage, body.coverage);
        table.add(row, ns_a_sample, time);
        table.add(row, over_sphere, time / sphere,
                  judged ? std::optional(at_most(3)) : std::nullopt);
        table.add(row, by_hit, time / sphere * bodies.front().coverage / body.coverage);
        table.add(row, flights, static_cast<double>(film.counters.flights) / n);
        table.add(row, mean_radiance, picture.mean);
        table.add(row, its_error, picture.standard_error);
      }
    }
  return {table};
}

}  // namespace translucube::speed

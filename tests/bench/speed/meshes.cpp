// What a mesh costs next to the analytic sphere.

#include "tests/support/meshes.h"

#include <algorithm>

#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"

namespace translucube::speed {

using namespace test;

namespace {

constexpr Quantity ns{"ns a sample", "%.0f"}, ratio{"/ sphere", "%.2f"},
    flights{"flights", "%.2f", 0.02}, mean{"mean", "%.4f"}, error{"±", "%.4f"};
constexpr double sigmas[] = {1, 10, 100};

constexpr std::uint32_t two_passes = 8;  // tell the error of the mean

Film render_furnace(const Shape& shape, double sigma_s, std::uint32_t samples, Run& run) {
  Scene scene = body(shape, material(1.5, 0, sigma_s), run.next_seed());
  scene.width = scene.height = 64;
  scene.camera = Camera({1.2, 0.9, 2.5}, {0, 0, 0}, {0, 1, 0}, 26, 64, 64);
  return test::trace(scene, samples, run.threads);
}

}  // namespace

Tables meshes(Run& run) {
  Table table{"meshes", "Meshes",
              "CPU time of a sample in a white furnace, ior 1.5, smooth, over the optical radius "
              "σ_s R of the bounding sphere: neither body looks for light there, so that what is "
              "compared is the walk alone; after a first render, in which a mesh learns its "
              "distances. A mesh may take three times as long as the analytic "
              "sphere at σR = 10. The mean is 1 where nothing is lost."};
  struct Body {
    std::string name;
    Shape shape;
  };
  std::vector<Body> bodies{{"sphere", Sphere{}}};
  const auto add = [&](const char* name, const TriangleMesh& mesh) {
    bodies.push_back({text("%s of %zu", name, mesh.triangles.size()), build_mesh(mesh).mesh});
  };
  add("box", box({1, 1.5, 2}));
  add("icosphere", icosphere(6));
  add("knot", knot(1000, 50));
  add("knot", knot(4000, 125));
  for (const double sigma_s : sigmas) {
    double sphere = 0;
    for (const Body& body : bodies) {
      // Distances to a mesh are found when first asked for, and kept: not a sample's time.
      render_furnace(body.shape, sigma_s, two_passes, run);
      const Film film =
          render_furnace(body.shape, sigma_s, std::max(two_passes, run.samples(32)), run);
      const auto n = static_cast<double>(film.counters.camera_samples);
      const double time = 1e9 * film.cpu_seconds / n;
      if (sphere == 0) sphere = time;
      const Estimate light = image_mean(film);
      const std::string row = text("σR %g, %s", sigma_s, body.name.c_str());
      table.add(row, ns, time);
      table.add(
          row, ratio, time / sphere,
          sigma_s == 10 && &body != &bodies.front() ? std::optional(at_most(3)) : std::nullopt);
      table.add(row, flights, static_cast<double>(film.counters.flights) / n);
      table.add(row, mean, light.mean);
      table.add(row, error, light.standard_error);
    }
  }
  return {table};
}

}  // namespace translucube::speed

// What a mesh costs next to the analytic sphere: CPU ns per camera sample in a white furnace, ior
// 1.5, over the optical radius sigma_s R of the bounding sphere.
//
//   meshes [--samples N] [--only NAME] [--sigma 1,10,100,10000]

#include "tests/support/meshes.h"

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/scenes.h"

namespace {

using namespace translucube;
using namespace translucube::test;

struct Cost {
  double ns, mean, standard_error, flights, truncated;
};
Cost cost(const Shape& shape, double sigma_s, std::uint32_t samples) {
  Scene scene = body(shape, material(1.5, 0, sigma_s));
  scene.width = scene.height = 64;
  scene.camera = Camera({1.2, 0.9, 2.5}, {0, 0, 0}, {0, 1, 0}, 26, 64, 64);
  const Film film = trace(scene, samples, 1);
  const Estimate e = image_mean(film);
  const auto n = static_cast<double>(film.counters.camera_samples);
  return {film.cpu_seconds / n * 1e9, e.mean, e.standard_error,
          static_cast<double>(film.counters.flights) / n, film.counters.truncated_energy / n};
}

}  // namespace

int main(int argc, char** argv) {
  std::uint32_t samples = 64;
  std::string only, sigmas = "1,10,100,10000";
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    if (option == "--samples")
      samples = static_cast<std::uint32_t>(std::stoul(argv[i + 1]));
    else if (option == "--only")
      only = argv[i + 1];
    else if (option == "--sigma")
      sigmas = argv[i + 1];
    else
      return std::fprintf(stderr, "unknown option %s\n", argv[i]), 2;
  }
  struct Body {
    const char* name;
    Shape shape;
  };
  std::vector<Body> bodies;
  bodies.push_back({"sphere", Sphere{}});
  const auto add = [&](const char* name, auto&& make) {
    if (only.empty() || only == name) bodies.push_back({name, build_mesh(make()).mesh});
  };
  add("box", [] { return box({1, 1.5, 2}); });
  add("icosphere", [] { return icosphere(6); });  // 81,920 triangles
  add("knot", [] { return knot(1000, 50); });     // 100,000 triangles
  std::printf("%-10s %8s %10s %8s %9s %8s %9s %9s\n", "body", "sigma R", "ns/sample", "/sphere",
              "flights", "mean", "+-", "truncated");
  std::istringstream list(sigmas);
  for (std::string item; std::getline(list, item, ',');) {
    const double sigma_s = std::stod(item);
    double sphere = 0;
    for (const Body& b : bodies) {
      const Cost c = cost(b.shape, sigma_s, samples);
      if (sphere == 0) sphere = c.ns;
      std::printf("%-10s %8g %10.0f %8.2f %9.1f %8.5f %9.5f %9.1e\n", b.name, sigma_s, c.ns,
                  c.ns / sphere, c.flights, c.mean, c.standard_error, c.truncated);
      std::fflush(stdout);
    }
  }
  return 0;
}

// What a mesh costs next to the analytic sphere, ior 1.5, smooth, over the optical radius sigma_s R
// of the bounding sphere: CPU ns per camera sample of a picture that just holds the bounding
// sphere, and per camera sample that meets the body (a knot fills half of what a sphere fills, but
// light that leaves it often enters again). In a white furnace, or under an image, where the sphere
// connects its scattering vertices to the light and a mesh does not.
//
//   meshes [--samples N] [--only NAME] [--sigma 1,10,100,10000] [--light white|forest]

#include "tests/support/meshes.h"

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "renderer/image_io.h"
#include "tests/support/scenes.h"

namespace {

using namespace translucube;
using namespace translucube::test;

Scene framed(const Shape& shape, const Material& material) {
  Scene scene = body(shape, material);
  scene.width = scene.height = 64;
  scene.camera = Camera({1.2, 0.9, 2.5}, {0, 0, 0}, {0, 1, 0}, 40.2, 64, 64);
  return scene;
}

/// Share of the camera samples that meet the body.
double coverage(const Shape& shape) {
  Scene scene = framed(shape, material(1, 0, 0));
  scene.interior = BlackInterior{};
  return 1 - image_mean(trace(scene, 16)).mean;
}

struct Cost {
  double ns, mean, standard_error, flights, truncated;
};
Cost cost(const Shape& shape, const Environment& light, double sigma_s, std::uint32_t samples) {
  Scene scene = framed(shape, material(1.5, 0, sigma_s));
  scene.environment = light;
  const Film film = trace(scene, samples, 1);
  const Estimate e = image_mean(film);
  const auto n = static_cast<double>(film.counters.camera_samples);
  return {film.cpu_seconds / n * 1e9, e.mean, e.standard_error,
          static_cast<double>(film.counters.flights) / n, film.counters.truncated_energy / n};
}

}  // namespace

int main(int argc, char** argv) {
  std::uint32_t samples = 64;
  std::string only, sigmas = "1,10,100,10000", light = "white";
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    if (option == "--samples")
      samples = static_cast<std::uint32_t>(std::stoul(argv[i + 1]));
    else if (option == "--only")
      only = argv[i + 1];
    else if (option == "--sigma")
      sigmas = argv[i + 1];
    else if (option == "--light")
      light = argv[i + 1];
    else
      return std::fprintf(stderr, "unknown option %s\n", argv[i]), 2;
  }
  Environment environment;
  if (light == "forest")
    environment = ImageEnvironment(
        read_image(TRANSLUCUBE_SOURCE_DIR "/config/environments/forest.exr"), 0, 1);
  struct Body {
    const char* name;
    Shape shape;
    double coverage;
  };
  std::vector<Body> bodies;
  const auto add = [&](const char* name, auto&& make) {
    if (!only.empty() && only != name && bodies.size() > 0) return;
    const Shape shape = make();
    bodies.push_back({name, shape, coverage(shape)});
  };
  add("sphere", [] { return Sphere{}; });
  add("box", [] { return build_mesh(box({1, 1.5, 2})).mesh; });
  add("icosphere", [] { return build_mesh(icosphere(6)).mesh; });    // 81,920 triangles
  add("knot", [] { return build_mesh(knot(1000, 50)).mesh; });       // 100,000 triangles
  add("fineknot", [] { return build_mesh(knot(4000, 125)).mesh; });  // 1,000,000 triangles
  std::printf("%-10s %8s %8s %10s %8s %8s %9s %8s %9s %9s\n", "body", "coverage", "sigma R",
              "ns/sample", "/sphere", "same/hit", "flights", "mean", "+-", "truncated");
  std::istringstream list(sigmas);
  for (std::string item; std::getline(list, item, ',');) {
    const double sigma_s = std::stod(item);
    double sphere = 0;
    for (const Body& b : bodies) {
      const Cost c = cost(b.shape, environment, sigma_s, samples);
      if (sphere == 0) sphere = c.ns;
      std::printf("%-10s %8.3f %8g %10.0f %8.2f %8.2f %9.1f %8.5f %9.5f %9.1e\n", b.name,
                  b.coverage, sigma_s, c.ns, c.ns / sphere,
                  c.ns / sphere * bodies[0].coverage / b.coverage, c.flights, c.mean,
                  c.standard_error, c.truncated);
      std::fflush(stdout);
    }
  }
  return 0;
}

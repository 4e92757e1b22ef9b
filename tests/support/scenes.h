#pragma once

// Scenes with known answers, built below the request: shapes, interfaces and lanes by hand.

#include <cmath>
#include <limits>
#include <memory>

#include "renderer/render.h"
#include "renderer/scene/scene.h"

namespace translucube::test {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

struct Measured {
  double mean = 0, standard_error = 0;
};

/// Mean of one lane over the image and channels; the standard error is lane 0's, so ask it of lane
/// 0.
inline Measured image_mean(const Film& film, int lane = 0) {
  Measured e;
  const Image image = develop(film, lane);
  const double n = static_cast<double>(image.pixels.size());
  for (const float p : image.pixels) e.mean += p / n;
  // The three channels of a pixel share its paths.
  const Image spread = variance(film);
  double sum = 0;
  for (std::size_t i = 0; i < spread.pixels.size(); i += 3) sum += spread.pixels[i];
  e.standard_error = std::sqrt(sum) * 3 / n;
  return e;
}

/// A camera from so far away that its rays are parallel (to 1e-5), along -z (`side` 1) or z (-1),
/// over [-half, half]^2.
inline void look_from_afar(Scene& scene, double half, int size, int side = 1) {
  constexpr double distance = 1e5;
  scene.width = scene.height = size;
  scene.camera = Camera({0, 0, side * distance}, {0, 0, 0}, {0, 1, 0},
                        2 * std::atan(half / distance) * 180 / std::numbers::pi, size, size);
}

/// Not an absorber but a view: radiance times length, whose mean over a clear image is the mean
/// path. Exact, as the table is linear between its nodes.
inline Lane length_lane() {
  constexpr int octaves = 40;
  return SpectralLane(1, ColorOperatorTable(octaves, [](double one_and_length) {
                        const auto length = static_cast<float>(one_and_length - 1);
                        return ColorOperator{length, 0, 0, 0, length, 0, 0, 0, length};
                      }));
}

/// A plate of thickness 1 so wide that it is an infinite slab.
inline Polytope wide_plate() { return make_box({200, 200, 0.5}); }

inline Scene body(AnyShape shape, const Material& material, std::uint64_t seed = 1) {
  Scene scene;
  scene.seed = seed;
  scene.shape = std::move(shape);
  scene.interface = make_interface(material);
  scene.interior = make_interior(material, 1.0);
  scene.environment = UniformEnvironment{};
  scene.lanes = {ClearLane{}};
  return scene;
}

inline Material material(double ior, double alpha, double sigma_s, double g = 0) {
  Material m;
  m.coefficients = {0, alpha, sigma_s};
  m.g = g;
  m.ior = ior;
  return m;
}

/// Radiance 1 from the half space z > 0 (or z < 0), 0 from the other one; it is looked for.
inline ImageEnvironment half_space_light(bool above) {
  Image image(2048, 64);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      const bool towards_z = x >= image.width / 4 && x < 3 * image.width / 4;
      for (int c = 0; c < 3; ++c)
        image.pixels[3 * (std::size_t(y) * image.width + x) + c] = towards_z == above ? 1.0f : 0.0f;
    }
  return ImageEnvironment(image, 0, 1);
}

/// A rough, scattering sphere under half a sky, small.
inline Scene half_lit_sphere() {
  Scene scene = body(Sphere{}, material(1.5, 0.2, 3));
  scene.environment = half_space_light(true);
  look_from_afar(scene, 1.2, 40);
  return scene;
}

/// Radiance 1 from the half space z < 0 once more, that of a light table behind the body: nothing
/// looks for it, so that paths alone find it.
inline void light_by_a_table(Scene& scene) {
  scene.environment = UniformEnvironment{{0, 0, 0}};
  scene.backdrop = Backdrop{};
  scene.backdrop->height = -2;
}

/// Many passes of few samples, so that the spread between them tells the error.
inline Film trace(const Scene& scene, std::uint32_t samples, int threads = 0) {
  return render(scene, SampleTarget{samples}, threads).film;
}

}  // namespace translucube::test

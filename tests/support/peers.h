#pragma once

// The scene on which Cycles, Mitsuba 0.6 and pbrt-v4 were measured (docs/speed.md), and what is
// read of its images.

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "tests/support/repository.h"
#include "tests/support/scenes.h"

namespace translucube::test {

struct PeerMaterial {
  const char* name;
  Coefficients coefficients;  ///< absorption times (0.15, 1, 1)
};
inline constexpr std::array peer_materials = {
    PeerMaterial{"A0", {0, 0, 0}},    PeerMaterial{"A2", {1, 0, 0}},
    PeerMaterial{"R05", {0, .05, 0}}, PeerMaterial{"R10", {0, .1, 0}},
    PeerMaterial{"R25", {0, .25, 0}}, PeerMaterial{"R50", {0, .5, 0}},
    PeerMaterial{"S01", {0, 0, .1}},  PeerMaterial{"S1", {0, 0, 1}},
    PeerMaterial{"S10", {0, 0, 10}},  PeerMaterial{"S100", {0, 0, 100}},
    PeerMaterial{"M", {.2, .1, 5}},   PeerMaterial{"C", {1, 0, 10}}};
/// Expects a name of the list.
inline const PeerMaterial& peer_material(std::string_view name) {
  return *std::ranges::find(peer_materials, name, &PeerMaterial::name);
}

/// A sphere of 1 mm in the forest; absorption is red (0.15, 1, 1).
inline SceneSpec peer_scene(const Coefficients& coefficients, int size, std::uint64_t seed) {
  SceneSpec spec;
  spec.material.coefficients = coefficients;
  spec.material.absorber = RgbAbsorber{{0.15, 1, 1}};
  spec.object = SphereObject{1};
  spec.environment.source = ImageEnvironmentSpec{in_repository("config/environments/forest.exr")};
  spec.camera = {{0, 0, 4.5}, {0, 0, 0}, {0, 1, 0}, 32};
  spec.width = spec.height = size;
  spec.seed = seed;
  return spec;
}

/// Mean of each channel over all pixels.
inline std::array<Measured, 3> channel_means(const Film& film) {
  const Image image = develop(film), spread = variance(film);
  const double n = static_cast<double>(image.pixels.size()) / 3;
  std::array<Measured, 3> means{};
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    means[i % 3].mean += image.pixels[i] / n;
    means[i % 3].standard_error += spread.pixels[i];
  }
  for (Measured& e : means) e.standard_error = std::sqrt(e.standard_error) / n;
  return means;
}

/// The 5 x 5 mean about a pixel, as a denominator that its noise cannot flatter.
inline double smoothed(const Image& image, int x, int y, int c) {
  double sum = 0;
  int n = 0;
  for (int v = std::max(0, y - 2); v <= std::min(image.height - 1, y + 2); ++v)
    for (int u = std::max(0, x - 2); u <= std::min(image.width - 1, x + 2); ++u, ++n)
      sum += image.pixels[3 * (std::size_t(v) * image.width + u) + c];
  return sum / n;
}

}  // namespace translucube::test

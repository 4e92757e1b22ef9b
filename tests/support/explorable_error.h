#pragma once

// How far an explorable film, developed, is from exact lanes of the same paths.

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/explorable.h"
#include "renderer/material_cube.h"
#include "renderer/render.h"
#include "renderer/scene_data.h"

namespace translucube::test {

/// Of the clear pixel.
struct SpreadError {
  double largest = 0, mean = 0;
};

/// One error for each of the absorptions, which replace those of `spec`.
inline std::vector<SpreadError> explorable_errors(SceneSpec spec,
                                                  const std::vector<Absorption>& absorptions,
                                                  double densest_sigma_a, std::uint32_t samples,
                                                  int threads) {
  spec.material.coefficients.sigma_a_peak = 0;  // lane 0 is the clear picture
  spec.more_absorptions = absorptions;
  const Film exact = render(*build_scene(spec), SampleTarget{samples}, threads).film;
  spec.more_absorptions.clear();
  spec.explorable = Explorable{densest_sigma_a};
  const auto scene = build_scene(spec);
  const ExplorableFilm film =
      explorable_film(*scene, render(*scene, SampleTarget{samples}, threads).film);
  const Image clear = develop(exact);
  std::vector<SpreadError> errors(absorptions.size());
  for (std::size_t k = 0; k < absorptions.size(); ++k) {
    const Image developed =
        develop_explorable(film, absorptions[k].absorber, absorptions[k].sigma_a_peak, threads);
    const Image expected = develop(exact, static_cast<int>(k) + 1);
    for (std::size_t i = 0; i < clear.pixels.size(); ++i) {
      const double e = std::fabs(developed.pixels[i] - expected.pixels[i]) / clear.pixels[i];
      errors[k].largest = std::max(errors[k].largest, e);
      errors[k].mean += e / static_cast<double>(clear.pixels.size());
    }
  }
  return errors;
}

}  // namespace translucube::test

#pragma once

// How far an explorable film, developed, is from exact lanes of the same paths.

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/film/explorable_develop.h"
#include "renderer/optics/material_cube.h"
#include "renderer/render.h"
#include "renderer/scene/scene.h"
#include "tests/support/absorbers.h"

namespace translucube::test {

struct ExplorableError {
  SpreadError film;  ///< as it is kept, in half floats
  SpreadError bins;  ///< of the bins of length alone
};

/// The picture through an absorber, straight from the bins of the traced film.
inline Image develop_bins(const Film& film, const LengthBins& bins, const Lane& lane) {
  Image developed(film.width, film.height);
  for (int bin = 0; bin < bins.count(); ++bin) {
    const Image light = develop(film, bin);
    for (std::size_t i = 0; i < light.pixels.size(); i += 3) {
      const Rgb left = std::visit(
          [&](const auto& l) {
            return l.apply(Rgb{light.pixels[i], light.pixels[i + 1], light.pixels[i + 2]},
                           bins.length(bin));
          },
          lane);
      developed.pixels[i] += left.r;
      developed.pixels[i + 1] += left.g;
      developed.pixels[i + 2] += left.b;
    }
  }
  return developed;
}

inline SpreadError difference(const Image& image, const Image& expected, const Image& clear) {
  SpreadError error;
  for (std::size_t i = 0; i < clear.pixels.size(); ++i) {
    const double e = std::fabs(image.pixels[i] - expected.pixels[i]) / clear.pixels[i];
    error.largest = std::max(error.largest, e);
    error.mean += e / static_cast<double>(clear.pixels.size());
  }
  return error;
}

/// One error for each of the absorptions, which replace those of `spec`.
inline std::vector<ExplorableError> explorable_errors(SceneSpec spec,
                                                      const std::vector<Absorption>& absorptions,
                                                      double densest_sigma_a, std::uint32_t samples,
                                                      int threads) {
  spec.material.coefficients.sigma_a_peak = 0;  // lane 0 is the clear picture
  spec.more_absorptions = absorptions;
  const Film exact = render(*build_scene(spec), SampleTarget{samples}, threads).film;
  spec.more_absorptions.clear();
  spec.explorable = Explorable{densest_sigma_a};
  const auto scene = build_scene(spec);
  const Film traced = render(*scene, SampleTarget{samples}, threads).film;
  const ExplorableFilm kept = explorable_film(*scene, traced);
  const Image clear = develop(exact);
  std::vector<ExplorableError> errors;
  for (const auto& [absorber, sigma_a_peak] : absorptions) {
    const Image expected = develop(exact, static_cast<int>(errors.size()) + 1);
    const Lane lane = make_lane(absorber, sigma_a_peak * scene->unit_mm);
    errors.push_back(
        {difference(develop_explorable(kept, absorber, sigma_a_peak, threads), expected, clear),
         difference(develop_bins(traced, scene->spread->bins(), lane), expected, clear)});
  }
  return errors;
}

}  // namespace translucube::test

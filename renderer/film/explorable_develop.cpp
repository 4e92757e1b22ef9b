#include "renderer/film/explorable_develop.h"

#include <algorithm>

#include "renderer/base/parallel.h"
#include "renderer/film/explorable_batch.h"

namespace translucube {
namespace {

/// What a lane does to light of each bin, the bin's scale included.
std::vector<ColorOperator> operators(const LengthBins& bins, const std::vector<float>& scales,
                                     const Lane& lane) {
  std::vector<ColorOperator> all(static_cast<std::size_t>(bins.count()));
  for (int bin = 0; bin < bins.count(); ++bin)
    for (int c = 0; c < 3; ++c) {
      const Rgb unit{c == 0 ? 1.0f : 0.0f, c == 1 ? 1.0f : 0.0f, c == 2 ? 1.0f : 0.0f};
      const Rgb column =
          std::visit([&](const auto& l) { return l.apply(unit, bins.length(bin)); }, lane);
      all[bin][c] = column.r * scales[bin];
      all[bin][3 + c] = column.g * scales[bin];
      all[bin][6 + c] = column.b * scales[bin];
    }
  return all;
}

}  // namespace

Image develop_explorable(const ExplorableFilm& film, const Lane& lane, int threads) {
  Image image(film.width, film.height);
  const std::vector<ColorOperator> all = operators(film.bins, film.scales, lane);
  const std::size_t pixels = image.pixels.size() / 3;
  const auto blocks = static_cast<int>((pixels + pixels_at_once - 1) / pixels_at_once);
  // Not worth a thread below a few hundred thousand values.
  const int useful = std::min(thread_count(threads), std::max(1, blocks / 16));
  parallel_for(useful, blocks, [&](int block) {
    const std::size_t first = pixels_at_once * block;
    develop_halves(all, film.halves.data() + first, pixels,
                   std::min(pixels_at_once, pixels - first), image.pixels.data() + 3 * first);
  });
  return image;
}

Image develop_explorable(const ExplorableFilm& film, const Absorber& absorber, double sigma_a_peak,
                         int threads) {
  return develop_explorable(film, make_lane(absorber, sigma_a_peak * film.unit_mm), threads);
}

namespace {

Image summed(const LengthBins& bins, const Film& film, const Lane& lane) {
  const std::vector<float> scales(static_cast<std::size_t>(film.lanes), to_mean(film));
  const std::vector<ColorOperator> all = operators(bins, scales, lane);
  Image image(film.width, film.height);
  const float* in = film.sum.data();
  for (const ColorOperator& m : all)
    for (float* out = image.pixels.data(); out < image.pixels.data() + image.pixels.size();
         in += 3, out += 3) {
      const Rgb light = apply_operator(m, {in[0], in[1], in[2]});
      out[0] += light.r;
      out[1] += light.g;
      out[2] += light.b;
    }
  return image;
}

}  // namespace

Image develop_shares(const ExplorableBasis& basis, const Film& film) {
  return summed(basis.bins, film, basis.own);
}

Image develop_shares(const ExplorableBasis& basis, const Film& film, const Absorber& absorber,
                     double sigma_a_peak) {
  return summed(basis.bins, film, make_lane(absorber, sigma_a_peak * basis.unit_mm));
}

}  // namespace translucube

#include "renderer/film/explorable.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "renderer/base/half.h"

namespace translucube {

ExplorableFilm explorable_film(const LengthBins& bins, double unit_mm, const Film& film) {
  ExplorableFilm result;
  result.width = film.width;
  result.height = film.height;
  result.bins = bins;
  result.unit_mm = unit_mm;
  const std::size_t pixels = std::size_t(film.width) * film.height;
  const float to_mean = translucube::to_mean(film);
  result.halves.resize(film.sum.size());
  for (int bin = 0; bin < film.lanes; ++bin) {
    const float* sum = film.sum.data() + 3 * pixels * bin;
    float largest = 0;
    bool finite = true;
    for (std::size_t i = 0; i < 3 * pixels; ++i) {
      largest = std::max(largest, std::fabs(sum[i] * to_mean));
      finite = finite && std::isfinite(sum[i]);
    }
    if (!finite) throw std::domain_error("an explorable film that is not finite");
    // The largest value comes to lie in [2^14, 2^15).
    const int exponent = largest > 0 ? std::clamp(std::ilogb(largest) - 14, -100, 100) : 0;
    result.scales.push_back(std::ldexp(1.0f, exponent));
    const float scale = std::ldexp(1.0f, -exponent);
    for (std::size_t i = 0; i < pixels; ++i)
      for (int c = 0; c < 3; ++c)
        result.halves[(std::size_t(3) * bin + c) * pixels + i] =
            float_to_half(sum[3 * i + c] * to_mean * scale);
  }
  return result;
}

}  // namespace translucube

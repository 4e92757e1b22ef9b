#include "picture/reduce.h"

#include <algorithm>
#include <cassert>
#include <cstdint>

namespace translucube {

namespace {

/// Calls add(k, weight) for every pixel k of a line of `from` that the i-th of `to` equal parts
/// overlaps; the weights sum to 1. Whole numbers: in units of 1 / to pixels, pixel k is
/// [k to, (k + 1) to) and part i is [i from, (i + 1) from).
template <typename Add>
void for_overlaps(int i, std::int64_t from, std::int64_t to, Add add) {
  const std::int64_t begin = i * from, end = begin + from;
  for (std::int64_t k = begin / to; k * to < end; ++k) {
    const std::int64_t overlap = std::min(end, (k + 1) * to) - std::max(begin, k * to);
    add(static_cast<std::size_t>(k), static_cast<double>(overlap) / static_cast<double>(from));
  }
}

}  // namespace

Image reduce(const Image& picture, int width, int height) {
  assert(width >= 1 && width <= picture.width && height >= 1 && height <= picture.height);
  const std::size_t row_size = std::size_t{3} * picture.width;
  Image reduced(width, height);
  std::vector<double> row(row_size);
  for (int y = 0; y < height; ++y) {
    std::fill(row.begin(), row.end(), 0.0);
    for_overlaps(y, picture.height, height, [&](std::size_t k, double weight) {
      const float* source = picture.pixels.data() + k * row_size;
      for (std::size_t i = 0; i < row_size; ++i) row[i] += weight * source[i];
    });
    for (int x = 0; x < width; ++x) {
      double sum[3] = {0, 0, 0};
      for_overlaps(x, picture.width, width, [&](std::size_t k, double weight) {
        for (std::size_t c = 0; c < 3; ++c) sum[c] += weight * row[3 * k + c];
      });
      for (int c = 0; c < 3; ++c)
        reduced.pixels[(std::size_t(y) * width + x) * 3 + c] = static_cast<float>(sum[c]);
    }
  }
  return reduced;
}

}  // namespace translucube

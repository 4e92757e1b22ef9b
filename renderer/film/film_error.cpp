#include "renderer/film/film_error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace translucube {
namespace {

/// Row by row, the picture with less noise: the mean over the 5 x 5 pixels about a pixel (fewer at
/// the edges), and of its own deviation from that as much as the noise there does not explain (Lee
/// 1980, "Digital Image Enhancement and Noise Filtering by Use of Local Statistics").
class Denoised {
 public:
  /// Per sample: `to_mean` times the sums is the picture, `to_variance` times m2 its noise.
  Denoised(const Film& film, const PictureSums& picture, double to_mean, double to_variance)
      : film_(film),
        picture_(picture),
        to_mean_(static_cast<float>(to_mean)),
        to_variance_(static_cast<float>(to_variance)),
        columns_(std::size_t(3) * film.width) {}

  /// The values of this row.
  void row(int y, std::vector<float>& values) {
    const std::size_t line = columns_.size();
    const int first = std::max(0, y - reach), last = std::min(film_.height - 1, y + reach);
    std::ranges::fill(columns_, Moments{});
    for (int v = first; v <= last; ++v)
      for (std::size_t i = 0; i < line; ++i) columns_[i] += moments(v * line + i);
    for (int x = 0; x < film_.width; ++x) {
      const int left = std::max(0, x - reach), right = std::min(film_.width - 1, x + reach);
      const float share = 1 / static_cast<float>((last - first + 1) * (right - left + 1));
      for (int c = 0; c < 3; ++c) {
        Moments all;
        for (int u = left; u <= right; ++u) all += columns_[3 * u + c];
        const float mean = all.mean * share;
        const float spread = all.square * share - mean * mean, noise = all.noise * share;
        const float own = spread > 0 ? std::max(0.0f, 1 - noise / spread) : 0;
        values[3 * x + c] = mean + own * (picture_[y * line + 3 * x + c] * to_mean_ - mean);
      }
    }
  }

 private:
  static constexpr int reach = 2;

  struct Moments {
    float mean = 0, square = 0, noise = 0;
    Moments& operator+=(const Moments& other) {
      mean += other.mean;
      square += other.square;
      noise += other.noise;
      return *this;
    }
  };
  Moments moments(std::size_t i) const {
    const float value = picture_[i] * to_mean_;
    return {value, value * value, film_.m2[i] * to_variance_};
  }

  const Film& film_;
  const PictureSums& picture_;
  float to_mean_, to_variance_;
  std::vector<Moments> columns_;
};

}  // namespace

double relative_error(const Film& film) {
  if (film.passes < 2) return std::numeric_limits<double>::quiet_NaN();
  const double to_mean = 1.0 / film.samples;
  const double to_variance = 1.0 / (double(film.passes - 1) * film.samples);
  const PictureSums picture(film);
  // A pixel that met rare bright light has too large a mean and too large a spread: relative to its
  // own mean it would not tell.
  Denoised denoised(film, picture, to_mean, to_variance);
  std::vector<float> reference(std::size_t(3) * film.width);
  std::vector<float> error(film.m2.size() / 3, 0.0f);
  for (int y = 0; y < film.height; ++y) {
    denoised.row(y, reference);
    const std::size_t first = reference.size() * y;
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const double variance = film.m2[first + i] * to_variance;
      error[(first + i) / 3] +=
          static_cast<float>(variance / (reference[i] * reference[i] + 0.01) / 3);
    }
  }
  const std::size_t kept = error.size() - error.size() / 1000;
  std::ranges::nth_element(error, error.begin() + static_cast<std::ptrdiff_t>(kept - 1));
  double sum = 0;
  for (std::size_t i = 0; i < kept; ++i) sum += error[i];
  return std::sqrt(sum / static_cast<double>(kept));
}

}  // namespace translucube

#pragma once

// What the noise of images is worth: relMSE = mean squared error relative to ref^2 + 0.01.

#include <algorithm>
#include <vector>

#include "tests/support/peers.h"

namespace translucube::test {

struct RelMse {
  double trimmed = 0;    ///< the largest pixels set aside, 0.1 % of them unless asked otherwise
  double untrimmed = 0;  ///< all pixels
};

/// Of a reference's values, `squared_error(i)` each.
template <class SquaredError>
RelMse rel_mse_by(const Image& reference, SquaredError&& squared_error, double aside = 0.001) {
  std::vector<double> error(reference.pixels.size() / 3, 0);
  for (std::size_t i = 0; i < reference.pixels.size(); ++i) {
    const double r = reference.pixels[i];
    error[i / 3] += squared_error(i) / (r * r + 0.01) / 3;
  }
  std::ranges::sort(error);
  const std::size_t kept =
      error.size() - static_cast<std::size_t>(aside * static_cast<double>(error.size()));
  double trimmed = 0, all = 0;
  for (std::size_t i = 0; i < error.size(); ++i) {
    all += error[i];
    if (i < kept) trimmed += error[i];
  }
  return {trimmed / static_cast<double>(kept), all / static_cast<double>(error.size())};
}

/// Of an image against a reference.
inline RelMse rel_mse(const Image& image, const Image& reference) {
  return rel_mse_by(reference, [&](std::size_t i) {
    const double d = double(image.pixels[i]) - reference.pixels[i];
    return d * d;
  });
}

/// Of one of two independent renders, from their difference.
inline RelMse rel_mse_of_pair(const Image& a, const Image& b, const Image& reference,
                              double aside = 0.001) {
  return rel_mse_by(
      reference,
      [&](std::size_t i) {
        const double d = double(a.pixels[i]) - b.pixels[i];
        return d * d / 2;
      },
      aside);
}

inline Image mean_of(const std::vector<Image>& images) {
  Image mean(images[0].width, images[0].height);
  for (const Image& image : images)
    for (std::size_t i = 0; i < mean.pixels.size(); ++i)
      mean.pixels[i] += image.pixels[i] / static_cast<float>(images.size());
  return mean;
}

/// Every pixel by its surroundings.
inline Image smoothed(const Image& image) {
  Image out(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c)
        out.pixels[3 * (std::size_t(y) * image.width + x) + c] =
            static_cast<float>(smoothed(image, x, y, c));
  return out;
}

/// The mean of renders of a peers' material as a reference for their own noise: smoothed, unless
/// nothing but the tree of smooth reflections makes the picture, which has edges and hardly noise.
inline Image reference_of(const std::vector<Image>& images, const Coefficients& coefficients) {
  const bool sharp = coefficients.alpha == 0 && coefficients.sigma_s == 0;
  return sharp ? mean_of(images) : smoothed(mean_of(images));
}

}  // namespace translucube::test

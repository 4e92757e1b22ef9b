#pragma once

// What is kept of the light that paths bring: the sums of a pass, and the film that passes are
// merged into. In this room stand films, the lanes that apply an absorber to them (absorption.h),
// and the lengths of paths for absorbers to come (explorable.h); no path, scene or body does.

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "picture/image.h"

namespace translucube {

/// What happened on the way; sums over all paths of a pass or a render.
struct TraceCounters {
  std::uint64_t camera_samples = 0;
  std::uint64_t flights = 0;          ///< free flights and large steps inside the body
  std::uint64_t boundary_events = 0;  ///< Fresnel or microfacet events
  std::uint64_t light_samples = 0;    ///< lights looked for: next-event estimations
  std::uint64_t nan_samples = 0;      ///< non-finite contributions: a bug, fails the render
  double truncated_energy = 0;  ///< throughput given up at the path cap, per camera sample sum

  TraceCounters& operator+=(const TraceCounters& other);
};

/// A pass: `count` camera samples for each pixel, an independent replicate of the sampling.
struct Pass {
  std::uint32_t index = 0;
  std::uint32_t first_sample = 0, count = 0;
  friend bool operator==(const Pass&, const Pass&) = default;
};

/// The picture of one pass: sums over its samples.
struct PassFilm {
  int width = 0, height = 0, lanes = 1;
  bool shares = false;  ///< the lanes add up to one picture (explorable), else each is one
  Pass pass;
  std::vector<float> sum;  ///< lanes x height x width x 3
  TraceCounters counters;
  double cpu_seconds = 0;
};

/// Merged passes, with the spread between them. Merge in the order of their indices: float sums
/// depend on it, and the same request must give the same bits.
struct Film {
  int width = 0, height = 0, lanes = 1;
  bool shares = false;  ///< the lanes add up to one picture (explorable), else each is one
  std::uint32_t passes = 0, samples = 0;
  std::vector<float> sum;  ///< lanes x height x width x 3, over all samples
  std::vector<float> m2;   ///< height x width x 3: sum over passes of n (mean_pass - mean)^2
  TraceCounters counters;
  double cpu_seconds = 0;

  Film() = default;
  Film(int width, int height, int lanes, bool shares = false);
};

/// Adds the next pass (pass.index == film.passes) (Chan et al. 1979, the pairwise update). A film
/// without passes takes the shape of its first one.
void merge(Film& film, const PassFilm& pass);

/// The sums of the picture that errors refer to: those of lane 0, or of all lanes together where
/// they are shares of it. Refers to the film.
class PictureSums {
 public:
  explicit PictureSums(const Film& film) : PictureSums(film.sum, film.m2.size(), film.shares) {}
  explicit PictureSums(const PassFilm& film)
      : PictureSums(film.sum, std::size_t(3) * film.width * film.height, film.shares) {}
  PictureSums(const PictureSums&) = delete;
  PictureSums& operator=(const PictureSums&) = delete;

  float operator[](std::size_t i) const { return sum_[i]; }

 private:
  PictureSums(const std::vector<float>& sum, std::size_t size, bool shares);

  std::vector<float> added_;
  std::span<const float> sum_;
};

/// The factor from a film's sums to its means; 0 before the first sample.
float to_mean(const Film& film);

/// The picture that errors refer to: the mean of lane 0, or of the sum of all lanes where they are
/// shares of it (an explorable film without absorption).
Image develop(const Film& film);
/// The mean of a lane.
Image develop(const Film& film, int lane);

/// Estimate of Var(pixel mean), height x width x 3, from the independent passes. Needs two passes.
Image variance(const Film& film);

}  // namespace translucube

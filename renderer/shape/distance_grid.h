#pragma once

#include <atomic>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <new>

#include "renderer/base/vec.h"

namespace translucube {

/// What is known of a distance: it lies in [least, most].
struct DistanceBounds {
  double least = 0, most = 0;
};

/// The distance to a surface inside [-1, 1]^3, sampled at the centres of a grid's cells, each when
/// it is first asked for. A distance changes by no more than the way gone, so a sample bounds it
/// all around. Threads may ask at once: a sample is a function of its cell alone, whoever takes it.
class DistanceGrid {
 public:
  explicit DistanceGrid(int cells)
      : cells_(cells),
        samples_(
            static_cast<float*>(std::calloc(std::size_t(cells) * cells * cells, sizeof(float)))) {
    if (samples_ == nullptr) throw std::bad_alloc();
  }

  /// Bounds at p, which may lie anywhere: beyond the cube the nearest cell answers.
  /// `nearest(center)` returns a distance that is found there, of which `keen` times is known to be
  /// free.
  template <class Nearest>
  DistanceBounds at(Vec3 p, double keen, Nearest&& nearest) const {
    const int x = index(p.x), y = index(p.y), z = index(p.z);
    const std::atomic_ref sample(
        samples_.get()[x + std::size_t(cells_) * (y + std::size_t(cells_) * z)]);
    const Vec3 center{coordinate(x), coordinate(y), coordinate(z)};
    float found = sample.load(std::memory_order_relaxed);
    if (found == 0) {
      found = static_cast<float>(nearest(center) + rounding);
      sample.store(found, std::memory_order_relaxed);
    }
    const double way = length(p - center);
    return {keen * (found - 2 * rounding) - way, found + way};
  }

 private:
  static constexpr double rounding = 1e-6;  ///< of the samples, in single precision

  /// The cell of a coordinate; a NaN has the first one.
  int index(double x) const {
    return static_cast<int>(std::fmin(std::fmax(0.0, 0.5 * (x + 1) * cells_), cells_ - 0.5));
  }
  double coordinate(int index) const { return (2 * index + 1.0) / cells_ - 1; }

  int cells_;
  struct Free {
    void operator()(float* samples) const { std::free(samples); }
  };
  /// 0: not yet taken. From calloc, whose pages take no memory until they are written.
  std::unique_ptr<float[], Free> samples_;
};

}  // namespace translucube

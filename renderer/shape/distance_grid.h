#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>

#include "renderer/base/vec.h"

namespace translucube {

/// The distance to a face of a surface.
struct NearestFace {
  double distance = 0;
  std::uint32_t face = 0;
};

/// What is known of a distance: it lies in [least, most].
struct DistanceBounds {
  double least = 0, most = 0;
};

/// The distance to a surface inside [-1, 1]^3, sampled at the centres of a grid's cells, each when
/// it is first asked for. A distance changes by no more than the way gone, so a sample bounds it
/// all around. Threads may ask at once: a sample is a function of its cell alone, whoever takes it.
class DistanceGrid {
 public:
  struct Sample {
    float distance = 0;
    std::uint32_t face = 0;
  };

  explicit DistanceGrid(int cells)
      : cells_(cells),
        samples_(
            static_cast<Sample*>(std::calloc(std::size_t(cells) * cells * cells, sizeof(Sample)))) {
    if (samples_ == nullptr) throw std::bad_alloc();
  }

  /// Bounds at p, which may lie anywhere: beyond the cube the nearest cell answers.
  /// `nearest(center)` returns a distance that is found there, of which `keen` times is known to be
  /// free.
  template <class Nearest>
  DistanceBounds at(Vec3 p, double keen, Nearest&& nearest) const {
    Vec3 center;
    const double found = sample(p, nearest, center).distance;
    const double way = length(p - center);
    return {keen * (found - 2 * rounding) - way, found + way};
  }

  /// The sample of the cell that p lies in; `center`: where it was taken.
  template <class Nearest>
  Sample sample(Vec3 p, Nearest&& nearest, Vec3& center) const {
    const int x = index(p.x), y = index(p.y), z = index(p.z);
    const std::atomic_ref known(
        samples_.get()[x + std::size_t(cells_) * (y + std::size_t(cells_) * z)]);
    center = {coordinate(x), coordinate(y), coordinate(z)};
    Sample found = known.load(std::memory_order_relaxed);
    if (found.distance == 0) {
      const NearestFace face = nearest(center);
      found = {static_cast<float>(face.distance + rounding), face.face};
      known.store(found, std::memory_order_relaxed);
    }
    return found;
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
    void operator()(Sample* samples) const { std::free(samples); }
  };
  /// 0: not yet taken. From calloc, whose pages take no memory until they are written.
  std::unique_ptr<Sample[], Free> samples_;
};

}  // namespace translucube

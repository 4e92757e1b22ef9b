#pragma once

// Batches: what is done for many things at a time keeps them as a structure of arrays, which simd.h
// reads and writes a register at a time.

#include <array>
#include <cstddef>
#include <cstdint>

#include "renderer/base/vec.h"

namespace translucube {

/// Points or directions in single precision.
template <std::size_t n>
struct VectorArrays {
  std::array<float, n> x, y, z;

  Vec3 operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }
  void set(std::size_t i, Vec3 v) {
    x[i] = static_cast<float>(v.x);
    y[i] = static_cast<float>(v.y);
    z[i] = static_cast<float>(v.z);
  }
  friend bool operator==(const VectorArrays&, const VectorArrays&) = default;
};

/// Streams of random numbers, as Random of simd.h draws from them.
template <std::size_t n>
struct RandomStreams {
  std::array<std::uint32_t, n> key_low, key_high, drawn;

  void start(std::size_t i, std::uint64_t key) {
    key_low[i] = static_cast<std::uint32_t>(key);
    key_high[i] = static_cast<std::uint32_t>(key >> 32);
    drawn[i] = 0;
  }
};

/// A batch of up to `most` things, a multiple of what any register holds; its fields are of these
/// types.
template <std::size_t most>
struct Batch {
  static constexpr std::size_t capacity = most;
  /// Each array is a cache line longer than it need be, so that equal places of two of them do not
  /// fall into the same set of a cache.
  static constexpr std::size_t padding = 16;
  using Floats = std::array<float, capacity + padding>;
  using Integers = std::array<std::uint32_t, capacity + padding>;
  using Vectors = VectorArrays<capacity + padding>;
  using Streams = RandomStreams<capacity + padding>;

  std::size_t size = 0;
};

}  // namespace translucube

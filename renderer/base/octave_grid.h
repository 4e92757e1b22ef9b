#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace translucube {

/// A grid over many octaves of x >= 1: 2^segment_bits segments of equal width to the octave. The
/// exponent and the leading bits of the mantissa of x, less those of 1, are its segment; the rest
/// of the mantissa is the place in it.
template <class Float, int bits_of_segment>
struct OctaveGrid {
  using Bits =
      std::conditional_t<sizeof(Float) == sizeof(std::uint32_t), std::uint32_t, std::uint64_t>;
  static constexpr int segment_bits = bits_of_segment;
  static constexpr int fraction_bits = std::numeric_limits<Float>::digits - 1 - segment_bits;
  static constexpr Bits fraction_mask = (Bits{1} << fraction_bits) - 1;

  struct Place {
    std::size_t segment;
    Float within;  ///< in [0, 1)
  };
  static Place place(Float x) {
    const Bits position = std::bit_cast<Bits>(x) - std::bit_cast<Bits>(Float{1});
    return {position >> fraction_bits,
            static_cast<Float>(position & fraction_mask) * (Float{1} / (Bits{1} << fraction_bits))};
  }

  /// The borders of the segments of so many octaves, 1 the first of them.
  static constexpr std::size_t nodes(int octaves) {
    return (static_cast<std::size_t>(octaves) << segment_bits) + 1;
  }
  /// x at a node.
  static double at(std::size_t node) {
    constexpr std::size_t to_octave = std::size_t{1} << segment_bits;
    return std::ldexp(1 + static_cast<double>(node % to_octave) / to_octave,
                      static_cast<int>(node / to_octave));
  }
};

}  // namespace translucube

#pragma once

// IEEE 754 binary16 without its infinities and NaNs, in operations that every vector unit has.

#include <bit>
#include <cmath>
#include <cstdint>

namespace translucube {

/// The value of a half, exact, subnormals included. The exponent's bias is put right by a
/// multiplication.
inline float half_to_float(std::uint16_t half) {
  const std::uint32_t magnitude = std::uint32_t(half & 0x7fffu) << 13;
  const std::uint32_t sign = std::uint32_t(half & 0x8000u) << 16;
  return std::bit_cast<float>(
      std::bit_cast<std::uint32_t>(std::bit_cast<float>(magnitude) * 0x1p112f) | sign);
}

/// The half nearest to a value, ties to even. |value| must be less than 65504.
inline std::uint16_t float_to_half(float value) {
  const std::uint32_t bits = std::bit_cast<std::uint32_t>(std::fabs(value));
  const std::uint32_t sign = std::bit_cast<std::uint32_t>(value) >> 16 & 0x8000u;
  std::uint32_t half;
  if (std::fabs(value) < 0x1p-14f) {
    // Subnormal: multiples of 2^-24. Adding 0.5 leaves them in the last bits of the sum.
    half =
        std::bit_cast<std::uint32_t>(std::fabs(value) + 0.5f) - std::bit_cast<std::uint32_t>(0.5f);
  } else {
    half = (bits - (112u << 23) + 0xfffu + (bits >> 13 & 1u)) >> 13;
  }
  return static_cast<std::uint16_t>(half | sign);
}

}  // namespace translucube

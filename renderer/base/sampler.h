#pragma once

// Counter-based random numbers: every number is a pure function of (seed, pixel, pass, sample,
// dimension), so the bits do not depend on threads, tiles or restarts.

#include <array>
#include <cstdint>

namespace translucube {

/// Bijective 64-bit mix (Steele et al. 2014, SplitMix64; Stafford's variant 13).
constexpr std::uint64_t mix_bits(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31);
}

constexpr std::uint64_t hash_combine(std::uint64_t a, std::uint64_t b) {
  return mix_bits(a + 0x9e3779b97f4a7c15ULL + mix_bits(b));
}

struct Sample2 {
  double u, v;  ///< each in [0, 1)
};

/// An independent stream (SplitMix64: a counter through mix_bits).
class Rng {
 public:
  explicit constexpr Rng(std::uint64_t key = 0) : counter_(key) {}

  constexpr std::uint64_t bits() { return mix_bits(counter_ += 0x9e3779b97f4a7c15ULL); }
  constexpr double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  /// Uniform in (0, 1]: safe to take the logarithm of.
  constexpr double uniform_positive() { return static_cast<double>((bits() >> 11) + 1) * 0x1p-53; }
  /// Two numbers of 32 bits each from one draw.
  constexpr Sample2 uniform2() {
    const std::uint64_t b = bits();
    return {static_cast<double>(b >> 32) * 0x1p-32, static_cast<double>(b & 0xffffffffu) * 0x1p-32};
  }

 private:
  std::uint64_t counter_;
};

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x >> 16) | (x << 16);
  x = ((x & 0x00ff00ffu) << 8) | ((x & 0xff00ff00u) >> 8);
  x = ((x & 0x0f0f0f0fu) << 4) | ((x & 0xf0f0f0f0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xccccccccu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xaaaaaaaau) >> 1);
}

/// Hash-based Owen scrambling of bit-reversed digits (Laine and Karras 2011, constants of Vegdahl
/// 2021): flips each bit by a hash of the lower bits.
constexpr std::uint32_t laine_karras(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= (seed >> 16) | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

namespace detail {
/// The second dimension of Sobol' (1967) for the low and the high byte of a 16-bit index.
constexpr std::array<std::array<std::uint32_t, 256>, 2> make_sobol_table() {
  std::array<std::uint32_t, 16> direction{};
  direction[0] = 1u << 31;
  for (int i = 1; i < 16; ++i) direction[i] = direction[i - 1] ^ (direction[i - 1] >> 1);
  std::array<std::array<std::uint32_t, 256>, 2> table{};
  for (int byte = 0; byte < 2; ++byte)
    for (int value = 0; value < 256; ++value)
      for (int bit = 0; bit < 8; ++bit)
        if (value >> bit & 1) table[byte][value] ^= direction[8 * byte + bit];
  return table;
}
inline constexpr auto sobol_table = make_sobol_table();
}  // namespace detail

/// Point `index` (< 65,536) of dimension pair `pair`: the (0,2)-sequence of Sobol', shuffled and
/// Owen-scrambled for each pair (Burley 2020, "Practical Hash-based Owen Scrambling", padding).
constexpr Sample2 owen_sobol2(std::uint32_t index, std::uint64_t key, std::uint32_t pair) {
  const std::uint64_t h = hash_combine(key, pair);
  const auto order_seed = static_cast<std::uint32_t>(mix_bits(h));
  const std::uint32_t shuffled =
      reverse_bits(laine_karras(reverse_bits(index), order_seed)) & 0xffffu;
  const std::uint32_t y =
      detail::sobol_table[0][shuffled & 255u] ^ detail::sobol_table[1][shuffled >> 8];
  // The first dimension is the bit-reversed index: its reversal is the index itself.
  const std::uint32_t u = reverse_bits(laine_karras(shuffled, static_cast<std::uint32_t>(h)));
  const std::uint32_t v =
      reverse_bits(laine_karras(reverse_bits(y), static_cast<std::uint32_t>(h >> 32)));
  return {u * 0x1p-32, v * 0x1p-32};
}

/// The numbers of one camera sample: low-discrepancy pairs first, where stratification pays, an
/// independent stream from then on.
class PathSampler {
 public:
  constexpr PathSampler() = default;
  constexpr PathSampler(std::uint64_t pixel_key, std::uint32_t sample)
      : key_(pixel_key), sample_(sample), rng_(hash_combine(pixel_key, ~std::uint64_t{sample})) {}

  constexpr Sample2 next2() {
    if (pair_ < stratified_pairs) return owen_sobol2(sample_, key_, pair_++);
    return rng_.uniform2();
  }
  constexpr Rng& rng() { return rng_; }
  /// A path that leaves this one at a splitting: its own numbers from here on.
  constexpr PathSampler split() {
    PathSampler child = *this;
    child.rng_ = Rng(rng_.bits());
    return child;
  }

  static constexpr std::uint32_t stratified_pairs = 5;

 private:
  std::uint64_t key_ = 0;
  std::uint32_t sample_ = 0, pair_ = 0;
  Rng rng_;
};

}  // namespace translucube

#include "renderer/film/explorable_batch.h"

#include <array>

#include "renderer/base/half.h"

// This file is compiled once for each instruction set: the order matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/film/explorable_batch.cpp"
#include <hwy/foreach_target.h>
#include "renderer/base/simd.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

HWY_INLINE Real load_halves(const std::uint16_t* from) {
  const hn::Rebind<std::uint16_t, D> bits;
  const hn::Rebind<hwy::float16_t, D> halves;
  return hn::PromoteTo(D(), hn::BitCast(halves, hn::LoadU(bits, from)));
}

/// A row of an operator times R, G and B, in the order of apply_operator().
template <class Number>
HWY_INLINE Number row(const float* m, Number r, Number g, Number b) {
  return Number(m[0]) * r + Number(m[1]) * g + Number(m[2]) * b;
}

void DevelopHalves(std::span<const ColorOperator> operators, const std::uint16_t* halves,
                   std::size_t plane, std::size_t pixels, float* developed) {
  alignas(64) std::array<std::array<float, pixels_at_once>, 3> sum{};
  const std::size_t lanes = hn::Lanes(D()), whole = pixels - pixels % lanes;
  for (const ColorOperator& m : operators) {
    const std::uint16_t *r = halves, *g = r + plane, *b = g + plane;
    for (std::size_t i = 0; i < whole; i += lanes) {
      const Real red = load_halves(r + i), green = load_halves(g + i), blue = load_halves(b + i);
      for (int c = 0; c < 3; ++c)
        store(load(sum[c], i) + row(&m[3 * c], red, green, blue), sum[c], i);
    }
    for (std::size_t i = whole; i < pixels; ++i)
      for (int c = 0; c < 3; ++c)
        sum[c][i] += row(&m[3 * c], half_to_float(r[i]), half_to_float(g[i]), half_to_float(b[i]));
    halves = b + plane;
  }
  for (std::size_t i = 0; i < pixels; ++i)
    for (int c = 0; c < 3; ++c) developed[3 * i + c] = sum[c][i];
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace translucube {

HWY_EXPORT(DevelopHalves);

void develop_halves(std::span<const ColorOperator> operators, const std::uint16_t* halves,
                    std::size_t plane, std::size_t pixels, float* developed) {
  HWY_DYNAMIC_DISPATCH(DevelopHalves)(operators, halves, plane, pixels, developed);
}

}  // namespace translucube
#endif

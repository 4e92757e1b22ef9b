// Scattering in as many elements as a register has (see simd.h for how this is included): the same
// formulas as in medium.h.

#include "renderer/base/simd.h"

#if defined(TRANSLUCUBE_MEDIUM_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TRANSLUCUBE_MEDIUM_SIMD_H
#undef TRANSLUCUBE_MEDIUM_SIMD_H
#else
#define TRANSLUCUBE_MEDIUM_SIMD_H
#endif

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

constexpr float quarter_inv_pi = 1 / (4 * pi_f);

HWY_INLINE Real sample_henyey_greenstein(Real g, Real u) {
  const Real q = (Real(1) - g * g) / fma(g + g, u, Real(1) - g);
  return max(-1, min(1, (fma(g, g, 1) - q * q) / (g + g)));
}

HWY_INLINE Real henyey_greenstein(Real g, Real cosine) {
  const Real q = fma(g, g - (cosine + cosine), 1);
  return fnma(g, g, 1) * Real(quarter_inv_pi) / (q * sqrt(q));
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

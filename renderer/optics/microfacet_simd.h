// Microfacets and refraction in as many elements as a register has (see simd.h for how this is
// included): the same formulas as in microfacet.h, fresnel.h and microsurface.cpp.

#include "renderer/base/simd.h"

#if defined(TRANSLUCUBE_MICROFACET_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TRANSLUCUBE_MICROFACET_SIMD_H
#undef TRANSLUCUBE_MICROFACET_SIMD_H
#else
#define TRANSLUCUBE_MICROFACET_SIMD_H
#endif

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

/// Ggx, and a ray's collision rate and chance of escape in its microsurface.
struct Facets {
  Real alpha;

  HWY_INLINE Real projected_area(Vector w) const {
    const Real q = alpha * alpha * fma(w.x, w.x, w.y * w.y), root = sqrt(fma(w.z, w.z, q));
    return Real(0.5f) * select(w.z > 0, w.z + root, q / (root - w.z));
  }
  HWY_INLINE Real density(Vector m) const {
    const Real a2 = alpha * alpha, q = fma(m.z, m.z, fma(m.x, m.x, m.y * m.y) / a2);
    return Real(1) / (Real(pi_f) * a2 * q * q);
  }
  HWY_INLINE Vector sample_visible(Vector wo, Real u, Real v) const {
    const Vector w = normalize({alpha * wo.x, alpha * wo.y, wo.z});
    const Real phi = Real(2 * pi_f) * u, z = fma(Real(1) - v, Real(1) + w.z, -w.z);
    const Real r = sqrt(max(0, fnma(z, z, 1)));
    return normalize(
        {alpha * fma(r, cos(phi), w.x), alpha * fma(r, sin(phi), w.y), max(z + w.z, Real(1e-15f))});
  }
  HWY_INLINE Real collision_rate(Vector d) const {
    return projected_area(-d) / max(abs(d.z), Real(1e-12f));
  }
  HWY_INLINE Real escape(Vector d, Real depth) const {
    return or_zero(d.z > 0, exp(-(collision_rate(d) * depth)));
  }
};

HWY_INLINE Real depth_beyond(Real depth) { return -log(max(-expm1(-depth), Real(1e-30f))); }
HWY_INLINE Vector mirrored(Vector w) { return {w.x, w.y, -w.z}; }
/// The normal, on w's side, of the facet by which light goes from wi to w; `eta`: index on wi's
/// side over index on w's.
HWY_INLINE Vector facet_between(Vector w, Vector wi, Real eta) {
  const Vector h = fma(eta, wi, w);
  return copysign(1, h.z) * normalize(h);
}

/// One side of the interface.
struct Side {
  Real eta, inverse_eta;  ///< index beyond over index here

  struct Refraction {
    Real reflectance, cos_t;
  };
  HWY_INLINE Refraction refraction(Real cos_o) const {
    const Real cos2_t = fnma(fnma(cos_o, cos_o, 1), inverse_eta * inverse_eta, 1);
    const Real cos_t = sqrt(max(0, cos2_t));
    const Real s = fnma(eta, cos_t, cos_o) / fma(eta, cos_t, cos_o);
    const Real p = (eta * cos_o - cos_t) / fma(eta, cos_o, cos_t);
    return {select(cos2_t > 0, Real(0.5f) * fma(s, s, p * p), 1), cos_t};
  }
  /// The direction of w beyond a facet with normal m; w_m = dot(w, m).
  HWY_INLINE Vector refract(Vector w, Vector m, Real w_m, Real cos_t) const {
    return fma(fms(w_m, inverse_eta, cos_t), m, -(inverse_eta * w));
  }
  /// |d m / d wi| of refraction; wi_m < 0.
  HWY_INLINE Real refraction_jacobian(Real w_m, Real wi_m) const {
    const Real denominator = fma(eta, wi_m, w_m);
    // Kept off zero, where the indices are the same and nothing is refracted.
    return eta * eta * -wi_m / max(denominator * denominator, Real(1e-20f));
  }
};

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

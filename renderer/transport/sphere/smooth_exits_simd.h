// The equation psi(beta) = theta of smooth_exits.h, in as many elements as a register has (see
// simd.h for how this is included), on sines and cosines, so that no inverse trigonometric function
// is needed. The unknown is h = tan(x / 2), with x the angle of refraction t outside where
// n rho > 1, else the angle beta from the axis (from the outward radius or, far, from the inward
// one); sin beta = k_beta sin x, sin t = k_t sin x, sin i = k_i sin x.

#include "renderer/base/simd.h"

#if defined(TRANSLUCUBE_SMOOTH_EXITS_SIMD_H) == defined(HWY_TARGET_TOGGLE)
#ifdef TRANSLUCUBE_SMOOTH_EXITS_SIMD_H
#undef TRANSLUCUBE_SMOOTH_EXITS_SIMD_H
#else
#define TRANSLUCUBE_SMOOTH_EXITS_SIMD_H
#endif

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

/// An angle by its cosine and sine.
struct Turn {
  Real c, s;

  friend HWY_INLINE Turn operator+(Turn a, Turn b) {
    return {fnma(a.s, b.s, a.c * b.c), fma(a.s, b.c, a.c * b.s)};
  }
  friend HWY_INLINE Turn operator-(Turn a) { return {a.c, -a.s}; }
  friend HWY_INLINE Turn operator-(Turn a, Turn b) { return a + -b; }
};
/// Turned by pi.
HWY_INLINE Turn opposite(Turn a) { return {-a.c, -a.s}; }
HWY_INLINE Turn twice_atan(Real h) {
  const Real h2 = h * h, scale = Real(1) / (Real(1) + h2);
  return {(Real(1) - h2) * scale, (h + h) * scale};
}
/// Whether the angle a, in (0, 3 pi / 2), is less than b, which is within pi of it.
HWY_INLINE Mask less(Turn a, Turn b) { return (b - a).s > 0; }

constexpr float tiny = 1e-6f;

/// An angle whose sine is k sin x.
struct Ratio {
  Real k, rest;  ///< rest: 1 - k^2

  explicit HWY_INLINE Ratio(Real ratio) : k(ratio), rest(fnma(ratio, ratio, 1)) {}
  HWY_INLINE Turn of(Turn x) const { return {sqrt(fma(rest, x.s * x.s, x.c * x.c)), k * x.s}; }
};

/// The plane of a vertex and its light, on the near branch or the far ones.
struct Plane {
  struct Angles {
    Turn beta, t, i;  ///< beta from the axis
  };
  Ratio beta, t, i;
  bool far;

  HWY_INLINE Plane(Real n, Real rho, bool is_far) : Plane(n, n * rho, min(1, n * rho), is_far) {}

  HWY_INLINE Angles at(Turn x) const { return {beta.of(x), t.of(x), i.of(x)}; }
  HWY_INLINE Turn psi(const Angles& a) const {
    return far ? opposite(a.t - a.beta - a.i) : a.t + a.beta - a.i;
  }
  /// Where both branches end.
  HWY_INLINE Turn end() const { return psi(at({0, 1})); }
  /// d psi / d x over cos x.
  HWY_INLINE Real slope(const Angles& a) const {
    const Real of_beta = beta.k / max(a.beta.c, tiny);
    const Real rest = t.k / max(a.t.c, tiny) - i.k / a.i.c;
    return far ? rest - of_beta : rest + of_beta;
  }
  /// The slope times the three cosines of the far branches, which has no poles.
  HWY_INLINE Real far_slope(const Angles& a) const {
    return fnma(beta.k * a.t.c, a.i.c, a.beta.c * fms(t.k, a.i.c, i.k * a.t.c));
  }

 private:
  HWY_INLINE Plane(Real n, Real n_rho, Real k_t, bool is_far)
      : beta(min(1, Real(1) / n_rho)), t(k_t), i(k_t / n), far(is_far) {}
};

struct Root {
  Turn x;
  Mask found;
};

/// The root of psi = target between two values of h, where psi rises (or falls): Newton's method,
/// by bisection where that leaves the bracket. An element that has found it stands still, so that
/// when its neighbours do does not matter.
HWY_INLINE Root solve(const Plane& plane, Turn target, Real low, Real high, Real guess, bool rises,
                      int steps) {
  constexpr float tolerance = 3e-6f;  // [rad]
  Real h = guess;
  for (int step = 0;; ++step) {
    const Turn x = twice_atan(h);
    const Plane::Angles a = plane.at(x);
    const Turn off = plane.psi(a) - target;
    const Real residual = (off.s + off.s) / max(Real(1) + off.c, 1e-3f);
    const Mask found = abs(residual) < tolerance;
    if (step == steps || all(found)) return {x, found};
    const Mask below = rises ? residual < 0 : residual > 0;
    low = select(below, h, low);
    high = select(below, high, h);
    // d psi / d h = slope cos x 2 / (1 + h^2)
    const Real speed = plane.slope(a) * x.c * (Real(2) / fma(h, h, 1));
    const Real next = h - residual / speed;
    const Mask inside = both(next >= low, next <= high);  // false for NaN
    h = select(found, h, select(inside, next, Real(0.5f) * (low + high)));
  }
}

/// Where the far branch turns: the root of the slope of psi, by false position (the Illinois
/// variant: Dowell and Jarratt 1971); h = 0 or 1 where it only rises or falls.
HWY_INLINE Real far_minimum(const Plane& plane) {
  const auto slope = [&](Real h) { return plane.far_slope(plane.at(twice_atan(h))); };
  Real low = 0, high = 1, at_low = slope(low), at_high = slope(high);
  const Mask falls = at_low<0, rises = at_high> 0;
  for (int step = 0; step < 11; ++step) {
    const Real h = fnma(at_high, (high - low) / (at_high - at_low), high);
    const Real at_h = slope(h);
    const Mask crossed = at_h * at_high < 0;
    low = select(crossed, high, low);
    at_low = select(crossed, at_high, Real(0.5f) * at_low);
    high = h;
    at_high = at_h;
  }
  return or_zero(falls, select(rises, high, 1));
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

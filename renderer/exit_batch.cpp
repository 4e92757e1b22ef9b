// The roots of psi(beta) = theta on sines and cosines, so that no inverse trigonometric function is
// needed. The unknown is h = tan(x / 2), with x the angle of refraction t outside where n rho > 1,
// else the angle beta from the axis (from the outward radius or, far, from the inward one);
// sin beta = k_beta sin x, sin t = k_t sin x, sin i = k_i sin x.

#include "renderer/exit_batch.h"

#include "renderer/fresnel.h"

// This file is compiled once for each instruction set: the order matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/exit_batch.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
#include <hwy/contrib/math/math-inl.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<float>;
using V = hn::Vec<D>;
using M = hn::Mask<D>;

HWY_INLINE V set(float value) { return hn::Set(D(), value); }
HWY_INLINE V load(const ExitBatch::Floats& from, std::size_t i) { return hn::LoadU(D(), &from[i]); }
HWY_INLINE void store(V value, ExitBatch::Floats& to, std::size_t i) {
  hn::StoreU(value, D(), &to[i]);
}

/// An angle by its cosine and sine.
struct Turn {
  V c, s;
};
HWY_INLINE Turn operator+(Turn a, Turn b) {
  return {hn::NegMulAdd(a.s, b.s, hn::Mul(a.c, b.c)), hn::MulAdd(a.s, b.c, hn::Mul(a.c, b.s))};
}
HWY_INLINE Turn operator-(Turn a) { return {a.c, hn::Neg(a.s)}; }
HWY_INLINE Turn operator-(Turn a, Turn b) { return a + -b; }
/// Turned by pi.
HWY_INLINE Turn opposite(Turn a) { return {hn::Neg(a.c), hn::Neg(a.s)}; }
HWY_INLINE Turn twice_atan(V h) {
  const V h2 = hn::Mul(h, h), scale = hn::Div(set(1), hn::Add(set(1), h2));
  return {hn::Mul(hn::Sub(set(1), h2), scale), hn::Mul(hn::Add(h, h), scale)};
}

/// sin(angle) = k sin x.
struct Ratio {
  V k, rest;  ///< 1 - k^2

  explicit Ratio(V ratio) : k(ratio), rest(hn::NegMulAdd(ratio, ratio, set(1))) {}
  HWY_INLINE Turn of(Turn x) const {
    const V s2 = hn::Mul(x.s, x.s);
    return {hn::Sqrt(hn::MulAdd(rest, s2, hn::Mul(x.c, x.c))), hn::Mul(k, x.s)};
  }
};

struct Angles {
  Turn beta, t, i;  ///< beta from the axis
};

/// A vertex, as the equation sees it.
struct Plane {
  Ratio beta, t, i;
  bool far;

  HWY_INLINE Angles at(Turn x) const { return {beta.of(x), t.of(x), i.of(x)}; }
  HWY_INLINE Turn psi(const Angles& a) const {
    return far ? opposite(a.t - a.beta - a.i) : a.t + a.beta - a.i;
  }
  /// d psi / d x over cos x.
  HWY_INLINE V slope(const Angles& a) const {
    const V tiny = set(1e-6f);
    const V of_beta = hn::Div(beta.k, hn::Max(a.beta.c, tiny));
    const V rest = hn::Sub(hn::Div(t.k, hn::Max(a.t.c, tiny)), hn::Div(i.k, a.i.c));
    return far ? hn::Sub(rest, of_beta) : hn::Add(rest, of_beta);
  }
};

constexpr float tolerance = 3e-6f;  // [rad]

struct Root {
  Turn x;
  M found;
};

/// The root of psi = target between two values of h, where psi rises (or falls): Newton's method,
/// by bisection where that leaves the bracket.
HWY_INLINE Root solve(const Plane& plane, Turn target, V low, V high, V guess, bool rises,
                      int steps) {
  V h = guess;
  for (int step = 0;; ++step) {
    const Turn x = twice_atan(h);
    const Angles a = plane.at(x);
    const Turn off = plane.psi(a) - target;
    const V residual = hn::Div(hn::Add(off.s, off.s), hn::Max(hn::Add(set(1), off.c), set(1e-3f)));
    if (step == steps) return {x, hn::Lt(hn::Abs(residual), set(tolerance))};
    const M below = rises ? hn::Lt(residual, set(0)) : hn::Gt(residual, set(0));
    low = hn::IfThenElse(below, h, low);
    high = hn::IfThenElse(below, high, h);
    // d psi / d h = slope cos x 2 / (1 + h^2)
    const V speed =
        hn::Mul(hn::Mul(plane.slope(a), x.c), hn::Div(set(2), hn::MulAdd(h, h, set(1))));
    const V next = hn::Sub(h, hn::Div(residual, speed));
    const M inside = hn::And(hn::Ge(next, low), hn::Le(next, high));  // false for NaN
    h = hn::IfThenElse(inside, next, hn::Mul(set(0.5f), hn::Add(low, high)));
  }
}

/// Where the far branch turns, by bisection in h.
HWY_INLINE V far_minimum(const Plane& plane) {
  V low = set(0), high = set(1);
  for (int step = 0; step < 22; ++step) {
    const V h = hn::Mul(set(0.5f), hn::Add(low, high));
    const M falls = hn::Lt(plane.slope(plane.at(twice_atan(h))), set(0));
    low = hn::IfThenElse(falls, h, low);
    high = hn::IfThenElse(falls, high, h);
  }
  return hn::Mul(set(0.5f), hn::Add(low, high));
}

/// Whether the angle a, in (0, 3 pi / 2), is less than b, which is within pi of it.
HWY_INLINE M less(Turn a, Turn b) { return hn::Gt((b - a).s, set(0)); }

void FindExits(const ExitMedium& medium, ExitBranch branch, ExitBatch& batch) {
  const V one = set(1), tiny = set(1e-6f);
  const V n = set(medium.ior), sigma_s = set(medium.sigma_s), g = set(medium.g);
  const bool far = branch != ExitBranch::near;
  constexpr float quarter_inv_pi = 0.0795774715f;
  for (std::size_t lane = 0; lane < batch.size; lane += hn::Lanes(D())) {
    const V ux = load(batch.up_x, lane), uy = load(batch.up_y, lane), uz = load(batch.up_z, lane);
    const V wx = load(batch.light_x, lane), wy = load(batch.light_y, lane),
            wz = load(batch.light_z, lane);
    const V depth2 = load(batch.depth2, lane), rho = hn::Sqrt(hn::Sub(one, depth2));
    const V n_rho = hn::Mul(n, rho), k_t = hn::Min(one, n_rho);
    const Plane plane{Ratio(hn::Min(one, hn::Div(one, n_rho))), Ratio(k_t), Ratio(hn::Div(k_t, n)),
                      far};

    // The wanted angle, and the direction across in the plane.
    const V cos_theta = hn::MulAdd(ux, wx, hn::MulAdd(uy, wy, hn::Mul(uz, wz)));
    V ex = hn::NegMulAdd(cos_theta, ux, wx), ey = hn::NegMulAdd(cos_theta, uy, wy),
      ez = hn::NegMulAdd(cos_theta, uz, wz);
    const V sin_theta = hn::Sqrt(hn::MulAdd(ex, ex, hn::MulAdd(ey, ey, hn::Mul(ez, ez))));
    V unit = hn::Div(one, hn::Max(sin_theta, tiny));
    if (branch == ExitBranch::far_round) unit = hn::Neg(unit);
    ex = hn::Mul(ex, unit);
    ey = hn::Mul(ey, unit);
    ez = hn::Mul(ez, unit);
    Turn theta{cos_theta, sin_theta};
    if (branch == ExitBranch::far_round) theta = -theta;  // 2 pi - theta

    const Turn end = plane.psi(plane.at({set(0), one}));
    M reachable;
    Root root;
    if (!far) {
      reachable = less(theta, end);
      // psi(x) >= x: from above, half the sine over one plus the cosine.
      const V guess =
          hn::Min(hn::Div(sin_theta, hn::Max(hn::Add(one, cos_theta), tiny)), set(0.95f));
      root = solve(plane, theta, set(0), one, guess, true, 7);
    } else {
      const V turn = far_minimum(plane);
      const Turn least = plane.psi(plane.at(twice_atan(turn)));
      if (branch == ExitBranch::far_falling) {
        reachable = hn::And(less(least, theta), hn::Gt(turn, tiny));
        root = solve(plane, theta, set(0), turn, hn::Mul(set(0.5f), turn), false, 16);
      } else {
        reachable = hn::And(less(theta, end), less(least, theta));
        root = solve(plane, theta, turn, one, hn::Mul(set(0.5f), hn::Add(turn, one)), true, 16);
      }
    }
    const Angles a = plane.at(root.x);
    const V cos_beta = far ? hn::Neg(a.beta.c) : a.beta.c, sin_beta = a.beta.s;

    // The Jacobian sin beta / (|sin psi| |psi'|), and the ray.
    const V slope =
        hn::Abs(hn::MulAdd(hn::Mul(rho, cos_beta),
                           hn::Sub(hn::Div(n, hn::Max(a.t.c, tiny)), hn::Div(one, a.i.c)), one));
    const V across = hn::IfThenElse(hn::Lt(sin_theta, set(1e-3f)), hn::Div(one, slope),
                                    hn::Div(sin_beta, hn::Max(sin_theta, tiny)));
    const V jacobian = hn::Div(across, hn::Max(slope, tiny));
    const V distance = far ? hn::NegMulAdd(rho, cos_beta, a.i.c)
                           : hn::Div(depth2, hn::MulAdd(rho, cos_beta, a.i.c));
    const V dx = hn::MulAdd(cos_beta, ux, hn::Mul(sin_beta, ex)),
            dy = hn::MulAdd(cos_beta, uy, hn::Mul(sin_beta, ey)),
            dz = hn::MulAdd(cos_beta, uz, hn::Mul(sin_beta, ez));
    const V cosine =
        hn::MulAdd(load(batch.in_x, lane), dx,
                   hn::MulAdd(load(batch.in_y, lane), dy, hn::Mul(load(batch.in_z, lane), dz)));
    const V q = hn::MulAdd(g, hn::Sub(g, hn::Add(cosine, cosine)), one);
    const V phase =
        hn::Div(hn::Mul(hn::NegMulAdd(g, g, one), set(quarter_inv_pi)), hn::Mul(q, hn::Sqrt(q)));
    const V pdf =
        hn::Mul(hn::Mul(phase, jacobian), hn::Exp(D(), hn::Neg(hn::Mul(sigma_s, distance))));
    // Fresnel from inside.
    const V rs = hn::Div(hn::MulSub(n, a.i.c, a.t.c), hn::MulAdd(n, a.i.c, a.t.c));
    const V rp = hn::Div(hn::NegMulAdd(n, a.t.c, a.i.c), hn::MulAdd(n, a.t.c, a.i.c));
    const V transmitted = hn::NegMulAdd(set(0.5f), hn::MulAdd(rs, rs, hn::Mul(rp, rp)), one);
    const V share = hn::Div(hn::Mul(transmitted, pdf), hn::Add(pdf, load(batch.light_pdf, lane)));
    store(hn::IfThenElseZero(reachable, hn::IfThenElse(root.found, share, set(-1))), batch.share,
          lane);
    store(distance, batch.distance, lane);
    // Where it leaves: p + distance d.
    store(hn::MulAdd(distance, dx, hn::Mul(rho, ux)), batch.normal_x, lane);
    store(hn::MulAdd(distance, dy, hn::Mul(rho, uy)), batch.normal_y, lane);
    store(hn::MulAdd(distance, dz, hn::Mul(rho, uz)), batch.normal_z, lane);
  }
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace translucube {

HWY_EXPORT(FindExits);

double share(const Medium& medium, double ior, const SphereExit& exit, Vec3 before,
             double light_pdf) {
  const double pdf =
      medium.phase(dot(before, exit.d)) * std::exp(-medium.sigma_s * exit.distance) * exit.jacobian;
  return (1 - fresnel(exit.cos_i, 1 / ior)) * pdf / (light_pdf + pdf);
}

void find_exits(const ExitMedium& medium, ExitBranch branch, ExitBatch& batch) {
  HWY_DYNAMIC_DISPATCH(FindExits)(medium, branch, batch);
}

}  // namespace translucube
#endif

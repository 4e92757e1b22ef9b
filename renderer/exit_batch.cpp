// The root of psi(beta) = theta by Newton's method on sines and cosines, so that no inverse
// trigonometric function is needed. The unknown x is the angle of refraction t outside where
// n rho > 1, beta elsewhere; sin beta = k_beta sin x, sin t = k_t sin x, sin i = k_i sin x.

#include "renderer/exit_batch.h"

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

constexpr int newton_steps = 6;
constexpr float tolerance = 3e-6f;  // [rad]

/// A sum of angles as a unit complex number.
struct Turn {
  V c, s;
};
HWY_INLINE Turn operator+(Turn a, Turn b) {
  return {hn::NegMulAdd(a.s, b.s, hn::Mul(a.c, b.c)), hn::MulAdd(a.s, b.c, hn::Mul(a.c, b.s))};
}
HWY_INLINE Turn operator-(Turn a) { return {a.c, hn::Neg(a.s)}; }

/// Sine and cosine of an angle whose sine is k sin x.
HWY_INLINE Turn scaled(Turn x, V k, V one_minus_k2) {
  const V s2 = hn::Mul(x.s, x.s);
  return {hn::Sqrt(hn::MulAdd(one_minus_k2, s2, hn::Mul(x.c, x.c))), hn::Mul(k, x.s)};
}

void FindNearExits(const ExitMedium& medium, ExitBatch& batch) {
  const D d;
  const V one = hn::Set(d, 1.0f), zero = hn::Zero(d), tiny = hn::Set(d, 1e-6f);
  const V n = hn::Set(d, medium.ior), sigma_s = hn::Set(d, medium.sigma_s);
  const V g = hn::Set(d, medium.g);
  constexpr float quarter_inv_pi = 0.0795774715f;
  for (std::size_t i = 0; i < batch.size; i += hn::Lanes(d)) {
    const V ux = hn::LoadU(d, &batch.up_x[i]), uy = hn::LoadU(d, &batch.up_y[i]),
            uz = hn::LoadU(d, &batch.up_z[i]), depth2 = hn::LoadU(d, &batch.depth2[i]);
    const V wx = hn::LoadU(d, &batch.light_x[i]), wy = hn::LoadU(d, &batch.light_y[i]),
            wz = hn::LoadU(d, &batch.light_z[i]);
    const V rho2 = hn::Sub(one, depth2), rho = hn::Sqrt(rho2);
    const V n_rho = hn::Mul(n, rho);
    const auto by_t = hn::Gt(n_rho, one);
    const V k_beta = hn::IfThenElse(by_t, hn::Div(one, n_rho), one);
    const V k_t = hn::IfThenElse(by_t, one, n_rho);
    const V k_i = hn::Div(k_t, n);
    const V rest_beta = hn::NegMulAdd(k_beta, k_beta, one), rest_t = hn::NegMulAdd(k_t, k_t, one),
            rest_i = hn::NegMulAdd(k_i, k_i, one);

    // The wanted angle, and the direction across in the plane.
    const V cos_theta = hn::MulAdd(ux, wx, hn::MulAdd(uy, wy, hn::Mul(uz, wz)));
    V ex = hn::NegMulAdd(cos_theta, ux, wx), ey = hn::NegMulAdd(cos_theta, uy, wy),
      ez = hn::NegMulAdd(cos_theta, uz, wz);
    const V sin_theta = hn::Sqrt(hn::MulAdd(ex, ex, hn::MulAdd(ey, ey, hn::Mul(ez, ez))));
    const V unit = hn::Div(one, hn::Max(sin_theta, tiny));
    ex = hn::Mul(ex, unit);
    ey = hn::Mul(ey, unit);
    ez = hn::Mul(ez, unit);
    const Turn theta{cos_theta, sin_theta};

    // The end of the branch, x = pi / 2, lies between pi / 2 and pi.
    const Turn right{zero, one};
    const Turn end =
        scaled(right, k_beta, rest_beta) + scaled(right, k_t, rest_t) + -scaled(right, k_i, rest_i);
    const auto reachable = hn::Gt(cos_theta, end.c);

    // From above: psi(x) >= x.
    const auto blunt = hn::Lt(cos_theta, hn::Set(d, 0.1f));
    Turn x{hn::IfThenElse(blunt, hn::Set(d, 0.1f), cos_theta),
           hn::IfThenElse(blunt, hn::Set(d, 0.99498744f), sin_theta)};
    Turn beta, t, inside;
    V residual = one;
    for (int step = 0;; ++step) {
      beta = scaled(x, k_beta, rest_beta);
      t = scaled(x, k_t, rest_t);
      inside = scaled(x, k_i, rest_i);
      const Turn off = beta + t + -inside + -theta;
      residual = hn::Div(hn::Add(off.s, off.s), hn::Max(hn::Add(one, off.c), hn::Set(d, 1e-3f)));
      if (step == newton_steps) break;
      const V slope = hn::Mul(x.c, hn::Sub(hn::Add(hn::Div(k_beta, hn::Max(beta.c, tiny)),
                                                   hn::Div(k_t, hn::Max(t.c, tiny))),
                                           hn::Div(k_i, inside.c)));
      // Half the angle of the step is near enough to its tangent.
      V h = hn::Mul(hn::Set(d, -0.5f), hn::Div(residual, hn::Max(slope, hn::Set(d, 1e-3f))));
      h = hn::Clamp(h, hn::Set(d, -0.4f), hn::Set(d, 0.4f));
      const V h2 = hn::Mul(h, h), scale = hn::Div(one, hn::Add(one, h2)),
              c = hn::Mul(hn::Sub(one, h2), scale), s = hn::Mul(hn::Add(h, h), scale);
      x = x + Turn{c, s};
      // Kept inside (0, pi / 2).
      x.c = hn::Max(x.c, hn::Set(d, 1e-5f));
      x.s = hn::Max(x.s, hn::Set(d, 0.0f));
    }

    // beta + t - i, the Jacobian sin beta / (sin psi |psi'|), and the ray.
    const V slope = hn::MulAdd(
        hn::Mul(rho, beta.c), hn::Sub(hn::Div(n, hn::Max(t.c, tiny)), hn::Div(one, inside.c)), one);
    const V across = hn::IfThenElse(hn::Lt(sin_theta, hn::Set(d, 1e-3f)), hn::Div(one, slope),
                                    hn::Div(beta.s, hn::Max(sin_theta, tiny)));
    const V jacobian = hn::Div(across, slope);
    const V distance = hn::Div(depth2, hn::MulAdd(rho, beta.c, inside.c));
    const V cosine = hn::MulAdd(
        hn::LoadU(d, &batch.in_x[i]), hn::MulAdd(beta.c, ux, hn::Mul(beta.s, ex)),
        hn::MulAdd(
            hn::LoadU(d, &batch.in_y[i]), hn::MulAdd(beta.c, uy, hn::Mul(beta.s, ey)),
            hn::Mul(hn::LoadU(d, &batch.in_z[i]), hn::MulAdd(beta.c, uz, hn::Mul(beta.s, ez)))));
    const V q = hn::MulAdd(g, hn::Sub(g, hn::Add(cosine, cosine)), one);
    const V phase = hn::Div(hn::Mul(hn::NegMulAdd(g, g, one), hn::Set(d, quarter_inv_pi)),
                            hn::Mul(q, hn::Sqrt(q)));
    const V pdf =
        hn::Mul(hn::Mul(phase, jacobian), hn::Exp(d, hn::Neg(hn::Mul(sigma_s, distance))));
    const V rs = hn::Div(hn::MulSub(n, inside.c, t.c), hn::MulAdd(n, inside.c, t.c));
    const V rp = hn::Div(hn::NegMulAdd(n, t.c, inside.c), hn::MulAdd(n, t.c, inside.c));
    const V transmitted = hn::NegMulAdd(hn::Set(d, 0.5f), hn::MulAdd(rs, rs, hn::Mul(rp, rp)), one);
    const V share =
        hn::Div(hn::Mul(transmitted, pdf), hn::Add(pdf, hn::LoadU(d, &batch.light_pdf[i])));
    const auto found = hn::Lt(hn::Abs(residual), hn::Set(d, tolerance));
    hn::StoreU(hn::IfThenElseZero(reachable, hn::IfThenElse(found, share, hn::Set(d, -1.0f))), d,
               &batch.share[i]);
    hn::StoreU(distance, d, &batch.distance[i]);
    const Turn place = beta + -inside;
    hn::StoreU(hn::MulAdd(place.c, ux, hn::Mul(place.s, ex)), d, &batch.normal_x[i]);
    hn::StoreU(hn::MulAdd(place.c, uy, hn::Mul(place.s, ey)), d, &batch.normal_y[i]);
    hn::StoreU(hn::MulAdd(place.c, uz, hn::Mul(place.s, ez)), d, &batch.normal_z[i]);
  }
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace translucube {

HWY_EXPORT(FindNearExits);

void find_near_exits(const ExitMedium& medium, ExitBatch& batch) {
  HWY_DYNAMIC_DISPATCH(FindNearExits)(medium, batch);
}

}  // namespace translucube
#endif

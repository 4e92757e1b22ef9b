// The roots of psi(beta) = theta on sines and cosines, so that no inverse trigonometric function is
// needed. The unknown is h = tan(x / 2), with x the angle of refraction t outside where n rho > 1,
// else the angle beta from the axis (from the outward radius or, far, from the inward one);
// sin beta = k_beta sin x, sin t = k_t sin x, sin i = k_i sin x.

#include "renderer/transport/sphere/smooth_exits_batch.h"

#include "renderer/optics/fresnel.h"

// This file is compiled once for each instruction set: the order matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/transport/sphere/smooth_exits_batch.cpp"
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
HWY_INLINE V load(const SmoothExitBatch::Floats& from, std::size_t i) {
  return hn::LoadU(D(), &from[i]);
}
HWY_INLINE void store(V value, SmoothExitBatch::Floats& to, std::size_t i) {
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
constexpr float tiny = 1e-6f;

struct Root {
  Turn x;
  M found;
};

/// The root of psi = target between two values of h, where psi rises (or falls): Newton's method,
/// by bisection where that leaves the bracket. A lane that has found it stands still, so that when
/// its neighbours do does not matter.
HWY_INLINE Root solve(const Plane& plane, Turn target, V low, V high, V guess, bool rises,
                      int steps) {
  V h = guess;
  for (int step = 0;; ++step) {
    const Turn x = twice_atan(h);
    const Angles a = plane.at(x);
    const Turn off = plane.psi(a) - target;
    const V residual = hn::Div(hn::Add(off.s, off.s), hn::Max(hn::Add(set(1), off.c), set(1e-3f)));
    const M found = hn::Lt(hn::Abs(residual), set(tolerance));
    if (step == steps || hn::AllTrue(D(), found)) return {x, found};
    const M below = rises ? hn::Lt(residual, set(0)) : hn::Gt(residual, set(0));
    low = hn::IfThenElse(below, h, low);
    high = hn::IfThenElse(below, high, h);
    // d psi / d h = slope cos x 2 / (1 + h^2)
    const V speed =
        hn::Mul(hn::Mul(plane.slope(a), x.c), hn::Div(set(2), hn::MulAdd(h, h, set(1))));
    const V next = hn::Sub(h, hn::Div(residual, speed));
    const M inside = hn::And(hn::Ge(next, low), hn::Le(next, high));  // false for NaN
    const V moved = hn::IfThenElse(inside, next, hn::Mul(set(0.5f), hn::Add(low, high)));
    h = hn::IfThenElse(found, h, moved);
  }
}

/// Where the far branch turns: the root of the slope of psi, by false position (the Illinois
/// variant: Dowell and Jarratt 1971); h = 0 or 1 where it only rises or falls.
HWY_INLINE V far_minimum(const Plane& plane) {
  // The slope times the three cosines, which has no poles.
  const auto slope = [&](V h) {
    const Angles a = plane.at(twice_atan(h));
    return hn::NegMulAdd(
        hn::Mul(plane.beta.k, a.t.c), a.i.c,
        hn::Mul(a.beta.c, hn::MulSub(plane.t.k, a.i.c, hn::Mul(plane.i.k, a.t.c))));
  };
  V low = set(0), high = set(1), at_low = slope(low), at_high = slope(high);
  const M falls = hn::Lt(at_low, set(0)), rises = hn::Gt(at_high, set(0));
  for (int step = 0; step < 11; ++step) {
    const V h = hn::NegMulAdd(at_high, hn::Div(hn::Sub(high, low), hn::Sub(at_high, at_low)), high);
    const V at_h = slope(h);
    const M crossed = hn::Lt(hn::Mul(at_h, at_high), set(0));
    low = hn::IfThenElse(crossed, high, low);
    at_low = hn::IfThenElse(crossed, at_high, hn::Mul(set(0.5f), at_low));
    high = h;
    at_high = at_h;
  }
  return hn::IfThenElseZero(falls, hn::IfThenElse(rises, high, set(1)));
}

/// Whether the angle a, in (0, 3 pi / 2), is less than b, which is within pi of it.
HWY_INLINE M less(Turn a, Turn b) { return hn::Gt((b - a).s, set(0)); }

HWY_INLINE V dot(V ax, V ay, V az, V bx, V by, V bz) {
  return hn::MulAdd(ax, bx, hn::MulAdd(ay, by, hn::Mul(az, bz)));
}

HWY_INLINE Plane plane_of(V n, V rho, bool far) {
  const V one = set(1), n_rho = hn::Mul(n, rho), k_t = hn::Min(one, n_rho);
  return {Ratio(hn::Min(one, hn::Div(one, n_rho))), Ratio(k_t), Ratio(hn::Div(k_t, n)), far};
}

/// Share that a smooth boundary lets out, by the cosines inside and outside.
HWY_INLINE V transmittance(V n, V cos_i, V cos_t) {
  const V rs = hn::Div(hn::MulSub(n, cos_i, cos_t), hn::MulAdd(n, cos_i, cos_t));
  const V rp = hn::Div(hn::NegMulAdd(n, cos_t, cos_i), hn::MulAdd(n, cos_t, cos_i));
  return hn::NegMulAdd(set(0.5f), hn::MulAdd(rs, rs, hn::Mul(rp, rp)), set(1));
}

void ChooseLights(const SmoothExitMedium& medium, const LightStrata& lights, std::size_t position,
                  SmoothExitBatch& batch) {
  constexpr std::size_t candidates = LightStrata::candidates, positions = LightStrata::positions,
                        stride = positions + LightStrata::padding;
  const V one = set(1), n = set(medium.ior);
  const hn::Rebind<std::int32_t, D> di;
  HWY_ALIGN std::array<float, candidates * hn::MaxLanes(D())> values;
  for (std::size_t lane = 0; lane < batch.size; lane += hn::Lanes(D())) {
    const V ux = load(batch.up_x, lane), uy = load(batch.up_y, lane), uz = load(batch.up_z, lane);
    const V ax = load(batch.axis_x, lane), ay = load(batch.axis_y, lane),
            az = load(batch.axis_z, lane);
    // up, turned: along + cos x + sin y
    const V cosine = dot(ax, ay, az, ux, uy, uz);
    const V lx = hn::Mul(cosine, ax), ly = hn::Mul(cosine, ay), lz = hn::Mul(cosine, az);
    const V xx = hn::Sub(ux, lx), xy = hn::Sub(uy, ly), xz = hn::Sub(uz, lz);
    const V yx = hn::MulSub(ay, uz, hn::Mul(az, uy)), yy = hn::MulSub(az, ux, hn::Mul(ax, uz)),
            yz = hn::MulSub(ax, uy, hn::Mul(ay, ux));
    const V start = hn::Mul(set(2 * 3.14159265f), load(batch.turn, lane));
    const Turn turned{hn::Cos(D(), start), hn::Sin(D(), start)};
    // What leaves goes about as the cosine next to the surface and is the same in all directions
    // from the centre; none beyond the end of the branch.
    const V rho = hn::Sqrt(hn::Sub(one, load(batch.depth2, lane)));
    const Plane plane = plane_of(n, rho, false);
    const V end = plane.psi(plane.at({set(0), one})).c;
    const V rho2 = hn::Mul(rho, rho), cosine_part = hn::Mul(rho2, rho2);
    const V scale = hn::Div(cosine_part, hn::Sub(one, end));
    const V offset = hn::NegMulAdd(scale, end, hn::Sub(one, cosine_part));
    const V least = set(0.01f);
    const std::size_t first = (position + lane) % positions;
    V sum = set(0);
    for (std::size_t j = 0; j < candidates; ++j) {
      const std::size_t at = j * stride + first;
      const V wx = hn::LoadU(D(), &lights.x[at]), wy = hn::LoadU(D(), &lights.y[at]),
              wz = hn::LoadU(D(), &lights.z[at]);
      const Turn angle = turned + Turn{set(lights.cos_turn[j]), set(lights.sin_turn[j])};
      const V c =
          hn::MulAdd(angle.c, dot(xx, xy, xz, wx, wy, wz),
                     hn::MulAdd(angle.s, dot(yx, yy, yz, wx, wy, wz), dot(lx, ly, lz, wx, wy, wz)));
      const V value =
          hn::Max(least, hn::IfThenElse(hn::Gt(c, end), hn::MulAdd(scale, c, offset), least));
      hn::Store(value, D(), &values[j * hn::Lanes(D())]);
      sum = hn::Add(sum, value);
    }
    const V wanted = hn::Mul(sum, load(batch.choice, lane));
    V below = set(0), chosen = set(0), value = hn::Load(D(), values.data());
    for (std::size_t j = 1; j < candidates; ++j) {
      below = hn::Add(below, hn::Load(D(), &values[(j - 1) * hn::Lanes(D())]));
      const M passed = hn::Ge(wanted, below);
      chosen = hn::IfThenElse(passed, set(static_cast<float>(j)), chosen);
      value = hn::IfThenElse(passed, hn::Load(D(), &values[j * hn::Lanes(D())]), value);
    }
    const auto turn = hn::ConvertTo(di, chosen);
    const auto place = hn::And(hn::Iota(di, static_cast<std::int32_t>(first)),
                               hn::Set(di, std::int32_t(positions - 1)));
    const auto index = hn::Add(hn::Mul(turn, hn::Set(di, std::int32_t(stride))), place);
    const V wx = hn::GatherIndex(D(), lights.x.data(), index),
            wy = hn::GatherIndex(D(), lights.y.data(), index),
            wz = hn::GatherIndex(D(), lights.z.data(), index);
    const Turn angle = turned + Turn{hn::GatherIndex(D(), lights.cos_turn.data(), turn),
                                     hn::GatherIndex(D(), lights.sin_turn.data(), turn)};
    // The light, turned back.
    const V along = hn::Mul(dot(ax, ay, az, wx, wy, wz), hn::Sub(one, angle.c));
    store(hn::MulAdd(
              along, ax,
              hn::NegMulAdd(angle.s, hn::MulSub(ay, wz, hn::Mul(az, wy)), hn::Mul(angle.c, wx))),
          batch.light_x, lane);
    store(hn::MulAdd(
              along, ay,
              hn::NegMulAdd(angle.s, hn::MulSub(az, wx, hn::Mul(ax, wz)), hn::Mul(angle.c, wy))),
          batch.light_y, lane);
    store(hn::MulAdd(
              along, az,
              hn::NegMulAdd(angle.s, hn::MulSub(ax, wy, hn::Mul(ay, wx)), hn::Mul(angle.c, wz))),
          batch.light_z, lane);
    hn::StoreU(hn::Add(hn::Mul(turn, hn::Set(di, std::int32_t(positions))), place), di,
               &batch.light[lane]);
    store(
        hn::Mul(load(batch.light_pdf, lane), hn::Div(hn::Mul(value, set(float(candidates))), sum)),
        batch.light_pdf, lane);
  }
}

void DrawExits(const SmoothExitMedium& medium, SmoothExitBatch& batch) {
  const V one = set(1), n = set(medium.ior), sigma_s = set(medium.sigma_s);
  for (std::size_t lane = 0; lane < batch.size; lane += hn::Lanes(D())) {
    const V depth2 = load(batch.depth2, lane);
    const V rho2 = hn::Sub(one, depth2), rho = hn::Sqrt(rho2);
    const V largest = hn::Min(one, hn::Div(one, hn::Mul(hn::Mul(n, n), rho2)));       // sin^2
    const V width = hn::Div(largest, hn::Add(one, hn::Sqrt(hn::Sub(one, largest))));  // 1 - cos
    const V cos_beta = hn::NegMulAdd(width, load(batch.drawn, lane), one);
    const V sin2_i = hn::Mul(rho2, hn::NegMulAdd(cos_beta, cos_beta, one));
    const V cos_i = hn::Sqrt(hn::Sub(one, sin2_i));
    const V cos_t = hn::Sqrt(hn::Max(set(0), hn::NegMulAdd(hn::Mul(n, n), sin2_i, one)));
    const V distance = hn::Div(depth2, hn::MulAdd(rho, cos_beta, cos_i));
    const V share = hn::Mul(hn::Mul(hn::Mul(set(0.5f), width), transmittance(n, cos_i, cos_t)),
                            hn::Exp(D(), hn::Neg(hn::Mul(sigma_s, distance))));
    store(share, batch.drawn_share, lane);
    store(distance, batch.drawn_distance, lane);
    store(hn::MulAdd(distance, cos_beta, rho), batch.drawn_cosine, lane);
  }
}

/// A vertex and its light, in the plane of both.
struct Wanted {
  Plane plane;
  V ux, uy, uz, rho, depth2;
  Turn theta;    ///< the wanted angle; on far_round 2 pi less it
  V sin_theta;   ///< of the angle itself
  V ex, ey, ez;  ///< across, towards the light (on far_round away from it)

  /// `get` reads a lane of each of a batch's arrays.
  template <class Get>
  HWY_INLINE Wanted(V n, ExitBranch branch, const SmoothExitBatch& batch, Get&& get)
      : plane(
            plane_of(n, hn::Sqrt(hn::Sub(set(1), get(batch.depth2))), branch != ExitBranch::near)),
        ux(get(batch.up_x)),
        uy(get(batch.up_y)),
        uz(get(batch.up_z)),
        depth2(get(batch.depth2)) {
    rho = hn::Sqrt(hn::Sub(set(1), depth2));
    const V wx = get(batch.light_x), wy = get(batch.light_y), wz = get(batch.light_z);
    const V cos_theta = hn::MulAdd(ux, wx, hn::MulAdd(uy, wy, hn::Mul(uz, wz)));
    ex = hn::NegMulAdd(cos_theta, ux, wx);
    ey = hn::NegMulAdd(cos_theta, uy, wy);
    ez = hn::NegMulAdd(cos_theta, uz, wz);
    sin_theta = hn::Sqrt(hn::MulAdd(ex, ex, hn::MulAdd(ey, ey, hn::Mul(ez, ez))));
    V unit = hn::Div(set(1), hn::Max(sin_theta, set(tiny)));
    theta = {cos_theta, sin_theta};
    if (branch == ExitBranch::far_round) {
      unit = hn::Neg(unit);
      theta = -theta;
    }
    ex = hn::Mul(ex, unit);
    ey = hn::Mul(ey, unit);
    ez = hn::Mul(ez, unit);
  }

  /// Whether there is a root on the branch; `turn`: far_minimum() of a far one.
  HWY_INLINE M reachable(ExitBranch branch, V turn) const {
    const Turn end = plane.psi(plane.at({set(0), set(1)}));
    if (branch == ExitBranch::near) return less(theta, end);
    const M beyond = less(plane.psi(plane.at(twice_atan(turn))), theta);
    return branch == ExitBranch::far_falling ? hn::And(beyond, hn::Gt(turn, set(tiny)))
                                             : hn::And(beyond, less(theta, end));
  }

  HWY_INLINE Root solve(ExitBranch branch, V turn) const {
    const V zero = set(0), one = set(1), half = set(0.5f);
    if (branch == ExitBranch::near) {
      // psi(x) >= x: from above, half the sine over one plus the cosine.
      const V guess =
          hn::Min(hn::Div(sin_theta, hn::Max(hn::Add(one, theta.c), set(tiny))), set(0.95f));
      return HWY_NAMESPACE::solve(plane, theta, zero, one, guess, true, 7);
    }
    if (branch == ExitBranch::far_falling)
      return HWY_NAMESPACE::solve(plane, theta, zero, turn, hn::Mul(half, turn), false, 16);
    return HWY_NAMESPACE::solve(plane, theta, turn, one, hn::Mul(half, hn::Add(turn, one)), true,
                                16);
  }
};

void FindMinima(const SmoothExitMedium& medium, SmoothExitBatch& batch) {
  for (std::size_t lane = 0; lane < batch.size; lane += hn::Lanes(D())) {
    const V rho = hn::Sqrt(hn::Sub(set(1), load(batch.depth2, lane)));
    store(far_minimum(plane_of(set(medium.ior), rho, true)), batch.minimum, lane);
  }
}

void FindExits(const SmoothExitMedium& medium, ExitBranch branch, Division division,
               SmoothExitBatch& batch) {
  const V one = set(1), n = set(medium.ior), sigma_s = set(medium.sigma_s), g = set(medium.g);
  const bool far = branch != ExitBranch::near;
  const hn::RebindToSigned<D> di;
  constexpr float quarter_inv_pi = 0.0795774715f;

  // Few have a way out on a far branch: they are solved side by side.
  std::array<std::int32_t, SmoothExitBatch::capacity + hn::MaxLanes(D())> found;
  std::size_t count = 0;
  for (std::size_t lane = 0; lane < batch.size; lane += hn::Lanes(D())) {
    const Wanted wanted(n, branch, batch,
                        [&](const SmoothExitBatch::Floats& from) { return load(from, lane); });
    const M reachable = hn::And(wanted.reachable(branch, far ? load(batch.minimum, lane) : one),
                                hn::FirstN(D(), batch.size - lane));
    hn::StoreU(
        hn::Compress(hn::Iota(di, static_cast<std::int32_t>(lane)), hn::RebindMask(di, reachable)),
        di, &found[count]);
    count += hn::CountTrue(D(), reachable);
    store(set(0), batch.share, lane);
  }
  for (std::size_t i = count; i < count + hn::Lanes(D()); ++i)
    found[i] = found[count > 0 ? count - 1 : 0];

  for (std::size_t first = 0; first < count; first += hn::Lanes(D())) {
    const auto index = hn::LoadU(di, &found[first]);
    const auto get = [&](const SmoothExitBatch::Floats& from) {
      return hn::GatherIndex(D(), from.data(), index);
    };
    const auto put = [&](V value, SmoothExitBatch::Floats& to) {
      hn::ScatterIndex(value, D(), to.data(), index);
    };
    const Wanted w(n, branch, batch, get);
    const Root root = w.solve(branch, far ? get(batch.minimum) : one);
    const Angles a = w.plane.at(root.x);
    const V rho = w.rho;
    const V cos_beta = far ? hn::Neg(a.beta.c) : a.beta.c, sin_beta = a.beta.s;

    // The Jacobian sin beta / (|sin psi| |psi'|), and the ray.
    const V slope = hn::Abs(
        hn::MulAdd(hn::Mul(rho, cos_beta),
                   hn::Sub(hn::Div(n, hn::Max(a.t.c, set(tiny))), hn::Div(one, a.i.c)), one));
    const V across = hn::IfThenElse(hn::Lt(w.sin_theta, set(1e-3f)), hn::Div(one, slope),
                                    hn::Div(sin_beta, hn::Max(w.sin_theta, set(tiny))));
    const V jacobian = hn::Div(across, hn::Max(slope, set(tiny)));
    const V distance = far ? hn::NegMulAdd(rho, cos_beta, a.i.c)
                           : hn::Div(w.depth2, hn::MulAdd(rho, cos_beta, a.i.c));
    const V dx = hn::MulAdd(cos_beta, w.ux, hn::Mul(sin_beta, w.ex)),
            dy = hn::MulAdd(cos_beta, w.uy, hn::Mul(sin_beta, w.ey)),
            dz = hn::MulAdd(cos_beta, w.uz, hn::Mul(sin_beta, w.ez));
    const V cosine = dot(get(batch.in_x), get(batch.in_y), get(batch.in_z), dx, dy, dz);
    const V q = hn::MulAdd(g, hn::Sub(g, hn::Add(cosine, cosine)), one);
    const V phase =
        hn::Div(hn::Mul(hn::NegMulAdd(g, g, one), set(quarter_inv_pi)), hn::Mul(q, hn::Sqrt(q)));
    const V pdf =
        hn::Mul(hn::Mul(phase, jacobian), hn::Exp(D(), hn::Neg(hn::Mul(sigma_s, distance))));
    const V by_walk = division == Division::balanced ? pdf : set(0);
    const V share = hn::Div(hn::Mul(transmittance(n, a.i.c, a.t.c), pdf),
                            hn::Add(by_walk, get(batch.light_pdf)));
    put(hn::IfThenElse(root.found, share, set(-1)), batch.share);
    put(distance, batch.distance);
    // Where it leaves: p + distance d.
    put(hn::MulAdd(distance, dx, hn::Mul(rho, w.ux)), batch.normal_x);
    put(hn::MulAdd(distance, dy, hn::Mul(rho, w.uy)), batch.normal_y);
    put(hn::MulAdd(distance, dz, hn::Mul(rho, w.uz)), batch.normal_z);
  }
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace translucube {

HWY_EXPORT(ChooseLights);
HWY_EXPORT(FindMinima);
HWY_EXPORT(FindExits);
HWY_EXPORT(DrawExits);

LightStrata::LightStrata() {
  for (std::size_t j = 0; j < candidates; ++j) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(j) / double(candidates);
    cos_turn[j] = static_cast<float>(std::cos(angle));
    sin_turn[j] = static_cast<float>(std::sin(angle));
  }
}

void LightStrata::set(std::size_t i, Vec3 direction) {
  const std::size_t first = i / positions * (positions + padding);
  for (std::size_t at = i % positions; at < positions + padding; at += positions) {
    x[first + at] = static_cast<float>(direction.x);
    y[first + at] = static_cast<float>(direction.y);
    z[first + at] = static_cast<float>(direction.z);
  }
}

double share_of(const Medium& medium, double ior, const SmoothExit& exit, Vec3 before,
                double light_pdf, Division division) {
  const double pdf =
      medium.phase(dot(before, exit.d)) * std::exp(-medium.sigma_s * exit.distance) * exit.jacobian;
  return (1 - fresnel(exit.cos_i, 1 / ior)) * pdf /
         (light_pdf + (division == Division::balanced ? pdf : 0));
}

void choose_lights(const SmoothExitMedium& medium, const LightStrata& lights, std::size_t position,
                   SmoothExitBatch& batch) {
  HWY_DYNAMIC_DISPATCH(ChooseLights)(medium, lights, position, batch);
}

void find_minima(const SmoothExitMedium& medium, SmoothExitBatch& batch) {
  HWY_DYNAMIC_DISPATCH(FindMinima)(medium, batch);
}

void find_exits(const SmoothExitMedium& medium, ExitBranch branch, Division division,
                SmoothExitBatch& batch) {
  HWY_DYNAMIC_DISPATCH(FindExits)(medium, branch, division, batch);
}

void draw_exits(const SmoothExitMedium& medium, SmoothExitBatch& batch) {
  HWY_DYNAMIC_DISPATCH(DrawExits)(medium, batch);
}

}  // namespace translucube
#endif

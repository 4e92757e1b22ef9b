#include "renderer/transport/sphere/smooth_exits_batch.h"

#include <algorithm>

#include "renderer/optics/fresnel.h"

// This file is compiled once for each instruction set: the order matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/transport/sphere/smooth_exits_batch.cpp"
#include <hwy/foreach_target.h>
#include "renderer/optics/medium_simd.h"
#include "renderer/transport/sphere/smooth_exits_simd.h"
#include "renderer/transport/sphere/sphere_simd.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

/// Share that a smooth boundary lets out, by the cosines inside and outside.
HWY_INLINE Real transmittance(Real n, Real cos_i, Real cos_t) {
  const Real rs = fms(n, cos_i, cos_t) / fma(n, cos_i, cos_t);
  const Real rp = fnma(n, cos_t, cos_i) / fma(n, cos_t, cos_i);
  return fnma(0.5f, fma(rs, rs, rp * rp), 1);
}

/// A vertex and its light, in the plane of both.
struct Wanted : Vertex {
  ExitBranch branch;
  Plane plane;
  Real turn;       ///< where the far branches turn
  Turn theta;      ///< the wanted angle; on far_round 2 pi less it
  Real sin_theta;  ///< of the angle itself
  Vector across;   ///< towards the light (on far_round away from it), perpendicular to up

  template <class Place>
  HWY_INLINE Wanted(Real n, ExitBranch on, const SmoothExitBatch& batch, Place at)
      : Vertex(batch, at),
        branch(on),
        plane(n, rho, branch != ExitBranch::near),
        turn(plane.far ? load(batch.minimum, at) : Real(1)) {
    const Vector light = load(batch.light, at);
    const Real cos_theta = dot(up, light);
    across = fnma(cos_theta, up, light);
    sin_theta = sqrt(dot(across, across));
    Real unit = Real(1) / max(sin_theta, tiny);
    theta = {cos_theta, sin_theta};
    if (branch == ExitBranch::far_round) {
      unit = -unit;
      theta = -theta;
    }
    across = unit * across;
  }

  /// Whether there is a root on the branch.
  HWY_INLINE Mask reachable() const {
    if (branch == ExitBranch::near) return less(theta, plane.end());
    const Mask beyond = less(plane.psi(plane.at(twice_atan(turn))), theta);
    return both(beyond, branch == ExitBranch::far_falling ? turn > tiny : less(theta, plane.end()));
  }

  HWY_INLINE Root root() const {
    if (branch == ExitBranch::near) {
      // psi(x) >= x: from above, half the sine over one plus the cosine.
      const Real guess = min(sin_theta / max(Real(1) + theta.c, tiny), 0.95f);
      return solve(plane, theta, 0, 1, guess, true, 7);
    }
    if (branch == ExitBranch::far_falling)
      return solve(plane, theta, 0, turn, Real(0.5f) * turn, false, 16);
    return solve(plane, theta, turn, 1, Real(0.5f) * (turn + Real(1)), true, 16);
  }
};

/// The way out at a root.
struct Exit {
  Real cos_i, cos_t;
  Real jacobian;  ///< solid angle inside to solid angle outside: sin beta / (|sin psi| |psi'|)
  Real distance;
  Vector d;

  HWY_INLINE Exit(const Wanted& from, Real n, Turn x) {
    const Plane::Angles a = from.plane.at(x);
    cos_i = a.i.c;
    cos_t = a.t.c;
    const Real cos_beta = from.plane.far ? -a.beta.c : a.beta.c, sin_beta = a.beta.s;
    const Real slope = abs(fma(from.rho * cos_beta, n / max(cos_t, tiny) - Real(1) / cos_i, 1));
    jacobian =
        select(from.sin_theta < 1e-3f, Real(1) / slope, sin_beta / max(from.sin_theta, tiny)) /
        max(slope, tiny);
    distance = from.plane.far ? fnma(from.rho, cos_beta, cos_i)
                              : from.depth2 / fma(from.rho, cos_beta, cos_i);
    d = fma(cos_beta, from.up, sin_beta * from.across);
  }
};

/// The vertices from which there is a way out on a branch, by their numbers. Few have one on a far
/// branch: they are solved side by side.
struct Reachable {
  std::array<std::uint32_t, SmoothExitBatch::capacity + at_once> numbers;
  std::size_t size = 0;

  Reachable(Real n, ExitBranch branch, const SmoothExitBatch& batch) {
    for (std::size_t i = 0; i < batch.size; i += at_once) {
      const Mask found = both(Wanted(n, branch, batch, i).reachable(), first(batch.size - i));
      pack(counting(i), found, numbers, size);
      size += count(found);
    }
    // The last register is filled up.
    std::fill_n(&numbers[size], at_once, size > 0 ? numbers[size - 1] : 0);
  }
};

void FindMinima(const SmoothExitMedium& medium, SmoothExitBatch& batch) {
  for (std::size_t i = 0; i < batch.size; i += at_once)
    store(far_minimum(Plane(medium.ior, Vertex(batch, i).rho, true)), batch.minimum, i);
}

void FindExits(const SmoothExitMedium& medium, ExitBranch branch, Division division,
               SmoothExitBatch& batch) {
  const Real n = medium.ior, sigma_s = medium.sigma_s, g = medium.g;
  for (std::size_t i = 0; i < batch.size; i += at_once) store(Real(0), batch.share, i);
  const Reachable reachable(n, branch, batch);
  for (std::size_t i = 0; i < reachable.size; i += at_once) {
    const Bits at = load(reachable.numbers, i);
    const Wanted from(n, branch, batch, at);
    const Root root = from.root();
    const Exit exit(from, n, root.x);
    const Real phase = henyey_greenstein(g, dot(load(batch.d, at), exit.d));
    const Real pdf = phase * exit.jacobian * exp(-(sigma_s * exit.distance));
    const Real by_walk = division == Division::balanced ? pdf : Real(0);
    const Real share =
        transmittance(n, exit.cos_i, exit.cos_t) * pdf / (by_walk + load(batch.light_pdf, at));
    store(select(root.found, share, SmoothExitBatch::not_found), batch.share, at);
    store(exit.distance, batch.distance, at);
    store(from.at(exit.distance, exit.d), batch.normal, at);
  }
}

void DrawExits(const SmoothExitMedium& medium, SmoothExitBatch& batch) {
  const Real n = medium.ior, sigma_s = medium.sigma_s;
  for (std::size_t i = 0; i < batch.size; i += at_once) {
    const Real depth2 = load(batch.depth2, i);
    const Real rho2 = Real(1) - depth2, rho = sqrt(rho2);
    const Real largest = min(1, Real(1) / (n * n * rho2));             // sin^2
    const Real width = largest / (Real(1) + sqrt(Real(1) - largest));  // 1 - cos
    const Real cos_beta = fnma(width, load(batch.drawn, i), 1);
    const Real sin2_i = rho2 * fnma(cos_beta, cos_beta, 1);
    const Real cos_i = sqrt(Real(1) - sin2_i);
    const Real cos_t = sqrt(max(0, fnma(n * n, sin2_i, 1)));
    const Real distance = depth2 / fma(rho, cos_beta, cos_i);
    store(Real(0.5f) * width * transmittance(n, cos_i, cos_t) * exp(-(sigma_s * distance)),
          batch.drawn_share, i);
    store(distance, batch.drawn_distance, i);
    store(fma(distance, cos_beta, rho), batch.drawn_cosine, i);
  }
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace translucube {

HWY_EXPORT(FindMinima);
HWY_EXPORT(FindExits);
HWY_EXPORT(DrawExits);

double share_of(const Medium& medium, double ior, const SmoothExit& exit, Vec3 before,
                double light_pdf, Division division) {
  const double pdf =
      medium.phase(dot(before, exit.d)) * std::exp(-medium.sigma_s * exit.distance) * exit.jacobian;
  return (1 - fresnel(exit.cos_i, 1 / ior)) * pdf /
         (light_pdf + (division == Division::balanced ? pdf : 0));
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

#pragma once

// Ways out of a smooth unit sphere towards a wanted direction: manifold next-event estimation
// (Hanika, Droske, Fascione 2015) in the one equation that it is on a sphere.
//
// A ray that starts at radius rho and looks at angle beta from its outward radius meets the
// boundary at incidence i, sin i = rho sin beta, and goes on outside at angle t from the normal,
// sin t = n sin i. All in one plane, it ends up at the angle
//   psi(beta) = beta + t - i
// from the outward radius. On the near branch, beta below pi / 2 or the critical angle, psi grows
// from 0 and has one root. On the far branch it falls from pi to a minimum and may rise again.

#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "renderer/base/vec.h"

namespace translucube {

/// The parts of the two branches in which psi is monotone. On far_round the light goes the other
/// way round the body: psi = 2 pi - theta.
enum class ExitBranch { near, far_falling, far_rising, far_round };
inline constexpr std::array far_branches{ExitBranch::far_falling, ExitBranch::far_rising,
                                         ExitBranch::far_round};

/// One way out.
struct SmoothExit {
  Vec3 d;           ///< inside, from the vertex
  double distance;  ///< to the boundary
  double cos_i;     ///< at the boundary, inside
  double jacobian;  ///< solid angle inside (at the vertex) to solid angle outside
};

/// The ways out from one point.
class SmoothExits {
 public:
  /// `ior` >= 1; p inside the unit sphere, depth2 = 1 - |p|^2.
  SmoothExits(double ior, Vec3 p, double depth2);
  SmoothExits(double ior, Vec3 p) : SmoothExits(ior, p, 1 - length_squared(p)) {}

  /// The way out towards w (unit) on a branch, if there is one.
  std::optional<SmoothExit> towards(Vec3 w, ExitBranch branch) const;

  /// Length of the shortest way out on the far branch.
  double shortest_far() const {
    const double sin_i = std::fmin(rho_, 1 / ior_);  // at the end of the branch
    return std::sqrt(1 - sin_i * sin_i) + std::sqrt(std::fmax(0.0, rho_ * rho_ - sin_i * sin_i));
  }
  double rho() const { return rho_; }
  /// d omega_inside / d omega_outside of a ray from the point along d.
  double jacobian(Vec3 d) const;
  /// Whether a ray along d belongs to the far branch.
  bool is_far(Vec3 d) const { return dot(d, up_) <= 0; }

 private:
  /// A branch in a variable x in [0, x_max]: beta' (angle to the axis, 0 to pi / 2) where
  /// rho n < 1, t elsewhere: psi is smooth in it up to the end.
  struct Angles {
    double beta, i,
        t;  ///< beta from the axis: from the outward radius or, far, from the inward one
  };
  Angles angles(double x) const {
    if (by_t_) {
      const double s = std::sin(x);
      return {std::asin(std::fmin(1.0, s / (ior_ * rho_))), std::asin(s / ior_), x};
    }
    const double s = rho_ * std::sin(x);
    return {x, std::asin(s), std::asin(ior_ * s)};
  }
  /// d(beta, i, t) / dx.
  Angles slopes(double x, const Angles& a) const {
    if (by_t_) {
      const double c = std::cos(x);
      return {c / (ior_ * rho_ * std::fmax(std::cos(a.beta), 1e-12)), c / (ior_ * std::cos(a.i)),
              1};
    }
    const double c = rho_ * std::cos(x);
    return {1, c / std::cos(a.i), ior_ * c / std::fmax(std::cos(a.t), 1e-12)};
  }
  double psi(double x, bool far) const {
    const Angles a = angles(x);
    return far ? std::numbers::pi - a.beta + a.t - a.i : a.beta + a.t - a.i;
  }
  double psi_slope(double x, bool far) const {
    const Angles a = slopes(x, angles(x));
    return (far ? -a.beta : a.beta) + a.t - a.i;
  }
  /// Where the far branch turns.
  double far_minimum() const;
  /// The root of psi = target in [low, high], where psi is monotone.
  double solve(double target, bool far, double low, double high) const;
  struct Wanted {
    double angle;  ///< between up and the wanted direction
    Vec3 across;   ///< towards it, perpendicular to up
  };
  Wanted wanted(Vec3 w) const;
  SmoothExit exit_at(double x, bool far, Vec3 across) const;

  static constexpr double x_max = std::numbers::pi / 2;
  double ior_, rho_, depth2_;
  bool by_t_;
  Vec3 up_;
};

inline SmoothExits::SmoothExits(double ior, Vec3 p, double depth2)
    : ior_(ior), rho_(std::sqrt(std::fmax(0.0, 1 - depth2))), depth2_(depth2) {
  const double norm = length(p);
  up_ = norm > 1e-12 ? p * (1 / norm) : Vec3{0, 0, 1};
  by_t_ = ior_ * rho_ > 1;
}

inline double SmoothExits::solve(double target, bool far, double low, double high) const {
  double f_low = psi(low, far) - target, f_high = psi(high, far) - target;
  double x = low - f_low * (high - low) / (f_high - f_low);
  for (int i = 0; i < 40; ++i) {
    const double f = psi(x, far) - target;
    if (std::fabs(f) < 1e-11) break;
    if ((f < 0) == (f_low < 0))
      low = x;
    else
      high = x;
    const double step = f / psi_slope(x, far);
    x -= step;
    if (!(x > low && x < high)) x = 0.5 * (low + high);
  }
  return x;
}

inline double SmoothExits::far_minimum() const {
  double low = 0, high = x_max;
  if (psi_slope(low, true) >= 0) return low;
  if (psi_slope(high, true) <= 0) return high;
  while (high - low > 1e-9) {
    const double middle = 0.5 * (low + high);
    (psi_slope(middle, true) < 0 ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

inline double SmoothExits::jacobian(Vec3 d) const {
  const double cosine = dot(d, up_);
  const double sine = length(cross(d, up_));
  const double sin_i = rho_ * sine, sin_t = ior_ * sin_i;
  const double cos_i = std::sqrt(std::fmax(0.0, 1 - sin_i * sin_i));
  const double cos_t = std::sqrt(std::fmax(1e-24, 1 - sin_t * sin_t));
  const double slope = 1 + rho_ * cosine * (ior_ / cos_t - 1 / cos_i);
  double across;  // sin beta / sin psi
  if (sine < 1e-7) {
    across = 1 / std::fabs(slope);
  } else {
    // sin(beta + t - i)
    const double cos_ti = cos_t * cos_i + sin_t * sin_i, sin_ti = sin_t * cos_i - cos_t * sin_i;
    across = sine / std::fmax(std::fabs(sine * cos_ti + cosine * sin_ti), 1e-14);
  }
  return across / std::fmax(std::fabs(slope), 1e-14);
}

inline SmoothExits::Wanted SmoothExits::wanted(Vec3 w) const {
  const double cosine = dot(w, up_);
  const Vec3 across = w - cosine * up_;
  const double sine = length(across);
  return {std::atan2(sine, cosine), sine > 0 ? across * (1 / sine) : Frame(up_).x};
}

inline SmoothExit SmoothExits::exit_at(double x, bool far, Vec3 across) const {
  const Angles a = angles(x);
  const double cos_beta = std::cos(a.beta) * (far ? -1 : 1);
  SmoothExit exit;
  exit.d = cos_beta * up_ + std::sin(a.beta) * across;
  exit.cos_i = std::cos(a.i);
  exit.distance = far ? exit.cos_i - rho_ * cos_beta : depth2_ / (exit.cos_i + rho_ * cos_beta);
  exit.jacobian = jacobian(exit.d);
  return exit;
}

inline std::optional<SmoothExit> SmoothExits::towards(Vec3 w, ExitBranch branch) const {
  const Wanted to = wanted(w);
  if (branch == ExitBranch::near) {
    if (to.angle >= psi(x_max, false)) return {};
    return exit_at(solve(to.angle, false, 0, x_max), false, to.across);
  }
  const double x_min = far_minimum(), least = psi(x_min, true), end = psi(x_max, true);
  if (branch == ExitBranch::far_falling) {
    if (to.angle <= least || x_min == 0) return {};
    return exit_at(solve(to.angle, true, 0, x_min), true, to.across);
  }
  const bool round = branch == ExitBranch::far_round;
  const double target = round ? 2 * std::numbers::pi - to.angle : to.angle;
  if (target <= least || target >= end) return {};
  return exit_at(solve(target, true, x_min, x_max), true, round ? -to.across : to.across);
}

}  // namespace translucube

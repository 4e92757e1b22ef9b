#include "renderer/slab/jump.h"

#include <cmath>
#include <numbers>

#include "renderer/optics/ball_tables.h"

namespace translucube::slab {
namespace {

/// Light on a jump comes no nearer to a face than this, in transport mean free paths.
constexpr double jump_margin = 4;
/// Milne's problem: light leaves a thick medium as from `milne_length` transport mean free paths
/// behind its face, which is the mean cosine of its flux; the density mu (milne_slope + mu) has
/// that mean and follows Chandrasekhar's H (1960, section 16) within a few percent.
constexpr double milne_slope = 0.6036;

/// Time at which a Brownian motion of variance 2 t first leaves [-1, 1] from its centre. Its
/// Laplace transform 1 / cosh(sqrt s) is a product over exponential times of means
/// 4 / (pi (2k + 1))^2 (Biane, Pitman, Yor 2001, "Probability laws related to the Jacobi theta and
/// Riemann zeta functions", table 1); those past the sixth add their mean.
double sample_exit_time(Rng& rng) {
  double time = 0, left = 0.5;
  for (int k = 0; k < 6; ++k) {
    const double root = 2 / (std::numbers::pi * (2 * k + 1)), mean = root * root;
    time -= mean * std::log(rng.uniform_positive());
    left -= mean;
  }
  return time + left;
}

}  // namespace

Jump sample_jump(double z, double mu, double g, double transport_length, Rng& rng) {
  // z + mu l* is a walk's martingale: the layer's centre lies g mu l* ahead of the scatterer.
  const double centre = z + g * mu * transport_length;
  const double half = std::fmin(centre, 1 - centre) - jump_margin * transport_length;
  const double extrapolated = half + milne_length * transport_length;
  const double length = 3 * extrapolated * extrapolated / transport_length * sample_exit_time(rng);
  constexpr double linear = milne_slope / 2 / (milne_slope / 2 + 1.0 / 3);
  const Sample2 u = rng.uniform2();
  const double cosine = u.u < linear ? std::sqrt(u.v) : std::cbrt(u.v);
  const double side = rng.uniform() < 0.5 ? -1 : 1;
  return {centre + side * half, side * cosine, length};
}

}  // namespace translucube::slab

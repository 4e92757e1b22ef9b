#pragma once

// Large exact steps. Inside a homogeneous, isotropically scattering body the largest ball around a
// collision that fits into the body can be crossed in one step: where light leaves the ball is
// uniform by symmetry, and in which direction and after what length depends on the ball's optical
// radius alone (Moon, Walter, Marschner 2007, "Rendering Discrete Random Media Using Precomputed
// Scattering Solutions"; Muller et al. 2016, "Efficient Rendering of Heterogeneous Polydisperse
// Granular Media"). The exits are simulated when the project is built (make_ball_tables.cpp), for
// optical radii 2, 4, 8 ...: a walk always takes the largest ball that fits, so nothing is
// interpolated. The cost of a walk then grows with the logarithm of the density.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>

#include "renderer/base/sampler.h"
#include "renderer/base/vec.h"
#include "renderer/optics/medium.h"

namespace translucube {

/// How light that started in all directions at the centre of a ball leaves it for the first time.
struct BallExit {
  float mu;      ///< cosine between the direction of travel and the outward radius, (0, 1]
  float length;  ///< [mean free paths]
};

/// Levels of optical radius 2, 4, 8 ...; beyond the tabulated ones the exits of the last table with
/// longer lengths: in a ball of many mean free paths their laws are those of diffusion and of
/// Milne's half space.
inline constexpr int ball_levels = 40, tabulated_levels = 8, exits_per_ball = 8192;

/// Optical radius of a level [mean free paths].
constexpr double ball_radius(int level) { return static_cast<double>(std::uint64_t{2} << level); }

/// Milne's extrapolation length [mean free paths] (Hopf 1934).
inline constexpr double milne_length = 0.710446;

/// Mean length from the centre out, (tau + z0)^2 / 2 with z0 Milne's length: the simulation
/// confirms it to 0.1 % from optical radius 2 on.
constexpr double mean_ball_length(int level) {
  const double extrapolated = ball_radius(level) + milne_length;
  return 0.5 * extrapolated * extrapolated;
}

/// The largest level whose ball has at most this optical radius; -1 if there is none.
inline int ball_level(double optical_radius) {
  if (!(optical_radius >= 2)) return -1;
  return std::min(std::ilogb(optical_radius) - 1, ball_levels - 1);
}

struct BallCrossing {
  Vec3 outward;       ///< from the centre to the exit, unit
  Vec3 direction;     ///< of travel at the exit
  double length = 0;  ///< [mean free paths]
};

/// One of exits_per_ball equally likely exits of the level's table, turned at random.
inline BallCrossing cross_ball(std::span<const BallExit> exits, Rng& rng) {
  const BallExit& exit = exits[rng.bits() & (exits_per_ball - 1)];
  const Vec3 outward = sample_isotropic(rng);
  const double phi = 2 * std::numbers::pi * rng.uniform();
  const double sine = std::sqrt(std::fmax(0.0, 1 - double(exit.mu) * exit.mu));
  return {outward, Frame(outward).to_world({sine * std::cos(phi), sine * std::sin(phi), exit.mu}),
          exit.length};
}

/// The tables, one after the other: tabulated_levels x exits_per_ball.
const BallExit* ball_exits();

/// Crosses the ball of a level in [0, ball_levels).
BallCrossing cross_ball(int level, Rng& rng);

}  // namespace translucube

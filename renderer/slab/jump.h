#pragma once

#include "renderer/base/sampler.h"

namespace translucube::slab {

/// Deeper than this below both faces, in transport mean free paths, light crosses many of them in
/// one step.
inline constexpr double jump_depth = 16;

/// Where a jump ends, and how far light has travelled on it.
struct Jump {
  double z, mu, length;
};

/// Many mean free paths at once, from a scatterer at depth z that light reached in direction mu to
/// the border of a layer around it. Either border is as likely, so that energy keeps exactly what a
/// walk keeps; lengths are those of diffusion to the borders' extrapolated places.
Jump sample_jump(double z, double mu, double g, double transport_length, Rng& rng);

}  // namespace translucube::slab

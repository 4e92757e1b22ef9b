#pragma once

// Random walks of light through a flat slab, from the light's side.

#include <cstdint>

#include "renderer/slab/body.h"
#include "renderer/slab/tally.h"

namespace translucube::slab {

/// Whether anything of this body is left to chance.
bool needs_walks(const Body& body);

/// Adds histories [first, first + count) of unit incident weight each. Light that crosses smooth
/// faces without meeting a scatterer is left out: direct.h has it in closed form.
void walk(const Body& body, Incidence incidence, std::uint64_t key, std::uint64_t first,
          std::uint64_t count, Tally& tally);

/// Does what walk() does with every flight walked one by one: a reference for tests.
void walk_analog(const Body& body, Incidence incidence, std::uint64_t key, std::uint64_t first,
                 std::uint64_t count, Tally& tally);

}  // namespace translucube::slab

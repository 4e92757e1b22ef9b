#pragma once

// Slab optics of scattering layers by adding and doubling (layer.h), where light paths would
// have to be followed through too many scatterers.

#include <array>
#include <optional>

#include "renderer/slab/reading.h"

namespace translucube::slab {

/// Readings at normal and at diffuse incidence.
struct AddedReadings {
  std::array<Readings, 2> at;
  std::uint64_t samples = 0;  ///< of rough faces
};

/// Empty where the body is too thin or scatters too narrowly for its streams, or where they do not
/// reach `standard_error`: then light has to walk.
///
/// Replicates are solved alternately with fewer and with more streams: behind smooth faces, where
/// nothing else differs, the standard error is half of that difference.
std::optional<AddedReadings> add_layers(const Body& body, const Channels& channels,
                                        double standard_error, std::uint64_t seed, int threads);

}  // namespace translucube::slab

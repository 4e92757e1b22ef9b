#pragma once

// From absorption along a path to what is read of it: R, G, B, and wavelength bands.

#include <vector>

#include "renderer/optics/material.h"

namespace translucube::slab {

struct Channels {
  std::vector<double> sigma_a;  ///< of each channel, in 1 / thickness; may be infinite
  /// Rows over the channels: linear Rec.709 R, G, B of white D65 light, then the means over the
  /// bands (none for an absorber that is given by R, G, B: it has no spectrum).
  std::vector<std::vector<double>> readouts;

  std::size_t size() const { return sigma_a.size(); }
  /// All readouts of a quantity that is known for each channel.
  std::vector<double> read(const std::vector<double>& of_channels) const;
};

/// The channels of a slab. Bodies that light does not enter, or that absorb nothing, have a single
/// grey channel.
Channels make_channels(const Material& material, double thickness_mm);

}  // namespace translucube::slab

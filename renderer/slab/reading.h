#pragma once

// From tallies to readings with their standard errors. Readings that are no linear function of the
// light (CIELAB, haze, clarity) have their errors from the jackknife over independent replicates
// (Efron 1982), which for linear ones is the usual standard error.

#include <optional>
#include <vector>

#include "renderer/slab/appearance.h"
#include "renderer/slab/body.h"
#include "renderer/slab/spectral.h"
#include "renderer/slab/tally.h"

namespace translucube::slab {

/// Readouts (Channels) of the light at one incidence, apart by where and how it leaves.
struct Reading {
  std::vector<double> specular, regular;                ///< no scatterer met, smooth faces
  std::array<std::vector<double>, exit_count> diffuse;  ///< by Exit
};

struct Readings {
  Reading unwalked;                 ///< known in closed form
  std::vector<Reading> replicates;  ///< independent estimates of the rest; none, or at least two
};

/// What needs no walk: light through smooth faces, and what the infinitely dense body sends back.
Reading read_unwalked(const Body& body, Incidence incidence, const Channels& channels);

/// Develops the absorber of a tally.
class Developer {
 public:
  Developer(const Channels& channels, double sigma_a_peak);

  /// The reading of a tally of so many histories of weight 1.
  Reading develop(const Tally& tally, double histories);

 private:
  const Channels& channels_;
  double sigma_a_peak_;
  std::vector<std::vector<double>> table_;  ///< for each node, the readouts of light of its length
};

SlabAppearance::AtIncidence optics_of(const Readings& readings);
std::optional<SlabAppearance::Estimate> haze_of(const Readings& readings);
std::optional<SlabAppearance::Estimate> clarity_of(const Readings& readings);
/// The largest standard error of R, G, B of reflectance and transmittance.
double largest_error_of_totals(const Readings& readings);

}  // namespace translucube::slab

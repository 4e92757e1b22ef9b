#pragma once

// From tallies to readings with their standard errors. Readings that are no linear function of the
// light (CIELAB, haze, clarity) have their errors from the jackknife over independent replicates
// (Efron 1982), which for linear ones is the usual standard error.

#include <optional>
#include <vector>

#include "renderer/slab/appearance.h"
#include "renderer/slab/spectral.h"
#include "renderer/slab/walk.h"

namespace translucube {

/// Readouts (SlabChannels) of the light at one incidence, apart by where and how it leaves.
struct SlabRead {
  std::vector<double> specular, regular;                ///< no scatterer met, smooth faces
  std::array<std::vector<double>, slab_exits> diffuse;  ///< by SlabExit
};

struct Readings {
  SlabRead unwalked;                 ///< known in closed form
  std::vector<SlabRead> replicates;  ///< independent estimates of the rest; none, or at least two
};

/// What needs no walk: light through smooth faces, and what the infinitely dense body sends back.
SlabRead read_unwalked(const SlabBody& body, Incidence incidence, const SlabChannels& channels);

/// Develops the absorber of a tally.
class SlabDeveloper {
 public:
  SlabDeveloper(const SlabChannels& channels, double sigma_a_peak);

  /// For so many histories of weight 1.
  SlabRead develop(const SlabTally& tally, double histories);

 private:
  const SlabChannels& channels_;
  double sigma_a_peak_;
  std::vector<std::vector<double>> table_;  ///< for each node, the readouts of light of its length
};

SlabAppearance::AtIncidence optics_of(const Readings& readings);
std::optional<Estimate> haze_of(const Readings& readings);
std::optional<Estimate> clarity_of(const Readings& readings);
/// Over R, G, B of reflectance and transmittance.
double largest_error_of_totals(const Readings& readings);

}  // namespace translucube

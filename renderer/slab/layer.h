#pragma once

// A scattering layer without faces, by adding and doubling (van de Hulst 1980, chapter 4; Plass,
// Kattawar, Catchings 1973, "Matrix operator theory of radiative transfer"): the light's directions
// are a few streams, a layer is what it sends from stream to stream, and two equal layers on each
// other are one of twice the thickness. Nothing is left to chance, and a thousand times the density
// costs ten doublings more.
//
// Streams carry flux, not radiance: operators act on shares of the light, and those of a layer that
// does not absorb have columns that sum to 1.

#include <Eigen/Core>
#include <vector>

#include "renderer/optics/medium.h"

namespace translucube::slab {

/// Cosines of the angles to the normal inside the slab and the measures d(mu) that they stand for.
/// In this order: trapped behind a smooth face (Gauss and Legendre's rule in mu), open (the same
/// rule in the cosine outside, in which Fresnel's equations are smooth), the ring and the core of
/// Exit.
struct Streams {
  Eigen::VectorXd mu, weight;
  std::vector<double> mu_outside, weight_outside;  ///< of all but the trapped streams
  int trapped = 0;

  int count() const { return static_cast<int>(mu.size()); }
  int ring() const { return count() - 2; }
  int core() const { return count() - 1; }
};

/// `points` on either side of the critical angle.
Streams make_streams(double ior, int points);

/// What a layer sends back to either side where both sides send it the same light (even), or the
/// opposite (odd): reflection plus and minus transmission.
struct Layer {
  Eigen::MatrixXd even, odd;
};

/// The layers of one medium, for any absorption. Scattering that no stream resolves counts as
/// straight on (Wiscombe 1977, "The delta-M method").
class Layers {
 public:
  /// `medium` in 1 / thickness. `first_depth`: optical depth of the layer that is doubled, or less;
  /// its error is of second order in it.
  Layers(const Streams& streams, const Medium& medium, double first_depth);

  /// `sigma_a` [1 / thickness], finite.
  Layer layer(double sigma_a) const;

  /// Share of scattered light that counts as straight on.
  static double straight_share(double g, int points);

 private:
  Eigen::VectorXd inverse_mu_;
  Eigen::MatrixXd forward_, backward_;  ///< scattering from stream to stream, per unit of depth
  double sigma_s_, limit_scale_ = 1, first_depth_;
};

}  // namespace translucube::slab

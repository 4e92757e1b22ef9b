#pragma once

// Smooth faces in closed form, which are left out of walks: light that meets no scatterer, and the
// way to the first one.

namespace translucube::slab {

/// Light that crosses a slab with smooth faces straight on, back and forth between them.
struct DirectLight {
  double reflected = 0, transmitted = 0;
};

/// The light of an incident direction with the cosine `mu` > 0, outside. `extinction`: (sigma_s +
/// sigma_a) times the thickness, may be infinite.
DirectLight direct_light(double ior, double extinction, double mu);

/// The light of Lambertian incidence: the mean of direct_light over 2 mu dmu, to 1e-10.
DirectLight direct_light_diffuse(double ior, double extinction);

/// Where light that falls on a smooth face meets its first scatterer, whichever of the faces it met
/// before that.
struct FirstScatterer {
  double weight = 0;     ///< share of the incident light that meets one
  double z = 0, mu = 0;  ///< its depth, and the direction in which light arrives there
  double length = 0;     ///< travelled inside until there
};

/// One of them, chosen by `u` in [0, 1]; sigma_s in 1 / thickness.
FirstScatterer sample_first_scatterer(double ior, double sigma_s, double mu, double u);

}  // namespace translucube::slab

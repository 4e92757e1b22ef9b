#pragma once

namespace translucube {

/// Light that crosses a slab with smooth faces straight on, back and forth between them.
struct DirectLight {
  double reflected = 0, transmitted = 0;
};

/// For the cosine `mu` > 0 of the incident direction, outside. `extinction`: (sigma_s + sigma_a)
/// times the thickness, may be infinite.
DirectLight direct_light(double ior, double extinction, double mu);

/// For Lambertian incidence: the mean of direct_light over 2 mu dmu, to 1e-10.
DirectLight direct_light_diffuse(double ior, double extinction);

}  // namespace translucube

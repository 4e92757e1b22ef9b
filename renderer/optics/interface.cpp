#include "renderer/optics/interface.h"

namespace translucube {

AnyInterface make_interface(const Material& material) {
  // Without a step of the index there is no interface, however rough.
  if (material.coefficients.alpha < least_alpha || material.ior == 1)
    return SmoothInterface{material.ior};
  return RoughInterface{material.ior, Ggx{material.coefficients.alpha},
                        material.multiple_scattering};
}

}  // namespace translucube

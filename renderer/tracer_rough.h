#pragma once

// The rough boundary: from microfacet to microfacet.

#include "renderer/microsurface.h"
#include "renderer/tracer.h"

namespace translucube {

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::enter_rough(Path path) {
  if constexpr (dipole) enter_dipole(path);
  if (!cross_rough(path, Frame(path.n), interface_.ior, true)) return;
  if constexpr (dipole) {
    if (interior_.clear_share == 0) return;  // a threshold relative to nothing ends nothing
    path.weight *= interior_.clear_share;
  }
  if constexpr (lambertian) return_diffuse(path);
  if constexpr (open) inward(path);
}

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::leave_rough(Path& path) {
  if (!cross_rough(path, Frame(-path.n), 1 / interface_.ior, false)) path.weight = 0;
}

template <class Shape, class Interface, class Interior>
bool Tracer<Shape, Interface, Interior>::cross_rough(Path& path, const Frame& frame, double eta,
                                                     bool from_outside) {
  const Vec3 wo = frame.to_local(-path.d);
  if (wo.z <= 0) return false;
  const double arriving = path.weight;
  Rng& rng = path.sampler.rng();
  Vec3 inward;
  double inward_weight = 0;
  cross_microsurface(
      interface_, eta, wo, path.sampler,
      [&](const MicroVertex& vertex) {
        path.weight = arriving * vertex.weight();
        connect(path, frame, [&](Vec3 wi) {
          return (wi.z > 0) == from_outside ? vertex.evaluate(wi) : LobeValue{};
        });
      },
      [&](Vec3 wi, double share, double pdf) {
        const double weight = arriving * share;
        if ((wi.z > 0) == from_outside) {
          leave(path, frame.to_world(wi), weight, pdf);
        } else if (open || lambertian) {
          inward_weight += weight;
          if (rng.uniform() * inward_weight < weight) inward = wi;
        }
      });
  if (inward_weight <= 0) return false;
  path.weight = inward_weight;
  path.pdf = 0;
  path.d = frame.to_world(inward);
  return true;
}

}  // namespace translucube

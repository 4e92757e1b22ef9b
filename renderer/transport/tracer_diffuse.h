#pragma once

// Light that the body sends out in all directions: of the infinitely dense body, and of the paper's
// model.

#include "renderer/optics/lambertian.h"
#include "renderer/transport/dipole_exit.h"
#include "renderer/transport/tracer.h"

namespace translucube {

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::return_diffuse(Path& path) {
  path.length += shortest_length;  // it was inside
  const Frame frame(path.n);
  const InterfacedLambertian& base = diffuse_base(path);
  const auto emit = [&](Vec3 wi) { return base.emit(wi); };
  connect(path, frame, emit);
  const Vec3 wi = InterfacedLambertian::sample(path.sampler.next2());
  const LobeValue value = emit(wi);
  if (value.f_cos > 0)
    leave(path, frame.to_world(wi), path.weight * value.f_cos / value.pdf, value.pdf);
}

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::enter_dipole(Path& arriving) {
  const double all = interior_.here + interior_.elsewhere;
  if (all <= 0) return;
  Path path = arriving;
  const double cos_o = -dot(path.d, path.n), share_here = interior_.here / all;
  path.weight *= all;
  Sample2 u = path.sampler.next2();
  if (u.u < share_here) {
    if (interior_.absorbing)
      collector_.tint(path, interior_.colors,
                      [](const DipoleColor& color) { return color.total(); });
  } else {
    u.u = (u.u - share_here) / (1 - share_here);
    const DipoleExit from =
        sample_exit(shape_, interior_.radii, path.p, path.n, u, path.sampler.rng());
    path.weight *= from.weight / interior_.radii.mass();
    arriving.sampler = path.sampler;
    if (from.lost) collector_.give_up(path);
    if (path.weight <= 0) return;
    path.p = from.p;
    path.n = from.n;
    if (interior_.absorbing)
      collector_.tint(path, interior_.colors,
                      [&](const DipoleColor& color) { return color.at(from.r); });
  }
  collector_.note("dipole", path);
  path.weight *= interior_.base.transmittance(cos_o);
  return_diffuse(path);
  arriving.sampler = path.sampler;
}

}  // namespace translucube

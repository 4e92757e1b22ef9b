#pragma once

// What lies behind the body.

#include <numbers>

#include "renderer/optics/lambertian.h"
#include "renderer/transport/tracer.h"

namespace translucube {

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::meet_backdrop(const Path& path) {
  const Backdrop& backdrop = *scene_.backdrop;
  const Vec3 p = backdrop.meet(path.p, path.d);
  const float value = backdrop.value(p);
  if (backdrop.kind == BackdropKind::light_table)
    return collector_.collect(path, {value, value, value}, path.weight);
  Path reflected = path;
  reflected.p = p;
  reflected.n = {0, 0, 1};
  reflected.weight *= value;
  reflected.pdf = reflected.vertex.phase = 0;
  if (reflected.weight > 0) leave_print(reflected);
}

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::leave_print(Path path) {
  // Light that falls on the print straight from the environment is looked for; what comes by way of
  // the body is found by going there.
  collector_.note("print", path);
  const auto* environment = std::get_if<ImageEnvironment>(&scene_.environment);
  Hit hit;
  if (environment && scene_.next_event_estimation) {
    const EnvironmentSample light = environment->sample(path.sampler.next2());
    ++tile_.counters.connections;
    const double cosine = light.direction.z;
    if (cosine > 0 && light.value.pdf > 0 && !shape_.enter(path.p, light.direction, hit))
      collector_.collect(path, light.value.radiance,
                         path.weight * cosine / (std::numbers::pi * light.value.pdf));
  }
  path.d = InterfacedLambertian::sample(path.sampler.next2());
  if (shape_.enter(path.p, path.d, hit)) return go_back(path);
  if (!environment)
    collector_.collect(path, std::get<UniformEnvironment>(scene_.environment).radiance,
                       path.weight);
  else if (!scene_.next_event_estimation)
    collector_.collect(path, environment->value_from(path.d).radiance, path.weight);
}

}  // namespace translucube

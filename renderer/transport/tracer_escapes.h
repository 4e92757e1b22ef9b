#pragma once

// Where paths meet the environment.

#include "renderer/transport/tracer.h"

namespace translucube {

template <class Shape, class Interface, class Interior>
template <class Evaluate>
void Tracer<Shape, Interface, Interior>::connect(Path& path, const Frame& frame,
                                                 Evaluate&& evaluate) {
  const auto* environment = std::get_if<ImageEnvironment>(&scene_.environment);
  // The same from everywhere: nothing to look for.
  if (environment == nullptr || !scene_.next_event_estimation) return;
  const EnvironmentSample light = environment->sample(path.sampler.next2());
  ++tile_.counters.connections;
  const LobeValue value = evaluate(frame.to_local(light.direction));
  if (value.f_cos <= 0) return;
  Hit hit;
  if (!shape_.convex() && shape_.enter(path.p, light.direction, hit)) return;
  collector_.note("connect", path);
  collector_.collect(path, light.value.radiance,
                     path.weight * value.f_cos / (light.value.pdf + value.pdf));
}

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::escape(const Path& path) {
  collector_.note("escape", path);
  if (scene_.backdrop && path.d.z < 0) {
    meet_backdrop(path);
    // Nothing of the environment, but a connection may have taken its share of nothing.
    if (path.pdf == 0 || std::holds_alternative<UniformEnvironment>(scene_.environment)) return;
  }
  if (const auto* uniform = std::get_if<UniformEnvironment>(&scene_.environment))
    return collector_.collect(path, uniform->radiance, path.weight);
  if constexpr (connecting && smooth)
    if (path.pdf == Path::found_by_connecting)
      return collector_.collect_carried(
          path.pixel, path.length, path.tint,
          connector_.expected(path.n, path.walk) * static_cast<float>(path.weight));
  Escapes& escapes = escapes_[path.length > 0 ? 1 : 0];
  EnvironmentBatch& batch = escapes.batch;
  const std::size_t i = batch.size++;
  batch.x[i] = static_cast<float>(path.d.x);
  batch.y[i] = static_cast<float>(path.d.y);
  batch.z[i] = static_cast<float>(path.d.z);
  escapes.from[i] = {path.n, path.length, path.weight, path.pdf, path.walk, path.pixel, path.tint};
  if (batch.size == EnvironmentBatch::capacity) collect(escapes);
}

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::collect(Escapes& escapes) {
  EnvironmentBatch& batch = escapes.batch;
  if (batch.size == 0) return;
  batch.look_up(std::get<ImageEnvironment>(scene_.environment));
  for (std::size_t i = 0; i < batch.size; ++i) {
    const Escape& from = escapes.from[i];
    const EnvironmentValue& light = batch.value[i];
    Rgb radiance = light.radiance;
    if (from.pdf > 0 && scene_.next_event_estimation) {  // it was looked for as well
      const auto share = static_cast<float>(from.pdf / (from.pdf + light.pdf));
      if constexpr (connecting && smooth) {
        const Rgb expected = connector_.expected(from.n, from.walk) * Connector::far_share;
        radiance = expected + (radiance - expected) * share;
      } else {
        radiance = radiance * share;
      }
    }
    collector_.collect(from.pixel, from.length, from.tint,
                       radiance * static_cast<float>(from.weight));
  }
  batch.size = 0;
}

}  // namespace translucube

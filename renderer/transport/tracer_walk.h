#pragma once

// Flights inside the body: those in a sphere together, in SIMD, all others one after the other.

#include "renderer/transport/tracer.h"

namespace translucube {

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::walk() {
  if constexpr (connecting) {
    walk_together();
  } else if constexpr (open) {
    for (Path& path : walking_) {
      Hit hit;
      if (!cross_body(path, hit)) {
        collector_.give_up(path);
        continue;
      }
      arrive_inside(path, hit);
      leaving_.push_back(path);
    }
  }
  walking_.clear();
}

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::walk_together() {
  const WalkMedium medium = connector_.walk_medium();
  for (std::size_t first = 0; first < walking_.size(); first += SphereWalk::capacity) {
    const std::span<Path> paths(&walking_[first],
                                std::min(SphereWalk::capacity, walking_.size() - first));
    for (std::size_t i = 0; i < paths.size(); ++i) {
      Path& path = paths[i];
      sphere_walk_.push(static_cast<std::uint32_t>(i), path.p, depth2(path), path.d, path.colliding,
                        path.sampler.rng().bits());
    }
    while (sphere_walk_.under_way() > 0) {
      tile_.counters.flights += sphere_walk_.under_way();
      sphere_walk_.advance(medium);
      connector_.connect(sphere_walk_.vertices(), paths);
      arrive(sphere_walk_.arrivals(), paths);
    }
  }
}

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::arrive(const SphereWalk::Arrivals& arrivals,
                                                std::span<const Path> paths) {
  for (std::size_t i = 0; i < arrivals.size; ++i) {
    Path& path = leaving_.emplace_back(paths[arrivals.slot[i]]);
    path.p = path.n = {arrivals.n_x[i], arrivals.n_y[i], arrivals.n_z[i]};
    path.d = {arrivals.d_x[i], arrivals.d_y[i], arrivals.d_z[i]};
    path.length += arrivals.length[i];
    path.vertex = {{arrivals.from_x[i], arrivals.from_y[i], arrivals.from_z[i]},
                   arrivals.from_depth2[i],
                   arrivals.flight[i],
                   arrivals.phase[i]};
    path.colliding = false;
    collector_.note("boundary", path);
  }
}

template <class Shape, class Interface, class Interior>
bool Tracer<Shape, Interface, Interior>::cross_body(Path& path, Hit& hit) {
  if constexpr (scattering) {
    return walk_to_boundary(
        shape_, interior_.medium, path, path.sampler.rng(), hit,
        [&](auto&& place) { scatter(place, interior_.medium, path, path.sampler.rng()); });
  } else if constexpr (dense) {
    // In the half space below the point where it entered, to leave at that very point.
    const Frame frame(path.n);
    Particle below{{}, frame.to_local(path.d), path.length};
    walk_to_boundary(
        HalfSpace{}, interior_.medium, below, path.sampler.rng(), hit,
        [&](auto&& place) { scatter(place, interior_.medium, below, path.sampler.rng()); });
    path.d = frame.to_world(below.d);
    path.length = below.length;
    hit.p = path.p;
    hit.n = path.n;
    return true;
  } else {
    return shape_.exit(path.p, path.d, infinity, hit);
  }
}

template <class Shape, class Interface, class Interior>
template <class Place, class Collide>
bool Tracer<Shape, Interface, Interior>::walk_to_boundary(const Place& body, const Medium& medium,
                                                          Particle& particle, Rng& rng, Hit& hit,
                                                          Collide&& collide) {
  auto&& place = surroundings(body, medium);
  ++tile_.counters.flights;
  while (fly(place, medium, particle, rng, hit)) {
    ++tile_.counters.flights;
    if (strayed(particle)) return false;
    collide(place);
  }
  return true;
}

}  // namespace translucube

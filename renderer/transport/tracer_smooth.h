#pragma once

// The smooth boundary: both branches are followed, light that nothing deflects is enumerated.

#include "renderer/transport/tracer.h"

namespace translucube {

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::enter_smooth(Path path) {
  const Vec3 wo = -path.d;
  const double reflectance = fresnel(dot(wo, path.n), interface_.ior);
  if constexpr (dipole) enter_dipole(path);
  if (reflectance > 0) leave(path, reflect(wo, path.n), path.weight * reflectance, 0);
  if constexpr (lambertian) {
    path.weight *= 1 - reflectance;
    return_diffuse(path);
  }
  if constexpr (open) {
    if (reflectance == 1) return;
    path.d = *refract(wo, path.n, interface_.ior);
    path.weight *= 1 - reflectance;
    if constexpr (dipole) path.weight *= interior_.clear_share;
    path.pdf = 0;
    inward(path);
  }
}

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::follow_unscattered(Path path) {
  Path scattered;
  double scattered_weight = 0;
  Rng& rng = path.sampler.rng();
  while (true) {
    Hit hit;
    if (!shape_.exit(path.p, path.d, infinity, hit)) {
      collector_.give_up(path);
      break;
    }
    if constexpr (scattering) {
      const double sigma_s = interior_.medium.sigma_s;
      const double deflected = -std::expm1(-sigma_s * hit.t);
      const double weight = path.weight * deflected;
      scattered_weight += weight;
      ++tile_.counters.flights;
      if (rng.uniform() * scattered_weight < weight) {
        const double s = -std::log1p(-rng.uniform() * deflected) / sigma_s;
        scattered = path;
        scattered.p = path.p + std::fmin(s, hit.t) * path.d;
        scattered.length += std::fmin(s, hit.t);
      }
      path.weight *= std::exp(-sigma_s * hit.t);
      if (!path.survives()) break;
    }
    arrive_inside(path, hit);
    if (!count_event(path)) break;
    if (traps(path)) {
      scattered_weight += path.weight;
      if (rng.uniform() * scattered_weight < path.weight) {
        scattered = path;
        roll(scattered);
      }
      break;
    }
    leave_smooth(path);
    if (!path.survives()) break;
  }
  if constexpr (scattering) {
    if (scattered_weight <= 0) return;
    const int walks = interior_.medium.sigma_s < short_walk_sigma_s ? 2 : 1;
    scattered.weight = scattered_weight / walks;
    for (int i = 0; i < walks; ++i) {
      Path walk = scattered;
      // Its own numbers from here on: those that it was copied with have decided over `path` since.
      walk.sampler = path.sampler.split();
      if (!walk.survives()) continue;
      walk.roulette = roulette_of_scattered * walk.weight;
      collector_.note("scatter", walk);
      connector_.start(walk);
      collide(walk);
      walking_.push_back(walk);
    }
  }
}

template <class Shape, class Interface, class Interior>
bool Tracer<Shape, Interface, Interior>::traps(const Path& path) const {
  if constexpr (smooth && scattering && std::is_same_v<Shape, Sphere>)
    return fresnel(dot(path.d, path.n), 1 / interface_.ior) == 1;
  return false;
}

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::roll(Path& path) {
  if constexpr (scattering && std::is_same_v<Shape, Sphere>) {
    const double flight = interior_.medium.sample_flight(path.sampler.rng());
    path.d = reflect(-path.d, path.n);
    Sphere::roll(path.p, path.d, flight);
    path.length += flight;
    ++tile_.counters.flights;
  }
}

template <class Shape, class Interface, class Interior>
void Tracer<Shape, Interface, Interior>::leave_smooth(Path& path) {
  if (traps(path)) {
    roll(path);
    if constexpr (scattering) collide(path);
    return;
  }
  const double reflectance = fresnel(dot(path.d, path.n), 1 / interface_.ior);
  if (reflectance < 1) {
    const Vec3 out = *refract(-path.d, -path.n, 1 / interface_.ior);
    double pdf = 0;
    if constexpr (smooth) pdf = connector_.pdf(path);
    leave(path, out, path.weight * (1 - reflectance), pdf);
  }
  path.weight *= reflectance;
  path.d = reflect(-path.d, path.n);
}

}  // namespace translucube

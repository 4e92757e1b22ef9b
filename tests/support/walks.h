#pragma once

// What the tests of random walks share: comparing two of them, and the mean length that any must
// have.

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderer/optics/fresnel.h"
#include "renderer/optics/lambertian.h"
#include "renderer/transport/walk.h"

namespace translucube::test {

/// Largest distance between two empirical distributions (Kolmogorov, Smirnov), over its 0.1 %
/// level.
inline double ks_ratio(std::vector<double> a, std::vector<double> b) {
  // Light that crosses unscattered all has the same values, up to rounding.
  for (auto* values : {&a, &b})
    for (double& v : *values) v = std::round(v * 1e6);
  std::ranges::sort(a);
  std::ranges::sort(b);
  double largest = 0;
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    const double x = std::min(a[i], b[j]);
    while (i < a.size() && a[i] <= x) ++i;
    while (j < b.size() && b[j] <= x) ++j;
    largest = std::max(largest, std::fabs(double(i) / a.size() - double(j) / b.size()));
  }
  return largest / (1.95 * std::sqrt(1.0 / a.size() + 1.0 / b.size()));
}

/// Where diffuse light comes in, and how it goes on.
struct Entry {
  Vec3 p, n;
};
inline Entry enter_sphere(Rng&) { return {{0, 0, 1}, {0, 0, 1}}; }

/// Mean length inside a body for a ray of diffuse light, in units of 4 V / S n^2 (Blanco and
/// Fournier 2003, with the factor n^2 of the radiance inside): 1. Nearly all light turns back near
/// the surface and nearly all length is travelled deep inside, so particles are split as they go
/// down and played out as they come up (weight window).
struct MeanLength {
  double mean, standard_error, collisions;
};
template <class Shape, class Enter>
MeanLength mean_length(const Shape& shape, double chord, Enter&& enter, const Medium& medium,
                       double ior, int walks, std::uint64_t key) {
  double sum = 0, squares = 0, collisions = 0;
  struct Weighted : Particle {
    double weight = 1;
  };
  auto&& place = surroundings(shape, medium);
  for (int i = 0; i < walks; ++i) {
    Rng rng(hash_combine(key, i));
    const Entry entry = enter(rng);
    const Vec3 down = InterfacedLambertian::sample(rng.uniform2());
    // Diffuse light outside is diffuse inside, less what the surface keeps out.
    const double transmitted = 1 - fresnel(down.z, 1 / ior);
    std::vector<Weighted> stack{{{entry.p, Frame(entry.n).to_world(-down), 0}, transmitted}};
    double total = 0;
    while (!stack.empty()) {
      Weighted particle = stack.back();
      stack.pop_back();
      while (particle.weight > 0) {
        Hit hit;
        const double before = particle.length;
        if (!fly(place, medium, particle, rng, hit)) {
          total += particle.weight * hit.t;
          if (rng.uniform() >= fresnel(dot(particle.d, hit.n), 1 / ior)) break;
          particle.p = hit.p;
          particle.d = reflect(-particle.d, hit.n);
          continue;
        }
        scatter(place, medium, particle, rng);
        ++collisions;
        total += particle.weight * (particle.length - before);
        const double depth = place.clearance(particle.p) * medium.sigma_s * (1 - medium.g);
        const double wanted = std::min(1.0, 1 / std::max(depth, 1e-9));
        if (particle.weight > 2 * wanted) {
          particle.weight /= 2;
          stack.push_back(particle);
        } else if (particle.weight < wanted / 2) {
          if (rng.uniform() < 0.5) break;
          particle.weight *= 2;
        }
      }
    }
    total /= chord;
    sum += total;
    squares += total * total;
  }
  const double mean = sum / walks;
  return {mean, std::sqrt((squares / walks - mean * mean) / walks), collisions / walks};
}
}  // namespace translucube::test

#pragma once

// What the truths of docs/design.md section 6 are measured by: mean path lengths, slabs lit from one
// side, walks in a sphere.

#include <array>
#include <cstdint>
#include <limits>

#include "renderer/optics/fresnel.h"
#include "renderer/optics/lambertian.h"
#include "renderer/transport/walk.h"
#include "tests/support/scenes.h"

namespace translucube::test {

/// sigma_s of the cube's coordinate in 1 / radius of the service's default sphere (20 mm, d_ref 10
/// mm).
inline double sigma_s_of_cube(double s) {
  if (s == 1) return std::numeric_limits<double>::infinity();
  return 4.0 / 3 * s / (1 - s) * 2;
}

/// Share of the image that a unit sphere covers in look_from_afar(scene, 1, size).
inline constexpr double disc = std::numbers::pi / 4;

/// Mean over the disc of the sphere, `background` being the pixel beside it: parallel light over
/// the disc is diffuse light over the surface.
inline Measured over_the_disc(const Measured& image, double background) {
  return {(image.mean - (1 - disc) * background) / disc, image.standard_error / disc};
}

/// The length inside [radii] of parallel light on a shape that looks like a unit sphere.
inline Scene path_scene(AnyShape shape, const Material& m, std::uint64_t seed = 1, int size = 64) {
  Scene scene = body(std::move(shape), m, seed);
  scene.lanes = {length_lane()};
  look_from_afar(scene, 1.0, size);
  return scene;
}
/// Its mean for each ray that meets the shape.
inline Measured mean_path_of(AnyShape shape, const Material& m, std::uint32_t samples,
                             std::uint64_t seed = 1, int threads = 0, int size = 64) {
  const Scene scene = path_scene(std::move(shape), m, seed, size);
  return over_the_disc(image_mean(trace(scene, samples, threads)), 0);
}

/// A slab of thickness 1 seen along its normal, with light from this side or from the other.
inline Scene lit_slab_scene(const Material& m, float sigma_a, bool above, std::uint64_t seed = 1) {
  Scene scene = body(wide_plate(), m, seed);
  scene.environment = half_space_light(above);
  scene.lanes = {RgbLane{{sigma_a, sigma_a, sigma_a}}};
  look_from_afar(scene, 0.1, 64);
  return scene;
}
/// Its reflectance and transmittance at normal incidence.
struct LitSlab {
  Measured reflectance, transmittance;
};
inline LitSlab lit_slab(const Material& m, float sigma_a, std::uint32_t samples,
                        std::uint64_t seed = 1, int threads = 0) {
  const auto lit = [&](bool above) {
    return image_mean(
        trace(lit_slab_scene(m, sigma_a, above, hash_combine(seed, above)), samples, threads));
  };
  return {lit(true), lit(false)};
}

/// A walk of diffuse light in a unit sphere, apart from the transport: one particle at a time from
/// the north pole, which stands for every point of the surface.
struct ReferenceWalk {
  Medium medium;
  double ior = 1;
  double sigma_a = 0;
  enum class Steps {
    large,     ///< as the transport; absorption developed from the length
    analog,    ///< flight by flight; absorption developed from the length
    absorbing  ///< flight by flight in sigma_s + sigma_a, weighted by the albedo at each collision
  } steps = Steps::large;

  /// Mean share of the light that leaves the sphere again, reflection at the entrance included.
  Measured leaving(int walks, std::uint64_t key) const;

 private:
  struct Entered {
    Particle particle;
    double share;  ///< of the light, that is not reflected at the entrance
  };
  Entered enter(Rng& rng) const {
    const Vec3 wo = InterfacedLambertian::sample(rng.uniform2());
    const double share = 1 - fresnel(wo.z, ior);
    return {{{0, 0, 1}, *refract(wo, {0, 0, 1}, ior), 0}, share};
  }
  /// At the boundary: true if the particle leaves, else it is reflected.
  bool leaves(const Hit& hit, Particle& particle, Rng& rng) const {
    particle.length += hit.t;
    particle.p = hit.p;
    if (rng.uniform() >= fresnel(std::fabs(dot(hit.n, particle.d)), 1 / ior)) return true;
    particle.d = reflect(-particle.d, hit.n);
    return false;
  }
};

inline Measured estimate_of(double sum, double squares, int n) {
  const double mean = sum / n;
  return {mean, std::sqrt(std::fmax(0.0, squares / n - mean * mean) / n)};
}

inline Measured ReferenceWalk::leaving(int walks, std::uint64_t key) const {
  const bool absorbs = steps == Steps::absorbing;
  const Medium flights{medium.sigma_s + (absorbs ? sigma_a : 0), medium.g};
  const double albedo = medium.sigma_s / flights.sigma_s;
  double sum = 0, squares = 0;
  for (int i = 0; i < walks; ++i) {
    Rng rng(hash_combine(key, i));
    auto [particle, share] = enter(rng);
    double weight = 1;
    Hit hit;
    while (true) {
      if (!fly(Sphere{}, flights, particle, rng, hit)) {
        if (leaves(hit, particle, rng)) break;
        continue;
      }
      if (absorbs) weight *= albedo;
      if (steps == Steps::large)
        scatter(Sphere{}, medium, particle, rng);
      else
        particle.d = medium.scatter(particle.d, rng);
    }
    const double left =
        1 - share + share * (absorbs ? weight : std::exp(-sigma_a * particle.length));
    sum += left;
    squares += left * left;
  }
  return estimate_of(sum, squares, walks);
}

}  // namespace translucube::test

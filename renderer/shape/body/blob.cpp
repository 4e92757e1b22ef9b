#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "renderer/base/sampler.h"
#include "renderer/shape/body/body.h"
#include "renderer/shape/body/octants.h"

namespace translucube {
namespace {

/// A smooth random function of directions: plane waves of one length from all sides, of unit
/// variance.
class Waves {
 public:
  Waves(double length, std::uint64_t seed) : number_(2 * std::numbers::pi / length) {
    Rng rng(hash_combine(0x626c6f62, seed));
    for (Wave& wave : waves_) {
      const double z = 2 * rng.uniform() - 1, phi = 2 * std::numbers::pi * rng.uniform();
      const double r = std::sqrt(1 - z * z);
      wave = {{r * std::cos(phi), r * std::sin(phi), z}, 2 * std::numbers::pi * rng.uniform()};
    }
  }

  struct Value {
    double value;
    Vec3 gradient;
  };
  Value at(Vec3 p) const {
    Value sum{};
    for (const Wave& wave : waves_) {
      const double phase = number_ * dot(wave.direction, p) + wave.phase;
      sum.value += amplitude * std::cos(phase);
      sum.gradient = sum.gradient - amplitude * number_ * std::sin(phase) * wave.direction;
    }
    return sum;
  }

 private:
  static constexpr std::size_t count = 32;
  static constexpr double amplitude = 0.25;  // sqrt(2 / count)
  struct Wave {
    Vec3 direction;
    double phase = 0;
  };
  double number_;
  std::array<Wave, count> waves_;
};

}  // namespace

BodyMesh make_blob(double radius, double bump, double scale, std::uint64_t seed) {
  // Of a right angle, so many that curved triangles over a wave are a millionth off.
  const auto parts = static_cast<std::uint32_t>(std::ceil(std::fmax(32, 32 * (1 + bump) / scale)));
  BodyMesh body{Octants(parts).sphere(), radius};
  TriangleMesh& mesh = body.mesh;
  close_mesh(mesh);
  const Waves waves(scale, seed);
  mesh.normals.clear();
  for (Vec3& v : mesh.vertices) {
    const auto [value, gradient] = waves.at(v);
    const double squash = 1 / std::sqrt(1 + value * value), strength = 0.45 * bump;
    const double r = 1 + strength * value * squash;
    // Of the surface r(v) v over the sphere: v less the slope of r along the sphere.
    const Vec3 slope = strength * squash * squash * squash * gradient;
    mesh.normals.push_back(normalize(v - (slope - dot(slope, v) * v) * (1 / r)));
    v = radius * r * v;
  }
  mesh.corner_normals = mesh.triangles;
  return body;
}

}  // namespace translucube

// Walks inside meshes: what is known of the space around them, the large steps that follow from it
// against the analog walk, and the mean length of any walk.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/support/meshes.h"
#include "tests/support/walks.h"

namespace translucube::test {
namespace {

/// A point inside, at most this deep below the surface where the line through it meets that.
Vec3 point_inside(const Mesh& mesh, double depth, Rng& rng) {
  while (true) {
    const Vec3 d = sample_isotropic(rng);
    Hit hit;
    if (!mesh.intersect_outside(2.0 * sample_isotropic(rng), d, hit)) continue;
    const Vec3 p = hit.p - depth * rng.uniform() * hit.n;
    if (mesh.inside(p)) return p;
  }
}

TEST(MeshDistance, IsBoundedAsABoxKnowsItself) {
  const Vec3 size{1, 1.5, 2};
  const BuiltMesh built = build_mesh(box(size));
  Rng rng(1);
  for (const double depth : {1.0, 0.1, 1e-3})
    for (int i = 0; i < 2000; ++i) {
      const Vec3 p = point_inside(built.mesh, depth, rng);
      const auto to_face = [&](double s, double x) {
        return 0.5 * s / built.radius - std::fabs(x);
      };
      const double d = std::min({to_face(size.x, p.x), to_face(size.y, p.y), to_face(size.z, p.z)});
      // Embree holds the box's corners in single precision.
      constexpr double rounded = 1e-7;
      for (const DistanceBounds b :
           {built.mesh.distance_bounds(p), built.mesh.finer_distance_bounds(p),
            built.mesh.distance(p, 2)}) {
        EXPECT_LE(b.least, d + rounded);
        EXPECT_GE(b.most, d - rounded);
      }
      EXPECT_GE(built.mesh.distance(p, 2).least, 0.5 * d - rounded);
    }
}

TEST(MeshDistance, IsFreeInEveryDirection) {
  const Mesh mesh = build_mesh(knot(240, 24)).mesh;
  Rng rng(2);
  for (const double depth : {0.3, 0.01, 1e-4})
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = point_inside(mesh, depth, rng);
      const DistanceBounds bounds[] = {mesh.distance_bounds(p), mesh.finer_distance_bounds(p),
                                       mesh.distance(p, 2)};
      for (const DistanceBounds& b : bounds) {
        bool met = false;
        for (int j = 0; j < 300; ++j) {
          Hit hit;
          const Vec3 d = sample_isotropic(rng);
          EXPECT_FALSE(b.least > 0 && mesh.intersect_inside(p, d, b.least, hit)) << depth;
          met |= mesh.intersect_inside(p, d, 1.5 * b.most + 1e-6, hit);
        }
        EXPECT_TRUE(met) << depth << " " << b.most;  // a bound from above that is none
      }
    }
}

struct Exits {
  std::vector<double> x, z, mu, length;
};
template <class Place, class Scatter>
Exits leave(const Mesh& mesh, Place&& place, const Medium& medium, Scatter&& turn, int walks,
            std::uint64_t key) {
  Exits exits;
  for (int i = 0; i < walks; ++i) {
    Rng starts(hash_combine(1, i)), rng(hash_combine(key, i));
    Particle particle{point_inside(mesh, 0.3, starts), sample_isotropic(rng), 0};
    Hit hit;
    while (fly(place, medium, particle, rng, hit)) turn(place, particle, rng);
    exits.x.push_back(hit.p.x);
    exits.z.push_back(hit.p.z);
    exits.mu.push_back(dot(hit.n, particle.d));
    exits.length.push_back(particle.length + hit.t);
  }
  return exits;
}

TEST(LargeSteps, LeaveAKnotAsTheAnalogWalkDoes) {
  const Mesh mesh = build_mesh(knot(240, 24)).mesh;
  for (const double sigma_s : {5.0, 50.0, 150.0}) {
    const Medium medium{sigma_s, 0};
    constexpr int walks = 8000;
    const Exits analog = leave(
        mesh, mesh, medium, [](const Mesh&, Particle& p, Rng& rng) { p.d = sample_isotropic(rng); },
        walks, 2);
    const Exits large = leave(
        mesh, surroundings(mesh, medium), medium,
        [&](Clearing& place, Particle& p, Rng& rng) { scatter(place, medium, p, rng); }, walks, 3);
    EXPECT_LT(ks_ratio(analog.x, large.x), 1) << sigma_s;
    EXPECT_LT(ks_ratio(analog.z, large.z), 1) << sigma_s;
    EXPECT_LT(ks_ratio(analog.mu, large.mu), 1) << sigma_s;
    EXPECT_LT(ks_ratio(analog.length, large.length), 1) << sigma_s;
  }
}

/// Mean lengths of walks in a convex mesh, in units of 4 V / S n^2.
MeanLength mean_length(const TriangleMesh& mesh, const Medium& medium, double ior, int walks) {
  const BuiltMesh built = build_mesh(mesh);
  std::vector<double> areas{0};
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]];
    areas.push_back(areas.back() + length(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a)));
  }
  const auto enter = [&](Rng& rng) {
    const auto found = std::ranges::upper_bound(areas, areas.back() * rng.uniform());
    const Triangle& t = mesh.triangles[found - areas.begin() - 1];
    const Sample2 u = rng.uniform2();
    const double root = std::sqrt(u.u);
    const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
    const Vec3 p =
        (a + root * (1 - u.v) * (b - a) + root * u.v * (c - a) - built.center) * (1 / built.radius);
    const Vec3 n = normalize(cross(b - a, c - a));
    Hit hit;  // where single precision has that point
    EXPECT_TRUE(built.mesh.intersect_outside(p + 0.01 * n, -n, hit));
    return Entry{hit.p, hit.n};
  };
  const double chord = 4 * volume(mesh) / surface_area(mesh) / built.radius;
  return test::mean_length(built.mesh, chord, enter, medium, ior, walks, 5);
}

void expect_mean_length(double sigma_s, double ior, int walks, double largest_error) {
  for (const TriangleMesh& mesh : {box({1, 1.5, 2}), icosphere(4)}) {
    const MeanLength m = mean_length(mesh, {sigma_s, 0}, ior, walks);
    EXPECT_NEAR(m.mean, 1, 3.5 * m.standard_error)
        << mesh.triangles.size() << " triangles, sigma_s " << sigma_s << " ior " << ior;
    EXPECT_LT(m.standard_error, largest_error) << sigma_s << " " << ior;
  }
}

TEST(MeanPathLength, InMeshesIsThatOfTheirVolumeAndSurfaceAtAnyDensity) {
  expect_mean_length(1, 1.5, 160'000, 5e-3);
  expect_mean_length(1e2, 1.5, 40'000, 2.5e-2);
  expect_mean_length(1e4, 1.0, 40'000, 5e-2);
}

TEST(LongMeanPathLength, InDenseMeshesIsThatOfTheirVolumeAndSurfaceToOnePercent) {
  expect_mean_length(1e2, 1.5, 400'000, 1e-2);
  for (const double ior : {1.0, 1.5}) expect_mean_length(1e4, ior, 1'000'000, 1e-2);
}

}  // namespace
}  // namespace translucube::test

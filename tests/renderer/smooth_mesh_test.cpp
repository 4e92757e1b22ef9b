// Meshes whose triangles stand for curved surfaces: what is made of them is closed and comes to the
// surface that they were made from, in closed form.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "renderer/optics/medium.h"
#include "renderer/shape/smooth/normals.h"
#include "renderer/shape/smooth/patch.h"
#include "renderer/shape/smooth/refine.h"
#include "tests/support/meshes.h"

namespace translucube::test {
namespace {

using std::numbers::pi;

constexpr double sphere_volume = 4 * pi / 3, sphere_area = 4 * pi;

/// Its triangles, all of which close_mesh leaves as they are.
std::size_t closed_triangles(TriangleMesh mesh) {
  const std::size_t before = mesh.triangles.size();
  const double volume_before = volume(mesh);
  close_mesh(mesh);
  EXPECT_EQ(mesh.triangles.size(), before);
  EXPECT_EQ(volume(mesh), volume_before);
  return before;
}

double farthest_from_unit_sphere(const TriangleMesh& mesh) {
  double most = 0;
  for (const Vec3& v : mesh.vertices) most = std::max(most, std::fabs(length(v) - 1));
  return most;
}

TEST(SmoothMesh, OfAnIcosphereIsTheSphere) {
  // Of 320, 1280, ... triangles: how far the patches are from the sphere, in the fourth order.
  const double off[] = {1.3e-4, 8e-6, 5e-7, 3e-8, 2e-9};
  for (int levels = 2; levels <= 6; ++levels) {
    TriangleMesh mesh = icosphere_with_normals(levels);
    const Refinement done = refine(mesh);
    EXPECT_EQ(done.given, 20u << (2 * levels));
    EXPECT_EQ(done.made, closed_triangles(mesh));
    EXPECT_FALSE(done.limited);
    EXPECT_LT(farthest_from_unit_sphere(mesh), off[levels - 2]) << levels;
    // The chords take 1e-5 of the radius at most, hence 3e-5 and 2e-5 and what the patches are off.
    EXPECT_NEAR(volume(mesh) / sphere_volume, 1, 6e-5 + off[levels - 2]) << levels;
    EXPECT_NEAR(surface_area(mesh) / sphere_area, 1, 4e-5 + off[levels - 2]) << levels;
    EXPECT_TRUE(mesh.normals.empty() && mesh.corner_normals.empty());
  }
}

TEST(SmoothMesh, IsCloserToTheSphereByArcsThanByThirdsOfChords) {
  // The middle of an arc of 30 degrees.
  const Vec3 a{1, 0, 0}, b{std::cos(pi / 6), std::sin(pi / 6), 0};
  const Curve arc{{a, control_point(a, b, a, a), control_point(b, a, b, b), b}};
  const auto third = [](Vec3 p, Vec3 q) { return p + (q - p - dot(q - p, p) * p) * (1.0 / 3); };
  const Curve chord{{a, third(a, b), third(b, a), b}};
  EXPECT_LT(std::fabs(length(arc.at(0.5)) - 1), 1e-6);
  EXPECT_GT(std::fabs(length(chord.at(0.5)) - 1), 1e-3);
}

TEST(SmoothMesh, AveragesNormalsThatAreExactOnASphere) {
  TriangleMesh mesh = icosphere(2);
  for (Vec3& v : mesh.vertices) v = 7 * v + Vec3{1, 2, 3};
  average_normals(mesh);
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
    EXPECT_NEAR(length(mesh.normals[v] - (mesh.vertices[v] - Vec3{1, 2, 3}) * (1.0 / 7)), 0, 1e-12);
}

TEST(SmoothMesh, WithTheNormalsOfItsFacesStaysAsItIs) {
  TriangleMesh cube = box({1, 2, 3});
  cube.normals = {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}};
  for (std::uint32_t t = 0; t < 12; ++t) cube.corner_normals.push_back({t / 2, t / 2, t / 2});
  const TriangleMesh before = cube;
  EXPECT_FALSE(has_smooth_normals(cube));
  EXPECT_FALSE(make_smooth(cube, std::nullopt));
  EXPECT_EQ(cube.triangles, before.triangles);
  cube = before;
  const Refinement done = refine(cube);
  EXPECT_EQ(done.made, 12u);
  EXPECT_EQ(cube.vertices, before.vertices);
  EXPECT_EQ(cube.triangles, before.triangles);
}

TEST(SmoothMesh, KeepsItsCreases) {
  TriangleMesh cylinder = cylinder_with_normals(48);
  const Refinement done = refine(cylinder);
  EXPECT_EQ(done.made, closed_triangles(cylinder));
  EXPECT_NEAR(volume(cylinder) / (2 * pi), 1, 1e-4);
  EXPECT_NEAR(surface_area(cylinder) / (6 * pi), 1, 1e-4);
  std::size_t on_rims = 0;
  for (const Vec3& v : cylinder.vertices) {
    EXPECT_LE(std::fabs(v.y), 1 + 1e-12);
    const double r = std::hypot(v.x, v.z);
    if (std::fabs(v.y) < 1 - 1e-12) {
      EXPECT_NEAR(r, 1, 1e-5);
    }
    on_rims += std::fabs(r - 1) < 1e-6 && std::fabs(v.y) == 1;
  }
  EXPECT_GT(on_rims, 2u * 48 * 5);
}

TEST(SmoothMesh, IsTheSameWhicheverSideItsNormalsPointTo) {
  TriangleMesh out = icosphere_with_normals(1), in = out;
  for (Vec3& n : in.normals) n = -n;
  refine(out);
  refine(in);
  EXPECT_EQ(out.vertices, in.vertices);
  EXPECT_EQ(out.triangles, in.triangles);
}

TEST(SmoothMesh, IsMadeWhereTheFileOrTheRequestAsksForIt) {
  const auto made = [](TriangleMesh mesh, std::optional<bool> smooth) {
    const auto done = make_smooth(mesh, smooth);
    EXPECT_EQ(done.has_value(), mesh.triangles.size() > 320);
    EXPECT_TRUE(mesh.corner_normals.empty());
    return done.has_value();
  };
  const TriangleMesh plain = icosphere(2), with = icosphere_with_normals(2);
  EXPECT_FALSE(made(plain, std::nullopt));
  EXPECT_FALSE(made(plain, false));
  EXPECT_TRUE(made(plain, true));
  EXPECT_TRUE(made(with, std::nullopt));
  EXPECT_FALSE(made(with, false));
  EXPECT_TRUE(made(with, true));
}

TEST(SmoothMesh, OfHostileNormalsIsClosedAndFinite) {
  Rng rng(5);
  for (int i = 0; i < 20; ++i) {
    TriangleMesh mesh = i % 2 ? knot(30, 7) : icosphere(1);
    for (int n = 0; n < 50; ++n)
      mesh.normals.push_back(n % 10 == 0 ? Vec3{} : (n % 7 ? 1 : 1e-160) * sample_isotropic(rng));
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      Triangle corners;
      for (std::uint32_t& n : corners) n = rng.bits() % 5 ? rng.bits() % 50 : no_normal;
      mesh.corner_normals.push_back(corners);
    }
    const Refinement done = refine(mesh, {}, 100'000);
    EXPECT_LE(done.made, 100'000u);
    EXPECT_EQ(done.made, mesh.triangles.size());
    for (const Vec3& v : mesh.vertices) ASSERT_TRUE(std::isfinite(length(v)));
    // Each edge once in each direction.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
    for (const Triangle& t : mesh.triangles)
      for (int k = 0; k < 3; ++k) {
        ASSERT_LT(t[k], mesh.vertices.size());
        edges.emplace_back(t[k], t[(k + 1) % 3]);
      }
    std::ranges::sort(edges);
    EXPECT_EQ(std::ranges::adjacent_find(edges), edges.end());
    for (const auto& [a, b] : edges)
      ASSERT_TRUE(std::ranges::binary_search(edges, std::pair(b, a)));
  }
}

TEST(SmoothMesh, HasNoMoreTrianglesThanItMayAndTellsSo) {
  TriangleMesh mesh = icosphere_with_normals(2);
  const Refinement done = refine(mesh, {}, 5000);
  EXPECT_TRUE(done.limited);
  EXPECT_LE(done.made, 5000u);
  EXPECT_GT(done.made, 2000u);
  EXPECT_EQ(done.made, closed_triangles(mesh));
  EXPECT_GT(done.chord_error, Fineness{}.chord_error);
  EXPECT_NEAR(volume(mesh) / sphere_volume, 1, 6 * done.chord_error);
  // What has too many already stays.
  TriangleMesh many = icosphere_with_normals(3);
  EXPECT_EQ(refine(many, {}, 500).made, 1280u);
  EXPECT_EQ(many.triangles, icosphere(3).triangles);
}

TEST(SmoothMesh, KeepsItsCavities) {
  TriangleMesh shell = icosphere_with_normals(2);
  const TriangleMesh ball = icosphere(2);
  const auto first = static_cast<std::uint32_t>(shell.vertices.size());
  for (const Vec3& v : ball.vertices) {
    shell.vertices.push_back(0.5 * v);
    shell.normals.push_back(v);
  }
  for (const Triangle& t : ball.triangles) {
    shell.triangles.push_back({first + t[0], first + t[2], first + t[1]});
    shell.corner_normals.push_back(shell.triangles.back());
  }
  close_mesh(shell);
  ASSERT_TRUE(make_smooth(shell, std::nullopt));
  EXPECT_NEAR(volume(shell) / (sphere_volume * 7 / 8), 1, 4e-4);
}

TEST(SmoothMesh, WhosePartsMeetAsTheyCurveIsRefused) {
  // Two plates of two triangles each side, bent towards each other by their normals.
  TriangleMesh two;
  for (const double y : {-1.0, 1.0}) {
    const auto first = static_cast<std::uint32_t>(two.vertices.size());
    for (const Vec3& v : box({2, 1.8, 2}).vertices) two.vertices.push_back(v + Vec3{0, y, 0});
    for (const Triangle& t : box({2, 1.8, 2}).triangles) {
      Triangle shifted;
      for (int k = 0; k < 3; ++k) shifted[k] = first + t[k];
      two.triangles.push_back(shifted);
    }
  }
  close_mesh(two);
  EXPECT_THROW(make_smooth(two, true), MeshError);
}

}  // namespace
}  // namespace translucube::test

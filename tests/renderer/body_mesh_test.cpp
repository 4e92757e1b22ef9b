// Bodies of our own as meshes: closed, and of volumes and areas in closed form.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "renderer/shape/body/body.h"
#include "renderer/shape/body/even_out.h"
#include "renderer/shape/body/isosurface.h"
#include "renderer/shape/smooth/normals.h"
#include "renderer/shape/smooth/refine.h"
#include "renderer/shape/triangle_mesh.h"

namespace translucube::test {
namespace {

using std::numbers::pi;

void expect_closed(const TriangleMesh& mesh) {
  TriangleMesh closed = mesh;
  close_mesh(closed);
  EXPECT_EQ(closed.triangles.size(), mesh.triangles.size());
  EXPECT_NEAR(volume(closed) / volume(mesh), 1, 1e-12);
}

/// Every edge has two triangles, that run along it in opposite directions.
void expect_watertight(const TriangleMesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const Triangle& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, count] : edges) {
    ASSERT_EQ(count, 1);
    ASSERT_TRUE(edges.contains({edge.second, edge.first}));
  }
}

TEST(BodyMesh, OfATorusHasItsVolumeAndArea) {
  for (const auto& [major, minor] :
       {std::pair(14.0, 6.0), {10.0, 9.999}, {5.0, 1.0}, {100.0, 1.0}, {1e-5, 1e-8}}) {
    const TriangleMesh mesh = refined(make_torus(major, minor));
    expect_closed(mesh);
    EXPECT_NEAR(volume(mesh) / (2 * pi * pi * major * minor * minor), 1, 1e-3) << minor;
    EXPECT_NEAR(surface_area(mesh) / (4 * pi * pi * major * minor), 1, 1e-3) << minor;
  }
}

TEST(BodyMesh, OfARoundedBoxHasItsVolumeAndArea) {
  struct Case {
    Vec3 extents;
    double edge;
  };
  for (const auto& [e, r] : {Case{{28, 28, 28}, 4},
                             {{28, 28, 28}, 14},
                             {{28, 20, 10}, 5},
                             {{30, 10, 10}, 5},
                             {{28, 20, 10}, 1e-3},
                             {{100, 1, 80}, 0.5}}) {
    const TriangleMesh mesh = refined(make_rounded_box(e, r));
    expect_closed(mesh);
    const double x = e.x - 2 * r, y = e.y - 2 * r, z = e.z - 2 * r;
    // Steiner's formula.
    const double faces = x * y + y * z + z * x, edges = x + y + z;
    EXPECT_NEAR(
        volume(mesh) / (x * y * z + 2 * r * faces + pi * r * r * edges + 4 * pi / 3 * r * r * r), 1,
        1.5e-4)
        << r;
    EXPECT_NEAR(surface_area(mesh) / (2 * faces + 2 * pi * r * edges + 4 * pi * r * r), 1, 1e-4)
        << r;
    for (const Vec3& v : mesh.vertices) {
      EXPECT_LE(std::fabs(v.x), e.x / 2 * (1 + 1e-12));
      EXPECT_LE(std::fabs(v.y), e.y / 2 * (1 + 1e-12));
      EXPECT_LE(std::fabs(v.z), e.z / 2 * (1 + 1e-12));
    }
  }
}

TEST(BodyMesh, OfAReliefHasTheSameVolumeHoweverSharp) {
  for (const double share : {0.1, 0.5, 0.95})
    for (const std::uint32_t ridges : {1u, 5u, 64u})
      for (const double sharpness : {0.0, 1e-9, 0.3, 0.9, 0.999, 0.99995, 1.0}) {
        const TriangleMesh mesh = refined(make_relief({40, 30, 8}, sharpness, share, ridges));
        expect_closed(mesh);
        EXPECT_NEAR(volume(mesh) / (40 * 30 * (8 - 4 * share)), 1, 1e-6)
            << sharpness << " " << ridges;
        Vec3 low, high;
        for (const Vec3& v : mesh.vertices) {
          low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
          high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
        }
        EXPECT_NEAR(length(high - Vec3{20, 15, 4}), 0, 1e-9) << sharpness;
        EXPECT_NEAR(length(low + Vec3{20, 15, 4}), 0, 1e-9) << sharpness;
      }
}

TEST(BodyMesh, OfASquareReliefIsMadeOfBoxes) {
  // Three ridges as high as half of the depth: the front, six walls, and the rest of a box.
  const TriangleMesh mesh = refined(make_relief({60, 30, 8}, 1, 0.5, 3));
  EXPECT_NEAR(surface_area(mesh), 2 * 60 * 30 + 6 * 30 * 4 + 2 * 30 * 4 + 2 * 60 * 6, 1e-9);
}

TEST(BodyMesh, OfASineReliefHasItsLength) {
  // The length of a sine of amplitude 2 and period 8 over five periods, by Simpson's rule.
  double length = 0;
  constexpr int steps = 2000;
  for (int i = 0; i <= steps; ++i) {
    const double slope = 2 * (2 * pi / 8) * std::cos(2 * pi * i / steps);
    length += (i == 0 || i == steps ? 1 : i % 2 ? 4 : 2) * std::hypot(1, slope);
  }
  length *= 5 * 8.0 / (3 * steps);
  const TriangleMesh mesh = refined(make_relief({40, 30, 8}, 0, 0.5, 5));
  EXPECT_NEAR(surface_area(mesh), 30 * length + 40 * 30 + 2 * 30 * 4 + 2 * 40 * 6, 0.1);
}

TEST(BodyMesh, OfABlobWithoutBumpsIsTheSphere) {
  const TriangleMesh mesh = refined(make_blob(20, 0, 1, 3));
  expect_closed(mesh);
  EXPECT_NEAR(volume(mesh) / (4 * pi / 3 * 8000), 1, 1.5e-4);
  EXPECT_NEAR(surface_area(mesh) / (4 * pi * 400), 1, 1e-4);
}

TEST(BodyMesh, OfABlobIsClosedWhateverItsBumps) {
  for (const double bump : {0.3, 1.0})
    for (const double scale : {0.5, 1.0, 4.0}) {
      const BodyMesh body = make_blob(20, bump, scale, 11);
      expect_closed(refined(body));
      // Its normals are those of its surface.
      double off = 0;
      for (std::size_t t = 0; t < body.mesh.triangles.size(); ++t) {
        const Vec3 a = body.mesh.vertices[body.mesh.triangles[t][0]];
        const Vec3 own = normalize(cross(body.mesh.vertices[body.mesh.triangles[t][1]] - a,
                                         body.mesh.vertices[body.mesh.triangles[t][2]] - a));
        for (const Vec3& n : corner_normals(body.mesh, t)) off += 1 - dot(n, own);
      }
      EXPECT_LT(off / double(3 * body.mesh.triangles.size()), 0.01) << bump << " " << scale;
      for (const Vec3& v : body.mesh.vertices) {
        EXPECT_LE(length(v), 20 * (1 + 0.45 * bump));
        EXPECT_GE(length(v), 20 * (1 - 0.45 * bump));
      }
    }
}

TEST(BodyMesh, OfOneSeedIsTheSameAndOfAnotherIsNot) {
  const BodyMesh one = make_blob(20, 0.3, 1, 1), same = make_blob(20, 0.3, 1, 1),
                 other = make_blob(20, 0.3, 1, 2);
  EXPECT_EQ(one.mesh.vertices, same.mesh.vertices);
  EXPECT_EQ(one.mesh.triangles, same.mesh.triangles);
  double apart = 0;
  for (std::size_t i = 0; i < one.mesh.vertices.size(); ++i)
    apart = std::max(apart, length(one.mesh.vertices[i] - other.mesh.vertices[i]));
  EXPECT_GT(apart, 2);
}

TEST(BodyMesh, OfADragonIsClosedAndOnePiece) {
  const BodyMesh body = make_dragon(44);
  expect_closed(body.mesh);
  // Its curved patches fold by less than a thousandth of their size here and there: whether they
  // cross is not asked.
  expect_watertight(refined(body));
  double low = 0, high = 0;
  for (const Vec3& v : body.mesh.vertices) low = std::min(low, v.x), high = std::max(high, v.x);
  EXPECT_NEAR(high - low, 44, 1e-9);
  // From triangle to triangle over their corners everything is reached.
  std::vector<std::uint32_t> root(body.mesh.vertices.size());
  for (std::uint32_t i = 0; i < root.size(); ++i) root[i] = i;
  const auto find = [&](std::uint32_t i) {
    while (root[i] != i) i = root[i] = root[root[i]];
    return i;
  };
  for (const Triangle& t : body.mesh.triangles)
    for (const std::uint32_t v : t) root[find(v)] = find(t[0]);
  const std::uint32_t first = find(body.mesh.triangles[0][0]);
  for (const Triangle& t : body.mesh.triangles) ASSERT_EQ(find(t[0]), first);
  // Another length, the same dragon.
  EXPECT_NEAR(volume(make_dragon(88).mesh) / volume(body.mesh), 8, 1e-9);
}

TEST(Isosurface, OfABallIsTheBall) {
  DistanceField field;
  field.add(RoundCone{{0.1, 0, 0}, {0.1, 0, 0}, 1, 1}, 0.1);
  TriangleMesh mesh = isosurface(field, {-1.5, -1.5, -1.5}, 0.1, {30, 30, 30});
  expect_closed(mesh);
  refine(mesh);
  expect_closed(mesh);
  EXPECT_NEAR(volume(mesh) / (4 * pi / 3), 1, 2e-4);
  EXPECT_NEAR(surface_area(mesh) / (4 * pi), 1, 2e-4);
}

TEST(Isosurface, OfARoundConeAndAPlateHasTheirVolume) {
  // Ball, frustum and ball; the hull of two balls in closed form.
  const double a = 0.5, b = 0.2, d = 1;
  DistanceField cone;
  cone.add(RoundCone{{0, 0, 0}, {0, d, 0}, a, b}, 0.1);
  TriangleMesh mesh = isosurface(cone, {-0.7, -0.7, -0.7}, 0.05, {28, 40, 28});
  refine(mesh);
  expect_closed(mesh);
  const double sine = (a - b) / d, cosine = std::sqrt(1 - sine * sine);
  const auto cap = [](double r, double h) { return pi * h * h * (3 * r - h) / 3; };
  const double ra = a * cosine, rb = b * cosine, h = d + b * sine - a * sine;
  const double frustum = pi * h / 3 * (ra * ra + ra * rb + rb * rb);
  EXPECT_NEAR(volume(mesh) / (cap(a, a + a * sine) + frustum + cap(b, b - b * sine)), 1, 1e-3);

  DistanceField plate;
  plate.add(RoundPlate{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0.2, 0.2, 0.2}, 0.1);
  mesh = isosurface(plate, {-0.4, -0.4, -0.4}, 0.05, {36, 36, 16});
  refine(mesh);
  expect_closed(mesh);
  // Steiner's formula for a flat triangle of area 1/2.
  const double r = 0.2;
  EXPECT_NEAR(
      volume(mesh) / (2 * r * 0.5 + pi / 2 * r * r * (2 + std::sqrt(2.0)) + 4 * pi / 3 * r * r * r),
      1, 1e-3);
}

TEST(Isosurface, WithoutItsShortEdgesIsTheSameBodyOfFewerTriangles) {
  DistanceField field;
  field.add(RoundCone{{0, 0, 0}, {0, 1, 0}, 0.5, 0.2}, 0.1);
  const TriangleMesh whole = isosurface(field, {-0.7, -0.7, -0.7}, 0.05, {28, 40, 28});
  TriangleMesh fewer = whole;
  even_out(fewer, 0.045);
  expect_closed(fewer);
  EXPECT_LT(fewer.triangles.size(), whole.triangles.size() / 2);
  EXPECT_EQ(fewer.vertices, whole.vertices);
  EXPECT_EQ(fewer.corner_normals, fewer.triangles);
  double all = 0, of_splinters = 0;
  for (const Triangle& t : fewer.triangles) {
    const Vec3 a = fewer.vertices[t[0]], b = fewer.vertices[t[1]], c = fewer.vertices[t[2]];
    const double area = length(cross(b - a, c - a));
    const bool splinter = area < 0.15 * std::max({length_squared(b - a), length_squared(c - b),
                                                  length_squared(a - c)});
    all += area;
    of_splinters += splinter ? area : 0;
  }
  EXPECT_LT(of_splinters / all, 0.01);
  TriangleMesh smooth = whole;
  refine(smooth);
  refine(fewer);
  expect_closed(fewer);
  EXPECT_NEAR(volume(fewer) / volume(smooth), 1, 1e-3);
  EXPECT_NEAR(surface_area(fewer) / surface_area(smooth), 1, 1e-3);
}

TEST(Isosurface, OfTwoThatAreFarApartIsBoth) {
  DistanceField field;
  field.add(RoundCone{{-1, 0, 0}, {-1, 0, 0}, 0.5, 0.5}, 0.2);
  field.add(RoundCone{{1, 0, 0}, {1, 0, 0}, 0.5, 0.5}, 0.2);
  TriangleMesh mesh = isosurface(field, {-1.8, -0.8, -0.8}, 0.05, {72, 32, 32});
  refine(mesh);
  expect_closed(mesh);
  EXPECT_NEAR(volume(mesh) / (2 * 4 * pi / 3 / 8), 1, 5e-4);
}

}  // namespace
}  // namespace translucube::test

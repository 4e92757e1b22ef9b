// Surfaces that meet themselves are found, wherever it is; those that do not are not.

#include "renderer/shape/mesh_collision.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <ctime>

#include "renderer/shape/triangle_pair.h"
#include "tests/support/meshes.h"
#include "tests/support/sanitized.h"

namespace translucube::test {
namespace {

using testing::HasSubstr;

std::string refusal(TriangleMesh mesh) {
  try {
    close_mesh(mesh);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "taken";
}

/// Corners of the outline, below and above; walls between; caps as a fan from a point of their own.
TriangleMesh prism(const std::vector<Vec3>& outline, Vec3 middle) {
  TriangleMesh mesh;
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (const double z : {0., 1.})
    for (const Vec3& p : outline) mesh.vertices.push_back({p.x, p.y, z});
  for (const double z : {0., 1.}) mesh.vertices.push_back({middle.x, middle.y, z + middle.z});
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    for (const Triangle& t :
         {Triangle{i, j, n + j}, {i, n + j, n + i}, {j, i, 2 * n}, {n + i, n + j, 2 * n + 1}})
      mesh.triangles.push_back(t);
  }
  return mesh;
}

/// Points around a circle, or around an 8 whose loops cross in its middle.
std::vector<Vec3> around(int count, bool eight = false) {
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double t = 2 * std::numbers::pi * (i + .5) / count;
    points.push_back({std::cos(t), eight ? std::sin(2 * t) : std::sin(t), 0});
  }
  return points;
}

TEST(TrianglePairs, CrossByMoreThanRounding) {
  const Corners flat{Vec3{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const struct {
    const char* name;
    Corners other;
    bool touch, cross;
  } cases[] = {
      {"through it", {Vec3{.2, .2, -1}, {.3, .2, 1}, {.2, .3, 1}}, true, true},
      {"above", {Vec3{.2, .2, .1}, {.3, .2, 1}, {.2, .3, 1}}, false, false},
      {"beside, in its plane", {Vec3{1, 1, 0}, {2, 1, 0}, {1, 2, 0}}, false, false},
      {"upon it, in its plane", {Vec3{.2, .2, 0}, {.3, .2, 0}, {.2, .3, 0}}, true, false},
      {"a common corner", {Vec3{0, 0, 0}, {-1, 0, 1}, {0, -1, 1}}, true, false},
      {"a common side", {Vec3{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, true, false},
      {"a common side, folded", {Vec3{0, 0, 0}, {1, 0, 0}, {.5, .2, 1e-3}}, true, false},
      {"a common corner, through it", {Vec3{0, 0, 0}, {.5, .5, .5}, {.5, .5, -.5}}, true, true},
      {"a corner on it", {Vec3{.2, .2, 0}, {.2, .2, 1}, {.3, .2, 1}}, true, false},
      {"no area, above", {Vec3{0, 0, .1}, {1, 0, .1}, {2, 0, .1}}, false, false},
      {"no area, beside", {Vec3{0, -.1, 0}, {1, -.1, 0}, {2, -.1, 0}}, false, false}};
  for (const auto& c : cases)
    for (const double scale : {1e-6, 1., 1e9}) {
      Corners a = flat, b = c.other;
      for (Vec3* p : {&a[0], &a[1], &a[2], &b[0], &b[1], &b[2]}) *p = scale * *p;
      for (const TrianglePair& pair : {TrianglePair(a, b), TrianglePair(b, a)}) {
        EXPECT_EQ(pair.touch(), c.touch) << c.name << ' ' << scale;
        EXPECT_EQ(pair.cross(), c.cross) << c.name << ' ' << scale;
      }
    }
}

TEST(MeshCollision, OfWallsThatCrossIsFound) {
  // Every edge of one wall meets an edge of the other.
  TriangleMesh bow = prism({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, {.5, .5, 0});
  bow.triangles.clear();
  for (const Triangle& t : {Triangle{0, 1, 5},
                            {0, 5, 4},
                            {1, 2, 6},
                            {1, 6, 5},
                            {2, 3, 7},
                            {2, 7, 6},
                            {3, 0, 4},
                            {3, 4, 7},
                            {0, 2, 1},
                            {0, 3, 2},
                            {4, 5, 6},
                            {4, 6, 7}})
    bow.triangles.push_back(t);
  EXPECT_THAT(refusal(bow), HasSubstr("the surface of the mesh crosses itself near 0.5 0.5"));
}

TEST(MeshCollision, OfAVertexPushedThroughTheOtherSideIsFound) {
  for (const int levels : {1, 3, 5}) {
    TriangleMesh ball = icosphere(levels);
    EXPECT_EQ(refusal(ball), "taken");
    ball.vertices[7] = -1.1 * ball.vertices[7];
    EXPECT_THAT(refusal(ball), HasSubstr("crosses itself near")) << levels;
  }
}

TEST(MeshCollision, OfATubeThatMeetsItselfIsFound) {
  TriangleMesh tube = knot(200, 24, 0.3);
  EXPECT_EQ(refusal(tube), "taken");
  EXPECT_THROW(knot(200, 24, 0.6), MeshError);
}

TEST(MeshCollision, OfAFanIsFoundAmongManyTriangles) {
  for (const int sides : {20, 400, 100'000}) {
    EXPECT_EQ(refusal(prism(around(sides), {})), "taken") << sides;
    EXPECT_EQ(refusal(prism(around(sides), {0, 0, .5})), "taken") << sides;
    // The walls cross, and so do triangles of one fan.
    EXPECT_THAT(refusal(prism(around(sides, true), {0, .1, .5})), HasSubstr("crosses itself"))
        << sides;
    // Two fans alone: a cone whose base is pulled out through its side.
    TriangleMesh cone;
    cone.vertices = around(sides);
    const auto n = static_cast<std::uint32_t>(sides);
    cone.vertices.push_back({0, 0, 1});
    cone.vertices.push_back({0, 0, .5});
    for (std::uint32_t i = 0; i < n; ++i) {
      cone.triangles.push_back({i, (i + 1) % n, n});
      cone.triangles.push_back({(i + 1) % n, i, n + 1});
    }
    EXPECT_EQ(refusal(cone), "taken") << sides;
    cone.vertices[n + 1] = {1.5, 0, 2};
    EXPECT_THAT(refusal(cone), HasSubstr("crosses itself")) << sides;
    // One fan alone: over an 8.
    cone.vertices.resize(n);
    const std::vector<Vec3> eight = around(sides, true);
    std::ranges::copy(eight, cone.vertices.begin());
    cone.vertices.push_back({0, .1, 1});
    cone.vertices.push_back({0, .1, -1});
    EXPECT_THAT(refusal(cone), HasSubstr("crosses itself")) << sides;
  }
}

TEST(MeshCollision, OfCornersWithinSidesIsNone) {
  // A box, one side of which is cut where its neighbours are not, with triangles without area
  // between.
  TriangleMesh mesh = box({1, 1, 1});
  const auto middle = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({0, 0.5, 0.5});
  // The quad 4 5 7 6 (z = .5) is cut at the middle of its side 7 6.
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    return std::ranges::all_of(t, [&](std::uint32_t v) { return mesh.vertices[v].z > 0; });
  });
  for (const Triangle& t : {Triangle{4, 5, middle}, {5, 7, middle}, {4, middle, 6}, {7, 6, middle}})
    mesh.triangles.push_back(t);
  EXPECT_EQ(refusal(mesh), "taken");
  // The same, turned, so that nothing is exact.
  for (Vec3& v : mesh.vertices) {
    const Frame frame(normalize(Vec3{1, 2, 3}));
    v = frame.to_world(v);
  }
  EXPECT_EQ(refusal(mesh), "taken");
}

/// A pyramid over both sides of a polygon.
TriangleMesh bipyramid(int sides, double top, double bottom) {
  TriangleMesh mesh;
  mesh.vertices = around(sides);
  const auto n = static_cast<std::uint32_t>(sides);
  mesh.vertices.push_back({0, 0, top});
  mesh.vertices.push_back({0, 0, bottom});
  for (std::uint32_t i = 0; i < n; ++i) {
    mesh.triangles.push_back({i, (i + 1) % n, n});
    mesh.triangles.push_back({(i + 1) % n, i, n + 1});
  }
  return mesh;
}

/// In CPU seconds for `most` triangles of each.
void expect_time_in_proportion(std::uint32_t most, int levels, double seconds_each) {
  if (sanitized) GTEST_SKIP() << "it is timed";
  TriangleMesh rod = prism(around(most / 10), {});
  const Frame tilted(normalize(Vec3{1, 1, 1}));
  for (Vec3& v : rod.vertices) v = tilted.to_world({v.x, v.y, 10 * v.z});
  const std::pair<const char*, TriangleMesh> meshes[] = {
      {"a ball", icosphere(levels)},
      {"a cone", bipyramid(most / 2, 1, 0)},
      {"two cones", bipyramid(most / 2, 1, -1)},
      {"a thin lens", bipyramid(most / 2, .5, .49)},
      {"a cylinder", prism(around(most / 4), {})},
      {"a tilted rod", rod}};
  for (auto [name, mesh] : meshes) {
    const std::clock_t start = std::clock();
    EXPECT_EQ(refusal(std::move(mesh)), "taken") << name;
    const double seconds = double(std::clock() - start) / CLOCKS_PER_SEC;  // of this process
    EXPECT_LT(seconds, seconds_each) << name;
    std::printf("%s: %.1f s\n", name, seconds);
  }
}

TEST(MeshCollision, TakesTimeInProportionWhateverTheTriangles) {
  expect_time_in_proportion(100'000, 6, 1.5);
}

TEST(LongMeshCollision, TakesTimeInProportionWhateverTheTriangles) {
  expect_time_in_proportion(1'000'000, 8, 15);
}

TEST(ClosedMesh, TellsWhatWasDone) {
  TriangleMesh mesh = box({2, 2, 2});
  mesh.vertices.push_back({100, 0, 0});       // of no triangle
  mesh.vertices.push_back(mesh.vertices[0]);  // once more
  for (std::uint32_t& v : mesh.triangles[0])
    if (v == 0) v = 9;
  mesh.triangles.push_back({0, 9, 5});
  TriangleMesh other = box({1, 1, 1});
  for (Vec3& v : other.vertices) {
    mesh.vertices.push_back(v + Vec3{5, 0, 0});
  }
  for (const Triangle& t : other.triangles)
    mesh.triangles.push_back({t[0] + 10, t[1] + 10, t[2] + 10});
  EXPECT_EQ(close_mesh(mesh), (MeshReport{16, 24, 1, 1, 2}));
  EXPECT_EQ(mesh.vertices.size(), 16u);
  EXPECT_NEAR(volume(mesh), 9, 1e-12);
}

}  // namespace
}  // namespace translucube::test

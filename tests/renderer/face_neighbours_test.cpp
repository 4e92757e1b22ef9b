#include "renderer/shape/face_neighbours.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "tests/support/meshes.h"

namespace translucube::test {
namespace {

TEST(FaceNeighbours, ShareAVertex) {
  const TriangleMesh mesh = icosphere(2);
  const FaceNeighbours neighbours(mesh);
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    std::vector<std::uint32_t> expected;
    for (std::uint32_t g = 0; g < mesh.triangles.size(); ++g)
      if (g != f && std::ranges::find_first_of(mesh.triangles[f], mesh.triangles[g]) !=
                        mesh.triangles[f].end())
        expected.push_back(g);
    EXPECT_THAT(neighbours.of(f), testing::ElementsAreArray(expected));
  }
}

TEST(FaceNeighbours, OfAVertexWhereAHundredThousandMeetAreFew) {
  TriangleMesh cone{{{0, 0, 1}, {0, 0, -1}}, {}};
  constexpr std::uint32_t around = 100'000;
  for (std::uint32_t i = 0; i < around; ++i) {
    const double phi = 2 * std::numbers::pi * i / around;
    cone.vertices.push_back({std::cos(phi), std::sin(phi), 0});
    const std::uint32_t a = 2 + i, b = 2 + (i + 1) % around;
    cone.triangles.push_back({0, a, b});
    cone.triangles.push_back({1, b, a});
  }
  const FaceNeighbours neighbours(cone);
  for (std::uint32_t f = 0; f < cone.triangles.size(); ++f)
    EXPECT_EQ(neighbours.of(f).size(), 5u);  // around the two vertices of the rim
}

}  // namespace
}  // namespace translucube::test

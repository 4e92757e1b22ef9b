#include "renderer/shape/mesh.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "renderer/shape/file/mesh_file.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

TEST(Mesh, OfABoxHasItsVolumeAndArea) {
  TriangleMesh mesh = box({1, 2, 3});
  close_mesh(mesh);
  EXPECT_NEAR(volume(mesh), 6, 1e-12);
  EXPECT_NEAR(surface_area(mesh), 22, 1e-12);
}

TEST(Mesh, TurnedInsideOutIsTurnedBack) {
  TriangleMesh mesh = box({1, 1, 1});
  for (Triangle& t : mesh.triangles) std::swap(t[0], t[1]);
  EXPECT_LT(volume(mesh), 0);
  close_mesh(mesh);
  EXPECT_GT(volume(mesh), 0);
}

TEST(Mesh, WithAHoleIsRefused) {
  TriangleMesh mesh = box({1, 1, 1});
  mesh.triangles.pop_back();
  EXPECT_THROW(close_mesh(mesh), MeshError);
}

TEST(Mesh, WithOneFaceTurnedIsRefused) {
  TriangleMesh mesh = box({1, 1, 1});
  std::swap(mesh.triangles[3][0], mesh.triangles[3][1]);
  EXPECT_THROW(close_mesh(mesh), MeshError);
}

TEST(Mesh, EmptyOrFlatIsRefused) {
  TriangleMesh empty;
  EXPECT_THROW(close_mesh(empty), MeshError);
  TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {2, 1, 0}}};
  EXPECT_THROW(close_mesh(flat), MeshError);
}

TEST(Mesh, IsKnownToBeConvex) {
  EXPECT_TRUE(is_convex(box({1, 2, 3})));
  EXPECT_TRUE(is_convex(icosphere(5)));
  EXPECT_FALSE(is_convex(knot(60, 12)));
}

TEST(Mesh, WithADentOrOfTwoPartsIsNotConvex) {
  TriangleMesh dented = icosphere(4);
  dented.vertices[100] = 0.99 * dented.vertices[100];
  EXPECT_FALSE(is_convex(dented));
  for (const double apart : {0.0, 3.0}) {
    TriangleMesh two = box({1, 1, 1});
    for (Triangle t : box({1, 1, 1}).triangles) {
      for (std::uint32_t& v : t) v += 8;
      two.triangles.push_back(t);
    }
    for (const Vec3& v : box({2, 2, 2}).vertices) two.vertices.push_back(v + Vec3{apart, 0, 0});
    EXPECT_FALSE(is_convex(two)) << apart;
  }
}

TEST(Mesh, FromObjAndPlyFilesIsTheSameBody) {
  const auto folder = std::filesystem::temp_directory_path() / "translucube_mesh_test";
  std::filesystem::create_directories(folder);
  const TriangleMesh mesh = icosphere(2);
  write_obj(mesh, folder / "ball.obj");
  write_ply(mesh, folder / "ball.ply");
  for (const char* name : {"ball.obj", "ball.ply"}) {
    const TriangleMesh read = read_mesh(folder / name).mesh;
    EXPECT_EQ(read.triangles.size(), mesh.triangles.size()) << name;
    EXPECT_NEAR(volume(read), volume(mesh), 1e-5) << name;
    EXPECT_NO_THROW(check_mesh({folder / name}));
  }
  std::ofstream(folder / "empty.obj") << "# nothing\n";
  EXPECT_THROW(check_mesh({folder / "empty.obj"}), SceneError);
  EXPECT_THROW(check_mesh({folder / "absent.ply"}), SceneError);
  EXPECT_THROW(check_mesh({"/etc/passwd"}), SceneError);
  std::filesystem::remove_all(folder);
}

TEST(MeshRays, LeaveAndEnterOnceEach) {
  const BuiltMesh built = build_mesh(box({2, 2, 2}));
  const double half = 1 / std::sqrt(3.0);  // in units of the bounding sphere
  Hit hit;
  ASSERT_TRUE(built.mesh.intersect_outside({0.1, 0.2, 5}, {0, 0, -1}, hit));
  EXPECT_NEAR(hit.t, 5 - half, 1e-6);
  EXPECT_NEAR(hit.n.z, 1, 1e-9);
  ASSERT_TRUE(built.mesh.intersect_inside(hit.p, {0, 0, -1}, 1e30, hit));
  EXPECT_NEAR(hit.t, 2 * half, 1e-6);
  EXPECT_NEAR(hit.n.z, -1, 1e-9);
  EXPECT_FALSE(built.mesh.intersect_outside(hit.p, {0, 0, -1}, hit));
  EXPECT_FALSE(built.mesh.intersect_inside({0, 0, 0}, {0, 0, -1}, 0.5 * half, hit));
  EXPECT_TRUE(built.mesh.inside({0.9 * half, -0.9 * half, 0}));
  EXPECT_FALSE(built.mesh.inside({1.1 * half, 0, 0}));
}

}  // namespace
}  // namespace translucube::test

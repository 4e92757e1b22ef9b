// Bodies of triangles: the white furnace, and the sphere that they come close to.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

Scene mesh_body(const TriangleMesh& mesh, const Material& m) {
  return body(build_mesh(mesh).mesh, m);
}

TEST(MeanPathLength, OfABallOfTrianglesIsThatOfTheSphere) {
  Scene scene = mesh_body(icosphere(5), material(1.5, 0, 2));
  scene.lanes = {length_lane()};
  look_from_afar(scene, 1.0, 48);
  const Measured e = image_mean(trace(scene, 256));
  EXPECT_NEAR(e.mean / (std::numbers::pi / 4) / 3, 1, 6e-3) << e.standard_error;
}

TEST(Ball, OfManyTrianglesLooksLikeTheSphere) {
  const Material m = material(1.5, 0, 4);
  Scene sphere = body(Sphere{}, m), ball = mesh_body(icosphere(6), m);
  for (Scene* scene : {&sphere, &ball}) {
    scene->environment = half_space_light(true);
    look_from_afar(*scene, 1.1, 32);
  }
  const Measured a = image_mean(trace(sphere, 256)), b = image_mean(trace(ball, 192));
  const double error = std::hypot(a.standard_error, b.standard_error);
  EXPECT_NEAR(a.mean, b.mean, 4 * error + 1e-4);
  EXPECT_LT(error / a.mean, 3e-3);
}

}  // namespace
}  // namespace translucube::test

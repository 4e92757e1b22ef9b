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

TEST(WhiteFurnace, ABoxVanishesAndLosesNoLight) {
  // Total internal reflection traps light in a box; its corners and edges are where rays get lost.
  for (const double sigma_s : {0.0, 0.3, 5.0}) {
    Scene scene = mesh_body(box({1, 1.5, 2}), material(1.5, 0, sigma_s));
    scene.camera = Camera({1.5, 1.1, 2.5}, {0, 0, 0}, {0, 1, 0}, 40, 32, 32);
    scene.width = scene.height = 32;
    const Film film = trace(scene, 256);
    EXPECT_NEAR(image_mean(film).mean, 1, 1e-3)
        << sigma_s << " +- " << image_mean(film).standard_error;
    EXPECT_LT(film.counters.truncated_energy / double(film.counters.camera_samples), 1e-5)
        << sigma_s;
  }
}

TEST(WhiteFurnace, AKnotOfGlassVanishes) {
  // A body that is not convex: light leaves and enters again.
  Scene scene = mesh_body(knot(240, 24), material(1.5, 0, 1.0));
  scene.camera = Camera({0, 0, 3.5}, {0, 0, 0}, {0, 1, 0}, 36, 32, 32);
  scene.width = scene.height = 32;
  const Film film = trace(scene, 128);
  EXPECT_NEAR(image_mean(film).mean, 1, 1.5e-3) << image_mean(film).standard_error;
  EXPECT_LT(film.counters.truncated_energy / double(film.counters.camera_samples), 1e-5);
}

TEST(MeanPathLength, OfABallOfTrianglesIsThatOfTheSphere) {
  Scene scene = mesh_body(icosphere(5), material(1.5, 0, 2));
  scene.lanes = {length_lane()};
  look_from_afar(scene, 1.0, 48);
  const Estimate e = image_mean(trace(scene, 256));
  EXPECT_NEAR(e.mean / (std::numbers::pi / 4) / 3, 1, 6e-3) << e.standard_error;
}

TEST(Ball, OfManyTrianglesLooksLikeTheSphere) {
  const Material m = material(1.5, 0, 4);
  Scene sphere = body(Sphere{}, m), ball = mesh_body(icosphere(6), m);
  for (Scene* scene : {&sphere, &ball}) {
    scene->environment = half_space_light(true);
    look_from_afar(*scene, 1.1, 32);
  }
  const Estimate a = image_mean(trace(sphere, 512)), b = image_mean(trace(ball, 512));
  const double error = std::hypot(a.standard_error, b.standard_error);
  EXPECT_NEAR(a.mean, b.mean, 4 * error + 1e-4);
  EXPECT_LT(error / a.mean, 2e-3);
}

}  // namespace
}  // namespace translucube::test

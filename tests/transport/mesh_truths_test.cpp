// Bodies of triangles: the white furnace, and the sphere that they come close to.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "renderer/shape/smooth/refine.h"
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

/// The sphere over which an icosphere with normals stands.
TriangleMesh smooth_ball(int levels) {
  TriangleMesh mesh = icosphere_with_normals(levels);
  refine(mesh);
  return mesh;
}

TEST(SmoothBall, OfFewTrianglesLooksLikeTheSphere) {
  for (const Material& m : {material(1.5, 0, 4), material(1.5, 0.2, 1)})
    for (const int levels : {2, 3}) {
      constexpr int size = 32;
      Scene sphere = body(Sphere{}, m), ball = mesh_body(smooth_ball(levels), m);
      for (Scene* scene : {&sphere, &ball}) {
        scene->environment = half_space_light(true);
        look_from_afar(*scene, 1.1, size);
        scene->seed = scene == &ball ? 2 : 1;
      }
      const Film a = trace(sphere, 128), b = trace(ball, 96);
      const Measured mean_a = image_mean(a), mean_b = image_mean(b);
      const double error = std::hypot(mean_a.standard_error, mean_b.standard_error);
      EXPECT_NEAR(mean_a.mean, mean_b.mean, 4 * error + 1e-4);
      EXPECT_LT(error / mean_a.mean, 6e-3);
      // Block by block, each of 4 x 4 pixels: the largest of 64 normal numbers is below 4.3 in 999
      // of 1000 cases.
      const Image picture_a = develop(a), picture_b = develop(b), spread_a = variance(a),
                  spread_b = variance(b);
      double worst = 0, chi2 = 0;
      int blocks = 0;
      for (int by = 0; by < size; by += 4)
        for (int bx = 0; bx < size; bx += 4) {
          double off = 0, spread = 0;
          for (int y = by; y < by + 4; ++y)
            for (int x = bx; x < bx + 4; ++x) {
              const std::size_t i = 3 * (std::size_t(y) * size + x);
              off += picture_a.pixels[i] - picture_b.pixels[i];
              spread += spread_a.pixels[i] + spread_b.pixels[i];
            }
          if (spread < 1e-9) continue;  // the background alone
          ++blocks;
          worst = std::max(worst, std::fabs(off) / std::sqrt(spread));
          chi2 += off * off / spread;
        }
      EXPECT_GT(blocks, 40);
      EXPECT_LT(worst, 4.8) << levels;
      EXPECT_LT(chi2 / blocks, 1 + 5 * std::sqrt(2.0 / blocks)) << levels;
    }
}

}  // namespace
}  // namespace translucube::test

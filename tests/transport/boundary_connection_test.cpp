// Light found through the boundary of any body: every way out through flat faces is a real one, few
// are missed, and what is found is what the walk alone finds.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderer/transport/boundary/ways_out.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

constexpr double ior = 1.5;

/// A point inside, uniform in the bounding box.
template <class Shape>
Vec3 point_inside(const Shape& shape, Rng& rng) {
  while (true) {
    const Vec3 p{2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1};
    if (shape.inside(p)) return p;
  }
}

struct Sought {
  int ways = 0, wrong = 0;      ///< ways out towards random lights
  int leaving = 0, missed = 0;  ///< random rays that leave
};

template <class Shape>
Sought seek(const Shape& shape) {
  Rng rng(1);
  Sought result;
  for (int i = 0; i < 20'000; ++i) {
    const Vec3 p = point_inside(shape, rng), light = sample_isotropic(rng);
    find_ways_out(shape, ior, p, light, [&](const WayOut& way) {
      Hit hit;
      ++result.ways;
      const bool meets = shape.intersect_inside(p, way.d, infinity, hit) &&
                         std::fabs(hit.t - way.distance) < 1e-12 && hit.n == way.n;
      const auto out = meets ? refract(-way.d, -hit.n, 1 / ior) : std::nullopt;
      result.wrong += !out || length(*out - light) > 1e-9;
    });
    const Vec3 d = sample_isotropic(rng);
    Hit hit;
    if (!shape.intersect_inside(p, d, infinity, hit)) continue;
    const auto out = refract(-d, -hit.n, 1 / ior);
    if (!out || dot(*out, hit.n) < 1e-2) continue;
    ++result.leaving;
    int found = 0;
    find_ways_out(shape, ior, p, *out,
                  [&](const WayOut& way) { found += length(way.d - d) < 1e-9; });
    EXPECT_LE(found, 1);  // or it would count twice
    result.missed += found == 0;
  }
  return result;
}

TEST(WaysOut, OfPolytopesAreAllFound) {
  for (const Polytope& body : {make_box({0.3, 0.5, 0.8}), make_wedge({0.9, 0.5, 0.4}, 0)}) {
    const Sought sought = seek(body);
    EXPECT_GT(sought.ways, 10'000);
    EXPECT_EQ(sought.wrong, 0);
    EXPECT_GT(sought.leaving, 3'000);
    EXPECT_EQ(sought.missed, 0);
  }
}

TEST(WaysOut, OfMeshesAreRealAndMostlyFound) {
  struct Case {
    TriangleMesh mesh;
    double missed;  ///< at most, of all
  };
  for (const auto& [mesh, missed] : {Case{box({1, 1.5, 2}), 0.1}, Case{icosphere(2), 0.2},
                                     Case{icosphere(5), 0.25}, Case{knot(200, 24), 0.2}}) {
    const Sought sought = seek(build_mesh(mesh).mesh);
    EXPECT_GT(sought.ways, 10'000);
    EXPECT_EQ(sought.wrong, 0);
    EXPECT_LT(sought.missed, missed * sought.leaving) << mesh.triangles.size();
  }
}

/// Light from one side, through a half-open lane.
Scene half_lit(const AnyShape& shape, const Material& m) {
  Scene scene = body(shape, m);
  scene.environment = half_space_light(false);
  scene.lanes = {RgbLane{{0.3f, 0.3f, 0.3f}}};
  look_from_afar(scene, 0.8, 24);
  return scene;
}

/// To `accuracy` standard errors of the relative difference, `samples` a pixel.
void compare_with_the_walk(const AnyShape& shape, const Material& m, std::uint32_t samples,
                           double accuracy) {
  SCOPED_TRACE(testing::Message() << "shape " << shape.index() << " alpha " << m.coefficients.alpha
                                  << " sigma_s " << m.coefficients.sigma_s << " g " << m.g);
  Scene scene = half_lit(shape, m);
  const Film connected = trace(scene, samples);
  light_by_a_table(scene);
  scene.seed = 2;
  const Film walked = trace(scene, 2 * samples);
  EXPECT_GT(connected.counters.light_samples, 0u);
  EXPECT_EQ(walked.counters.light_samples, 0u);
  const Measured a = image_mean(connected), b = image_mean(walked);
  const double error = std::hypot(a.standard_error, b.standard_error);
  EXPECT_NEAR(a.mean, b.mean, 4 * error);
  EXPECT_LT(error, accuracy * b.mean);
}

std::vector<AnyShape> facetted_bodies() {
  return {make_box({0.5, 0.6, 0.6}), build_mesh(icosphere(3)).mesh, build_mesh(knot(120, 16)).mesh};
}

TEST(FacetConnections, FindWhatTheWalkAloneFinds) {
  for (const AnyShape& shape : facetted_bodies()) {
    compare_with_the_walk(shape, material(ior, 0, 0.5), 32, 0.04);
    compare_with_the_walk(shape, material(ior, 0, 5, 0.7), 32, 0.03);
    compare_with_the_walk(shape, material(ior, 0, 20), 32, 0.03);
  }
}

TEST(MicrofacetConnections, FindWhatTheWalkAloneFinds) {
  std::vector<AnyShape> shapes = facetted_bodies();
  shapes.emplace_back(Bowl(0.8));
  for (const AnyShape& shape : shapes) {
    compare_with_the_walk(shape, material(1.2, 0.05, 0.5, 0.5), 32, 0.04);
    compare_with_the_walk(shape, material(2, 0.3, 20), 32, 0.03);
  }
}

TEST(LongFacetConnections, FindWhatTheWalkAloneFindsToHalfAPercent) {
  std::vector<AnyShape> shapes = facetted_bodies();
  shapes.emplace_back(Bowl(0.8));
  for (const AnyShape& shape : shapes)
    for (const double sigma_s : {0.2, 2.0, 30.0})
      for (const double g : {0.0, 0.8})
        for (const double alpha : {0.0, 0.02, 0.5})
          compare_with_the_walk(shape, material(ior, alpha, sigma_s, g), 2048, 0.005);
}

}  // namespace
}  // namespace translucube::test

// Plates, boxes, wedges and bowls: what their rays meet, and the truths of docs/design.md section 6
// in them, with volumes in closed form.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "renderer/scene/placed_shape.h"
#include "renderer/shape/body/body.h"
#include "tests/support/meshes.h"
#include "tests/support/truths.h"

namespace translucube::test {
namespace {

using std::numbers::pi;

/// A body, within the unit ball, whose volume is known.
struct Body {
  std::string name;
  AnyShape shape;
  double volume;
};

double shell(double inner) { return 2 * pi / 3 * (1 - inner * inner * inner); }

std::vector<Body> bodies() {
  return {{"plate", make_box({0.7, 0.7, 0.05}), 8 * 0.7 * 0.7 * 0.05},
          {"box", make_box({0.4, 0.5, 0.6}), 8 * 0.4 * 0.5 * 0.6},
          {"wedge", make_wedge({0.6, 0.5, 0.3}, 0.15), 1.2 * 1.0 * 0.5 * (0.6 + 0.15)},
          {"knife", make_wedge({0.6, 0.5, 0.3}, 0), 1.2 * 1.0 * 0.5 * 0.6},
          {"bowl", Bowl(0.8), shell(0.8)},
          {"thin bowl", Bowl(0.98), shell(0.98)}};
}

/// Bodies of our own that are meshes: what a request makes of them, and their volume in closed form
/// or, where there is none, that of their triangles.
std::vector<Body> made_bodies() {
  const auto body_of = [](const std::string& name, const ObjectSpec& object, double volume_mm3) {
    const PlacedShape placed = place_shape(object);
    return Body{name, placed.shape, volume_mm3 / std::pow(placed.unit_mm, 3)};
  };
  return {
      body_of("torus", TorusObject{14, 6}, 2 * pi * pi * 14 * 36),
      body_of("thin torus", TorusObject{14, 1}, 2 * pi * pi * 14),
      // 20 x 12 x 4 and its neighbourhood of 3.
      body_of("rounded box", RoundedBoxObject{26, 18, 10, 3},
              20 * 12 * 4 + 2 * 3 * (20 * 12 + 12 * 4 + 4 * 20) + 9 * pi * (20 + 12 + 4) + 36 * pi),
      body_of("relief", ReliefObject{40, 40, 8, 0.5, 0.5, 5}, 40 * 40 * 6),
      body_of("sine relief", ReliefObject{40, 40, 8, 0, 0.9, 9}, 40 * 40 * 4.4),
      body_of("square relief", ReliefObject{40, 40, 8, 1, 0.5, 3}, 40 * 40 * 6),
      body_of("blob", BlobObject{}, volume(refined(make_blob(20, 0.3, 1, 1)))),
      body_of("sphere as a blob", BlobObject{20, 0, 1, 1}, 4 * pi / 3 * 8000),
      body_of("dragon", DragonObject{}, volume(refined(make_dragon(44))))};
}

/// A direction out of `count` that cover the sphere evenly (Fibonacci spiral), turned by `turn`.
Vec3 even_direction(int i, int count, double turn) {
  const double z = 1 - (2 * i + 1.0) / count, phi = turn + i * pi * (3 - std::sqrt(5.0));
  const double r = std::sqrt(1 - z * z);
  return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Where a line through the unit ball is in the body, as the shape's rays tell it.
template <class S>
std::vector<std::array<double, 2>> crossings(const S& shape, Vec3 from, Vec3 d) {
  std::vector<std::array<double, 2>> all;
  Hit hit;
  double t = 0;
  Vec3 p = from;
  while (shape.intersect_outside(p, d, hit)) {
    EXPECT_LT(dot(hit.n, d), 0);
    const double in = t += hit.t;
    p = hit.p;
    EXPECT_TRUE(shape.intersect_inside(p, d, 1e9, hit));
    EXPECT_GT(dot(hit.n, d), 0);
    t += hit.t;
    p = hit.p;
    all.push_back({in, t});
  }
  return all;
}

TEST(Objects, AreMetWhereTheyAre) {
  for (const Body& body : bodies())
    std::visit(
        [&](const auto& shape) {
          Rng rng(7);
          double inside = 0;
          constexpr int lines = 20'000;
          for (int i = 0; i < lines; ++i) {
            const Vec3 d = sample_isotropic(rng);
            const Frame frame(d);
            // Over the unit disc, from far away and from near by.
            const double r = std::sqrt(rng.uniform()), phi = 2 * pi * rng.uniform();
            const Vec3 from =
                r * (std::cos(phi) * frame.x + std::sin(phi) * frame.y) - (i % 2 ? 1.001 : 1e4) * d;
            const auto spans = crossings(shape, from, d);
            ASSERT_LE(spans.size(), shape.convex() ? 1u : 2u);
            for (const auto& [in, out] : spans) inside += out - in;
            const double start = i % 2 ? 0 : 1e4 - 1.001, t = start + 2.002 * rng.uniform();
            bool met = false, at_edge = false;
            for (const auto& span : spans) {
              met |= span[0] < t && t < span[1];
              for (const double end : span) at_edge |= std::fabs(t - end) < 1e-6;
            }
            if (!at_edge) {
              ASSERT_EQ(shape.inside(from + t * d), met) << body.name << " line " << i;
            }
          }
          // The mean over all lines of the length inside, times the disc, is the volume (Cauchy).
          EXPECT_NEAR(inside / lines * pi / body.volume, 1, 0.05) << body.name;
        },
        body.shape);
}

TEST(Objects, KnowHowFarTheirSurfaceIsAtLeast) {
  for (const Body& body : bodies())
    std::visit(
        [&](const auto& shape) {
          Rng rng(8);
          for (int found = 0; found < 2000;) {
            const Vec3 p{2 * rng.uniform() - 1, 2 * rng.uniform() - 1, 2 * rng.uniform() - 1};
            if (!shape.inside(p)) continue;
            ++found;
            const double free = shape.clearance(p);
            EXPECT_GT(free, 0) << body.name;
            Hit hit;
            for (int i = 0; i < 20; ++i)
              EXPECT_FALSE(
                  shape.intersect_inside(p, sample_isotropic(rng), free * (1 - 1e-12), hit))
                  << body.name;
          }
        },
        body.shape);
}

/// The length inside of isotropic light, over the volume times ior^2: light that leaves and comes
/// back counts on. 1, as every ray of diffuse light has 4 V / S ior^2 in the mean.
double length_over_volume(const Body& which, const Material& m, int directions,
                          std::uint32_t samples) {
  constexpr int size = 16;
  constexpr double half = 1.0, distance = 1e5;
  double sum = 0;
  for (int i = 0; i < directions; ++i) {
    Scene scene = path_scene(which.shape, m, hash_combine(3, i), size);
    const Vec3 d = even_direction(i, directions, 1);
    scene.camera =
        Camera(distance * d, {}, Frame(d).x, 2 * std::atan(half / distance) * 180 / pi, size, size);
    sum += image_mean(trace(scene, samples)).mean;
  }
  return sum / directions * 4 * half * half / (which.volume * m.ior * m.ior);
}

TEST(MeanPathLength, InPlatesBoxesWedgesAndBowlsIsThatOfTheirVolume) {
  for (const Body& which : bodies())
    for (const Material& m : {material(1.5, 0, 2), material(1.33, 0.3, 0)})
      EXPECT_NEAR(length_over_volume(which, m, 20, 8), 1, 0.08)
          << which.name << " alpha " << m.coefficients.alpha;
}

TEST(MeanPathLength, InBodiesOfOurOwnIsThatOfTheirVolume) {
  for (const Body& which : made_bodies())
    for (const Material& m : {material(1.5, 0, 2), material(1.33, 0.3, 0)})
      EXPECT_NEAR(length_over_volume(which, m, 50, 8), 1, 0.05)
          << which.name << " alpha " << m.coefficients.alpha;
}

TEST(LongMeanPathLength, InBodiesOfOurOwnIsThatOfTheirVolumeToHalfAPercent) {
  for (const Body& which : made_bodies())
    for (const Material& m : {material(1.5, 0, 2), material(1.5, 0.3, 0), material(1.33, 0.2, 5)})
      EXPECT_NEAR(length_over_volume(which, m, 400, 24), 1, 0.005)
          << which.name << " alpha " << m.coefficients.alpha;
}

TEST(LongMeanPathLength, InPlatesBoxesWedgesAndBowlsIsThatOfTheirVolumeToHalfAPercent) {
  for (const Body& which : bodies())
    for (const Material& m :
         {material(1.5, 0, 2), material(1.5, 0.3, 0), material(1.33, 0.2, 5), material(1.5, 0, 30)})
      EXPECT_NEAR(length_over_volume(which, m, 400, 48), 1, 0.005)
          << which.name << " alpha " << m.coefficients.alpha;
}

TEST(Box, OfPlanesLooksLikeTheMesh) {
  for (const Material& m : {material(1.5, 0, 4), material(1.5, 0.3, 1)}) {
    const BuiltMesh mesh = build_mesh(box({1, 1.5, 2}));
    Scene planes = body(make_box(Vec3{0.5, 0.75, 1} * (1 / mesh.radius)), m),
          triangles = body(mesh.mesh, m);
    for (Scene* scene : {&planes, &triangles}) {
      scene->environment = half_space_light(true);
      scene->width = scene->height = 24;
      scene->camera = Camera({1.5, 1.1, 2.5}, {0, 0, 0}, {0, 1, 0}, 30, 24, 24);
    }
    const Measured a = image_mean(trace(planes, 256)), b = image_mean(trace(triangles, 256));
    const double error = std::hypot(a.standard_error, b.standard_error);
    EXPECT_NEAR(a.mean, b.mean, 4 * error);
    EXPECT_LT(error / a.mean, 6e-3);
  }
}

}  // namespace
}  // namespace translucube::test

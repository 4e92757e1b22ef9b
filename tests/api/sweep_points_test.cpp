// The values of a sweep: its points, their seeds, and what is traced for them.

#include <nlohmann/json.hpp>
#include <set>

#include "api/request/canonical.h"
#include "api/request/scene_spec.h"
#include "api/request/sweep.h"
#include "tests/api/fixture.h"

namespace translucube::api {
namespace {

using nlohmann::json;
using testing::ElementsAre;

Sweep small_sweep() {
  Sweep sweep{accepted(request_with(R"("image":{"width":8,"height":4},"quality":{"samples":16})")),
              {0.5, 0, 1},
              {0.2, 0.4},
              {0.1, 0.9},
              {"amber", "red-glass"}};
  return sweep;
}

TEST(SweepPoints, AreNumberedWithTheAbsorptionFastestAndTheAbsorberLast) {
  const Sweep sweep = small_sweep();
  ASSERT_EQ(sweep.point_count(), 24u);
  std::size_t point = 0;
  for (std::size_t absorber = 0; absorber < 2; ++absorber)
    for (std::size_t scattering = 0; scattering < 2; ++scattering)
      for (std::size_t roughness = 0; roughness < 2; ++roughness)
        for (std::size_t absorption = 0; absorption < 3; ++absorption)
          EXPECT_EQ(place_of(sweep, point++),
                    (SweepPlace{absorption, roughness, scattering, absorber}));
}

TEST(SweepPoints, APointIsARequestOfItsOwn) {
  const Sweep sweep = small_sweep();
  const RenderRequest request = point_request(sweep, 17);  // of 0 + 3 (1 + 2 (0 + 2 * 1)) + 2
  RenderRequest expected = sweep.base;
  expected.material.point = CubePoint{1, 0.4, 0.1};
  expected.material.absorber = "red-glass";
  expected.seed = request.seed;
  EXPECT_EQ(request, expected);
  EXPECT_EQ(accepted(canonical_json(request)), request) << "its seed too is one that JSON can hold";
}

TEST(SweepPoints, SeedsFollowFromRoughnessScatteringAndTheBasesSeedAlone) {
  const Sweep sweep = small_sweep();
  std::map<std::pair<std::size_t, std::size_t>, std::set<std::uint64_t>> seeds;
  std::set<std::uint64_t> all;
  for (std::size_t point = 0; point < sweep.point_count(); ++point) {
    const SweepPlace place = place_of(sweep, point);
    const std::uint64_t seed = point_request(sweep, point).seed;
    seeds[{place.roughness, place.scattering}].insert(seed);
    all.insert(seed);
  }
  for (const auto& [pair, some] : seeds) EXPECT_EQ(some.size(), 1u);
  EXPECT_EQ(all.size(), seeds.size());

  // The same point of another sweep.
  Sweep other = sweep;
  other.absorption = {0.25};
  other.roughness = {0.9, 0.4, 0.1};
  other.scattering = {0.9};
  other.absorbers = {"amber"};
  EXPECT_EQ(point_request(other, 1).seed, point_request(sweep, 9).seed);
  other.base.seed = 2;
  EXPECT_NE(point_request(other, 1).seed, point_request(sweep, 9).seed);
}

TEST(SweepPoints, ZeroHasOneSeedWhateverItsSign) {
  const auto seed = [](const std::string& roughness) {
    const auto sweep = parse_sweep_request(R"({"base":{"material":{"cube":)" + some_cube +
                                               R"(}},"axes":{"roughness":[)" + roughness + "]}}",
                                           shipped_catalog());
    return point_request(*sweep, 0).seed;
  };
  EXPECT_EQ(seed("0"), seed("-0.0"));
}

TEST(TracedImages, TraceEachRoughnessAndScatteringOnceTheLeastAbsorbingFirst) {
  const Sweep sweep = small_sweep();
  const auto images = traced_images(sweep, {});
  ASSERT_EQ(images.size(), 4u);
  std::set<std::size_t> points;
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (const std::vector<std::size_t>& image : images) {
    const SweepPlace first = place_of(sweep, image.front());
    EXPECT_TRUE(pairs.emplace(first.roughness, first.scattering).second);
    std::vector<double> absorptions;
    for (const std::size_t point : image) {
      const SweepPlace place = place_of(sweep, point);
      EXPECT_EQ(place.roughness, first.roughness);
      EXPECT_EQ(place.scattering, first.scattering);
      EXPECT_TRUE(points.insert(point).second);
      absorptions.push_back(sweep.absorption[place.absorption]);
    }
    EXPECT_THAT(absorptions, ElementsAre(0, 0, 0.5, 0.5, 1, 1));
  }
  EXPECT_EQ(points.size(), sweep.point_count());
}

TEST(TracedImages, HoldNoMorePixelsThanAnImageMayHave) {
  const Sweep sweep = small_sweep();
  Limits limits;
  limits.pixels = 8 * 4 * 4 + 31;  // four films and almost a fifth
  std::vector<std::size_t> sizes;
  std::set<std::size_t> points;
  for (const std::vector<std::size_t>& image : traced_images(sweep, limits)) {
    sizes.push_back(image.size());
    points.insert(image.begin(), image.end());
  }
  EXPECT_THAT(sizes, ElementsAre(4, 2, 4, 2, 4, 2, 4, 2));
  EXPECT_EQ(points.size(), sweep.point_count());
  limits.pixels = 1;  // less than the image itself, which its request would not pass
  EXPECT_EQ(traced_images(sweep, limits).size(), sweep.point_count());
}

TEST(TracedImages, APigmentsPointsAreEachTraced) {
  Sweep sweep = small_sweep();
  sweep.absorption = {0};
  sweep.base.material.pigment_absorption_per_scattering = 0.1;
  EXPECT_EQ(traced_images(sweep, {}).size(), sweep.point_count());
}

TEST(SweepCounts, AreThoseOfItsParts) {
  Sweep sweep = small_sweep();
  EXPECT_EQ(
      json::parse(counts_json(sweep, {})),
      (json{{"points", 24}, {"traced_images", 4}, {"pixels", 32}, {"camera_samples", 2048.0}}));
  sweep.base.quality = ErrorTarget{0.1};
  EXPECT_TRUE(json::parse(counts_json(sweep, {}))["camera_samples"].is_null());
}

TEST(SweepScene, HasALaneForEachRequest) {
  const Sweep sweep = small_sweep();
  std::vector<RenderRequest> lanes;
  const auto images = traced_images(sweep, {});
  for (const std::size_t point : images.front()) lanes.push_back(point_request(sweep, point));
  const SceneSpec spec = scene_spec(lanes, shipped_catalog());
  ASSERT_EQ(spec.more_absorptions.size() + 1, lanes.size());
  EXPECT_EQ(spec.material.coefficients.sigma_a_peak, 0);
  EXPECT_GT(spec.more_absorptions.back().sigma_a_peak, 1e30);
}

}  // namespace
}  // namespace translucube::api

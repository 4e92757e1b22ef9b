// Every finite number of a request is within a documented range or computed right: requests with
// the schema's numbers at their ends are refused, or render to finite light.

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "api/request/catalog.h"
#include "api/request/parse.h"
#include "api/request/scene_spec.h"
#include "renderer/base/sampler.h"
#include "renderer/light/environment_cache.h"
#include "renderer/render.h"
#include "tests/support/repository.h"

namespace translucube::test {
namespace {

using nlohmann::json;

/// What a number of a request may be.
const std::vector<double> extremes{0,       -0.0,  5e-324, 1e-300, 1e-38,    1e-12,
                                   1e-6,    1e-3,  0.5,    0.9999, 1,        1.0001,
                                   1.5,     4,     90,     360,    36000090, 1e6,
                                   1e9,     1e12,  1e38,   1e41,   1e300,    1.7976931348623157e308,
                                   -1e-300, -0.99, -1,     -90,    -1e9,     -1e300};

class Generator {
 public:
  explicit Generator(std::uint64_t seed) : rng_(seed) {}

  json request() {
    json material;
    if (rng_.bits() % 2)
      material["cube"] = {
          {"absorption", number(0.3)}, {"roughness", number(0.2)}, {"scattering", number(0.5)}};
    else
      material["coefficients"] = {{"sigma_a", triple(0.1)},
                                  {"alpha", number(0.2)},
                                  {"sigma_s", number(1)},
                                  {"ior", number(1.5)}};
    maybe(material, "anisotropy", 0.5);
    maybe(material, "reference_thickness_mm", 10);
    if (rng_.bits() % 8 == 0)
      material["oil_film"] = {{"normal", triple(1)}, {"offset_mm", number(0)}};
    json scene{{"object", object()}, {"environment", environment()}};
    if (rng_.bits() % 2)
      scene["camera"] = {{"position_mm", triple(50)},
                         {"target_mm", triple(0)},
                         {"up", triple(1)},
                         {"vfov_deg", number(32)}};
    if (rng_.bits() % 8 == 0)
      scene["backdrop"] = {{"type", rng_.bits() % 2 ? "print" : "light-table"},
                           {"period_mm", number(5)},
                           {"distance_mm", number(0)},
                           {"light", number(1)},
                           {"dark", number(0)}};
    else if (rng_.bits() % 8 == 0)
      scene["ground"] = {{"height_mm", number(-60)}, {"reflectance", number(0.5)}};
    if (rng_.bits() % 8 == 0) scene["lights"] = {light(), light()};
    return {{"material", material},
            {"scene", scene},
            {"image", {{"width", 3}, {"height", 2}}},
            {"quality", {{"seconds", 0.02}}}};
  }

 private:
  double number(double usual) {
    return rng_.bits() % 6 ? usual : extremes[rng_.bits() % extremes.size()];
  }
  json triple(double usual) { return {number(usual), number(usual), number(usual)}; }
  void maybe(json& object, const char* key, double usual) {
    if (rng_.bits() % 3 == 0) object[key] = number(usual);
  }
  json object() {
    if (rng_.bits() % 32 == 0) return body();
    switch (rng_.bits() % 5) {
      case 0:
        return {{"type", "sphere"}, {"radius_mm", number(20)}};
      case 1:
        return {{"type", "plate"},
                {"width_mm", number(40)},
                {"height_mm", number(40)},
                {"thickness_mm", number(4)}};
      case 2:
        return {{"type", "box"},
                {"width_mm", number(28)},
                {"height_mm", number(28)},
                {"depth_mm", number(28)}};
      case 3:
        return {{"type", "wedge"},
                {"width_mm", number(40)},
                {"height_mm", number(40)},
                {"thin_mm", number(0)},
                {"thick_mm", number(10)}};
      default:
        return {{"type", "bowl"}, {"radius_mm", number(20)}, {"thickness_mm", number(3)}};
    }
  }
  /// Seldom, as these take a while to make.
  json body() {
    switch (rng_.bits() % 5) {
      case 0:
        return {{"type", "torus"}, {"major_mm", number(14)}, {"minor_mm", number(6)}};
      case 1:
        return {{"type", "rounded-box"},
                {"width_mm", number(28)},
                {"height_mm", number(28)},
                {"depth_mm", number(28)},
                {"edge_mm", number(4)}};
      case 2:
        return {{"type", "relief"},      {"width_mm", number(40)},   {"height_mm", number(40)},
                {"depth_mm", number(8)}, {"sharpness", number(0.5)}, {"ridges", rng_.bits() % 70}};
      case 3:
        return {{"type", "blob"},
                {"radius_mm", number(20)},
                {"bump", number(0.3)},
                {"scale", number(1)},
                {"seed", rng_.bits() % 100}};
      default:
        return {{"type", "dragon"}, {"length_mm", number(44)}};
    }
  }
  json light() {
    switch (rng_.bits() % 3) {
      case 0:
        return {{"type", "sun"},
                {"direction", triple(1)},
                {"angular_diameter_deg", number(0.5)},
                {"irradiance", triple(1)}};
      case 1:
        return {{"type", "disc"},
                {"center_mm", triple(80)},
                {"normal", triple(-1)},
                {"radius_mm", number(10)},
                {"radiance", triple(1)}};
      default:
        return {{"type", "rectangle"},     {"center_mm", triple(80)}, {"normal", triple(-1)},
                {"up", {0, number(1), 0}}, {"width_mm", number(10)},  {"height_mm", number(10)},
                {"radiance", triple(1)}};
    }
  }
  json environment() {
    json value = rng_.bits() % 2 ? json{{"constant", triple(1)}}
                 : rng_.bits() % 4
                     ? json{{"image", "forest"}}
                     : json{{"harmonics", {triple(1), triple(0), triple(0.1), triple(0)}}};
    maybe(value, "rotation_deg", 0);
    maybe(value, "scale", 1);
    return value;
  }

  Rng rng_;
};

struct Counts {
  int rendered = 0, refused = 0;
};

Counts try_requests(std::uint64_t seed, int count) {
  const api::Catalog catalog =
      api::load_catalog(std::filesystem::path(in_repository("config/service.json")));
  EnvironmentCache environments;
  Counts counts;
  Generator generator(seed);
  for (int i = 0; i < count; ++i) {
    const std::string text = generator.request().dump();
    SCOPED_TRACE(text);
    const auto request = api::parse_render_request(text, catalog);
    if (!request) {
      EXPECT_FALSE(request.problem().faults.empty());
      ++counts.refused;
      continue;
    }
    try {
      const auto scene = build_scene(api::scene_spec(*request, catalog), &environments);
      const RenderResult result = render(*scene, request->quality, 1);
      EXPECT_EQ(result.stats.nan_samples, 0u);
      for (const float value : develop(result.film).pixels) EXPECT_TRUE(std::isfinite(value));
      EXPECT_LT(result.stats.seconds, 2);
      ++counts.rendered;
    } catch (const SceneError&) {
      ++counts.refused;
    }
  }
  return counts;
}

TEST(Extremes, AreRefusedOrRenderToFiniteLight) {
  const Counts counts = try_requests(1, 600);
  EXPECT_GT(counts.rendered, 50);
  EXPECT_GT(counts.refused, 50);
}

TEST(LongExtremes, AreRefusedOrRenderToFiniteLight) {
  for (std::uint64_t seed = 100; seed < 400; ++seed) try_requests(seed, 1000);
}

}  // namespace
}  // namespace translucube::test

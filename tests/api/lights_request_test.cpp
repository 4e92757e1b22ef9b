// Lamps, harmonics and the ground of a request.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "api/request/canonical.h"
#include "api/request/scene_spec.h"
#include "tests/api/fixture.h"

namespace translucube::api {
namespace {

using testing::UnorderedElementsAre;

std::string scene(const std::string& members) {
  return request_with(R"("scene":{)" + members + "}");
}

TEST(LightsRequest, KeepTheDefaultsOfWhatTheyDoNotSay) {
  const RenderRequest request = accepted(
      scene(R"("lights":[{"type":"sun","direction":[0,0,2]},{"type":"disc","radius_mm":5},)"
            R"({"type":"rectangle","width_mm":7}])"));
  ASSERT_EQ(request.lights.size(), 3u);
  EXPECT_EQ(std::get<SunSpec>(request.lights[0]), (SunSpec{.direction = {0, 0, 2}}));
  EXPECT_EQ(std::get<DiscSpec>(request.lights[1]), (DiscSpec{.radius_mm = 5}));
  EXPECT_EQ(std::get<RectangleSpec>(request.lights[2]), (RectangleSpec{.width_mm = 7}));
  EXPECT_TRUE(accepted(scene("")).lights.empty());
}

TEST(LightsRequest, TellEveryFault) {
  EXPECT_THAT(
      pointers(scene(R"("lights":[{"type":"sun","direction":[0,0,0],"angular_diameter_deg":0.01,)"
                     R"("irradiance":[1,-1,1],"radius_mm":1},{"type":"lamp"},{},7,)"
                     R"({"type":"disc","center_mm":[1,2],"radius_mm":0,"radiance":[1,1,1e10]},)"
                     R"({"type":"rectangle","normal":[0,1,0],"up":[0,-3,0],"height_mm":1e10}])")),
      UnorderedElementsAre("/scene/lights/0/direction", "/scene/lights/0/angular_diameter_deg",
                           "/scene/lights/0/irradiance/1", "/scene/lights/0/radius_mm",
                           "/scene/lights/1/type", "/scene/lights/2/type", "/scene/lights/3",
                           "/scene/lights/4/center_mm", "/scene/lights/4/radius_mm",
                           "/scene/lights/4/radiance/2", "/scene/lights/5/up",
                           "/scene/lights/5/height_mm"));
  EXPECT_THAT(pointers(scene(R"("lights":"above")")), UnorderedElementsAre("/scene/lights"));
  EXPECT_THAT(pointers(scene(R"("lights":{})")), UnorderedElementsAre("/scene/lights"));
  std::string many;
  for (int i = 0; i < 65; ++i) many += R"({"type":"sun"},)";
  many.pop_back();
  EXPECT_THAT(pointers(scene("\"lights\":[" + many + "]")), UnorderedElementsAre("/scene/lights"));
}

TEST(LightsRequest, OfAPresetAreWrittenOut) {
  for (const char* name : {"front", "side", "back"}) {
    const RenderRequest request = accepted(scene(R"("lights":")" + std::string(name) + "\""));
    ASSERT_EQ(request.lights.size(), 1u) << name;
    EXPECT_EQ(accepted(canonical_json(request)), request) << name;
    const double z = std::get<SunSpec>(request.lights[0]).direction.z;
    EXPECT_EQ(z < 0, std::string(name) == "back");
  }
}

TEST(GroundRequest, IsFalseOrAnObjectAndNotWithABackdrop) {
  EXPECT_FALSE(accepted(scene(R"("ground":false)")).ground);
  EXPECT_EQ(accepted(scene(R"("ground":{"height_mm":-30})")).ground, (GroundSpec{-30, 0.5}));
  EXPECT_THAT(pointers(scene(R"("ground":true)")), UnorderedElementsAre("/scene/ground"));
  EXPECT_THAT(pointers(scene(R"("ground":{"reflectance":1.5,"color":1})")),
              UnorderedElementsAre("/scene/ground/reflectance", "/scene/ground/color"));
  EXPECT_THAT(pointers(scene(R"("ground":{},"backdrop":{})")),
              UnorderedElementsAre("/scene/ground"));
}

TEST(Harmonics, AreOneFourNineOrSixteenTriples) {
  const RenderRequest request =
      accepted(scene(R"("environment":{"harmonics":[[1,1,1],[0,0,0],[-0.5,0,0],[0,0,0]]})"));
  EXPECT_EQ(std::get<HarmonicsEnvironment>(request.environment.source).harmonics.at(2)[0], -0.5);
  EXPECT_THAT(pointers(scene(R"("environment":{"harmonics":[[1,1,1],[0,0,0]]})")),
              UnorderedElementsAre("/scene/environment/harmonics"));
  EXPECT_THAT(pointers(scene(R"("environment":{"harmonics":[[1,1,"x"]]})")),
              UnorderedElementsAre("/scene/environment/harmonics/0/2"));
  EXPECT_THAT(pointers(scene(R"("environment":{"harmonics":[[1,1,1]],"constant":[1,1,1]})")),
              UnorderedElementsAre("/scene/environment"));
}

/// What the scene is refused with.
std::string refusal(const std::string& members) {
  try {
    build_scene(scene_spec(accepted(scene(members)), shipped_catalog()));
    return "";
  } catch (const SceneError& error) {
    return error.what();
  }
}

TEST(LightsRequest, AreRefusedWhereTheyCannotBe) {
  EXPECT_EQ(refusal(R"("lights":[{"type":"disc","center_mm":[0,25,0]}])"), "");
  EXPECT_NE(refusal(R"("lights":[{"type":"disc","center_mm":[0,15,0]}])"), "");
  EXPECT_NE(refusal(R"("ground":{"height_mm":-19.9})"), "");
  EXPECT_EQ(refusal(R"("ground":{"height_mm":-20})"), "");
  EXPECT_NE(refusal(R"("ground":{"height_mm":-20},"camera":{"position_mm":[0,-25,90]})"), "");
  EXPECT_NE(refusal(R"("ground":{"height_mm":-20},)"
                    R"("lights":[{"type":"disc","center_mm":[60,-10,0],"normal":[-1,0,0]}])"),
            "");
  EXPECT_EQ(refusal(R"("ground":{"height_mm":-20},)"
                    R"("lights":[{"type":"disc","center_mm":[60,5,0],"normal":[-1,0,0]}])"),
            "");
}

}  // namespace
}  // namespace translucube::api

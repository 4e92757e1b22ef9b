#include "api/answer/material_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "api/request/scene_spec.h"
#include "renderer/film/absorption.h"
#include "renderer/optics/material_cube.h"
#include "tests/api/fixture.h"

namespace translucube::api {
namespace {

using nlohmann::json;

std::string cube(const std::string& a, const std::string& r, const std::string& s,
                 const std::string& beside = "") {
  return R"({"material":{"cube":{"absorption":)" + a + R"(,"roughness":)" + r +
         R"(,"scattering":)" + s + "}" + beside + "}}";
}

json report(const std::string& text) {
  return json::parse(material_report(accepted(text), shipped_catalog()));
}

TEST(MaterialReport, GivesCoefficientsForACube) {
  const json said = report(cube("0.5", "0.3", "0.5", R"(,"anisotropy":0.5)"));
  EXPECT_EQ(said["cube"], json::parse(R"({"absorption":0.5,"roughness":0.3,"scattering":0.5})"));
  EXPECT_DOUBLE_EQ(said["coefficients"]["sigma_a_peak"], std::log(2.0) / 10);
  EXPECT_DOUBLE_EQ(said["coefficients"]["alpha"], 0.09);
  EXPECT_DOUBLE_EQ(said["coefficients"]["sigma_s"], 8.0 / 30);
  EXPECT_EQ(said["coefficients"]["g"], 0.5);
  EXPECT_EQ(said["coefficients"]["ior"], 1.5);
  EXPECT_DOUBLE_EQ(said["mean_free_path_mm"], 1 / (8.0 / 30 + std::log(2.0) / 10));
  EXPECT_DOUBLE_EQ(said["transport_mean_free_path_mm"], 1 / (4.0 / 30 + std::log(2.0) / 10));
  EXPECT_DOUBLE_EQ(said["albedo"], (8.0 / 30) / (8.0 / 30 + std::log(2.0) / 10));
}

TEST(MaterialReport, GivesTheCubeForCoefficients) {
  const json said =
      report(R"({"material":{"coefficients":{"sigma_a_peak":0.06931471805599453,"alpha":0.25,)"
             R"("sigma_s":0.13333333333333333}}})");
  EXPECT_NEAR(said["cube"]["absorption"], 0.5, 1e-15);
  EXPECT_DOUBLE_EQ(said["cube"]["roughness"], 0.5);
  EXPECT_NEAR(said["cube"]["scattering"], 0.5, 1e-15);
}

TEST(MaterialReport, InfiniteValuesAreNull) {
  const json clear = report(cube("0", "0", "0"));
  EXPECT_TRUE(clear["mean_free_path_mm"].is_null());
  EXPECT_TRUE(clear["transport_mean_free_path_mm"].is_null());
  EXPECT_EQ(clear["albedo"], 0);
  const json white = report(cube("0", "0", "1"));
  EXPECT_TRUE(white["coefficients"]["sigma_s"].is_null());
  EXPECT_EQ(white["mean_free_path_mm"], 0);
  EXPECT_EQ(white["albedo"], 1);
  const json black = report(cube("1", "0", "1", R"(,"absorber":{"rgb":[0,0.5,1]})"));
  EXPECT_TRUE(black["coefficients"]["sigma_a_peak"].is_null());
  EXPECT_EQ(black["albedo"], 0);
  EXPECT_EQ(black["color_through_reference"], json::parse("[0.0,0.0,0.0]"));
}

TEST(MaterialReport, ClearBodyShowsWhite) {
  const json color = report(cube("0", "0", "0.5"))["color_through_reference"];
  for (const double channel : color) EXPECT_NEAR(channel, 1, 1e-9);
}

TEST(MaterialReport, NeutralAbsorberShowsGrey) {
  const json color =
      report(cube("0.9", "0", "0", R"(,"absorber":"smoke")"))["color_through_reference"];
  for (const double channel : color) EXPECT_NEAR(channel, 0.1, 1e-9);
}

TEST(MaterialReport, RgbAbsorberShowsPlainExponentials) {
  const json said = report(cube("0.9", "0", "0", R"(,"absorber":{"rgb":[0.3,1,2]})"));
  EXPECT_NEAR(said["color_through_reference"][0], std::pow(0.1, 0.15), 1e-12);
  EXPECT_NEAR(said["color_through_reference"][1], std::pow(0.1, 0.5), 1e-12);
  EXPECT_NEAR(said["color_through_reference"][2], 0.1, 1e-12);
  EXPECT_NEAR(said["coefficients"]["sigma_a"][1], std::log(10.0) / 20, 1e-15);
}

TEST(MaterialReport, CoefficientsOfChannelsAreKept) {
  const json said =
      report(R"({"material":{"coefficients":{"sigma_a":[0,0.05,0.2],"alpha":0.1,"sigma_s":1}}})");
  EXPECT_EQ(said["coefficients"]["sigma_a_peak"], 0.2);
  EXPECT_EQ(said["coefficients"]["sigma_a"], json::parse("[0.0,0.05,0.2]"));
  EXPECT_NEAR(said["color_through_reference"][1], std::exp(-0.5), 1e-12);
}

TEST(MaterialReport, ChannelsWithoutAbsorptionAreClear) {
  const json said =
      report(R"({"material":{"coefficients":{"sigma_a":[0,0,0],"alpha":0.1,"sigma_s":0}}})");
  EXPECT_EQ(said["color_through_reference"], json::parse("[1.0,1.0,1.0]"));
  EXPECT_EQ(said["cube"]["absorption"], 0);
}

TEST(MaterialReport, ColorIsTheOneThatTheRendererDevelops) {
  for (const auto& [name, absorber] : shipped_catalog().absorbers) {
    const RenderRequest request =
        accepted(cube("0.9", "0", "0.2", R"(,"absorber":")" + name + "\""));
    const json color = json::parse(material_report(request, shipped_catalog()));
    const Material material = scene_spec(request, shipped_catalog()).material;
    const Lane lane = make_lane(material.absorber, material.coefficients.sigma_a_peak);
    const Rgb developed = std::visit([](const auto& l) { return l.apply(Rgb{1, 1, 1}, 10); }, lane);
    EXPECT_NEAR(color["color_through_reference"][0], developed.r, 2e-3) << name;
    EXPECT_NEAR(color["color_through_reference"][1], developed.g, 2e-3) << name;
    EXPECT_NEAR(color["color_through_reference"][2], developed.b, 2e-3) << name;
  }
}

TEST(SceneSpec, AbsorbersAreRelativeToTheirPeak) {
  const auto material = [](const std::string& absorber) {
    const auto request = accepted(material_with("\"absorber\":" + absorber));
    return scene_spec(request, shipped_catalog()).material.absorber;
  };
  EXPECT_EQ(std::get<RgbAbsorber>(material(R"({"rgb":[1,2,4]})")), (RgbAbsorber{{0.25, 0.5, 1}}));
  EXPECT_EQ(
      std::get<SpectralAbsorber>(material(R"({"wavelengths_nm":[400,500,600],"values":[0,10,5]})")),
      (SpectralAbsorber{{400, 500, 600}, {0, 1, 0.5}}));
}

TEST(SceneSpec, HoldsWhatTheRequestSays) {
  const RenderRequest request = accepted(request_with(
      R"("scene":{"object":{"radius_mm":7},"environment":{"constant":[1,2,3],"rotation_deg":30,)"
      R"("scale":2},"camera":{"position_mm":[1,2,3],"target_mm":[4,5,6],"up":[0,0,1],)"
      R"("vfov_deg":50}},"image":{"width":8,"height":9},"seed":77)"));
  const SceneSpec spec = scene_spec(request, shipped_catalog());
  EXPECT_EQ(spec.material.coefficients, from_cube({0.3, 0.3, 0.5}, 0, 10));
  EXPECT_EQ(std::get<SphereObject>(spec.object).radius_mm, 7);
  EXPECT_EQ(std::get<ConstantEnvironmentSpec>(spec.environment.source).radiance, (Rgb{1, 2, 3}));
  EXPECT_EQ(spec.environment.rotation_deg, 30);
  EXPECT_EQ(spec.environment.scale, 2);
  EXPECT_EQ(spec.camera.position_mm, (Vec3{1, 2, 3}));
  EXPECT_EQ(spec.camera.target_mm, (Vec3{4, 5, 6}));
  EXPECT_EQ(spec.camera.up, (Vec3{0, 0, 1}));
  EXPECT_EQ(spec.camera.vfov_deg, 50);
  EXPECT_EQ(spec.width, 8);
  EXPECT_EQ(spec.height, 9);
  EXPECT_EQ(spec.seed, 77u);
}

TEST(SceneSpec, NamedEnvironmentIsItsFile) {
  const SceneSpec spec = scene_spec(
      accepted(request_with(R"("scene":{"environment":{"image":"sunrise"}})")), shipped_catalog());
  EXPECT_EQ(std::get<ImageEnvironmentSpec>(spec.environment.source).file,
            shipped_catalog().environments.at("sunrise"));
}

}  // namespace
}  // namespace translucube::api

#include "api/request/appearance_request.h"

#include <nlohmann/json.hpp>

#include "api/answer/appearance_report.h"
#include "api/request/scene_spec.h"
#include "tests/api/fixture.h"

namespace translucube::api {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::string slab_of(const std::string& members) {
  return R"({"material":{"cube":)" + some_cube + R"(},"slab":{"thickness_mm":0.2})" + members + "}";
}

std::vector<std::string> faults_of(const std::string& text) {
  return fault_pointers(parse_appearance_request(text, shipped_catalog()));
}

json answer_to(const std::string& text) {
  const auto request = *parse_appearance_request(text, shipped_catalog());
  const Material material =
      scene_spec(render_request(request, shipped_catalog()), shipped_catalog()).material;
  const SlabAppearance appearance =
      slab_appearance(material, request.thickness_mm, request.standard_error, request.seed, 1);
  return json::parse(appearance_json(request, appearance, shipped_catalog()));
}

TEST(AppearanceRequest, HasNoOilFilm) {
  EXPECT_THAT(faults_of(R"({"material":{"cube":)" + some_cube +
                        R"(,"oil_film":{}},"slab":{"thickness_mm":0.2}})"),
              ElementsAre("/material/oil_film"));
}

TEST(AppearanceRequest, TheShortestHasDefaults) {
  const auto request = *parse_appearance_request(slab_of(""), shipped_catalog());
  EXPECT_EQ(request.thickness_mm, 0.2);
  EXPECT_EQ(request.standard_error, 1e-3);
  EXPECT_EQ(request.seed, 1u);
  EXPECT_EQ(request.material.ior, 1.5);
}

TEST(AppearanceRequest, FaultsHavePointers) {
  EXPECT_THAT(faults_of("{}"), UnorderedElementsAre("/material", "/slab"));
  for (const char* thickness : {"0", "-1", "1e7", "\"1\"", "null"})
    EXPECT_THAT(faults_of(R"({"material":{"cube":)" + some_cube + R"(},"slab":{"thickness_mm":)" +
                          thickness + "}}"),
                ElementsAre("/slab/thickness_mm"))
        << thickness;
  EXPECT_THAT(faults_of(slab_of(R"(,"quality":{"standard_error":0})")),
              ElementsAre("/quality/standard_error"));
  EXPECT_THAT(faults_of(slab_of(R"(,"quality":{"samples":4})")),
              UnorderedElementsAre("/quality/standard_error", "/quality/samples"));
  EXPECT_THAT(faults_of(slab_of(R"(,"seed":-1,"scene":{})")),
              UnorderedElementsAre("/seed", "/scene"));
  EXPECT_THAT(faults_of(R"({"material":{"cube":)" + some_cube +
                        R"(,"ior":5,"anisotropy":1,"pigment":{"absorption_per_scattering":-1}},)" +
                        R"("slab":{"thickness_mm":1}})"),
              UnorderedElementsAre("/material/ior", "/material/anisotropy",
                                   "/material/pigment/absorption_per_scattering"));
}

/// The faults of a slab with these members of the material.
std::vector<std::string> material_faults(const std::string& members) {
  return faults_of(R"({"material":{)" + members + R"(},"slab":{"thickness_mm":1}})");
}

TEST(AppearanceRequest, MaterialsAreThoseOfARender) {
  const std::string cube = R"("cube":)" + some_cube + ',';
  for (const char* g : {"1", "-1", "1.5", "\"0\"", "null"})
    EXPECT_THAT(material_faults(cube + R"("anisotropy":)" + g), ElementsAre("/material/anisotropy"))
        << g;
  for (const char* ior : {"0.99", "4.01", "-1.5", "null"})
    EXPECT_THAT(material_faults(cube + R"("ior":)" + ior), ElementsAre("/material/ior")) << ior;
  for (const char* alpha : {"1.01", "-0.1", "null"})
    EXPECT_THAT(material_faults(R"("coefficients":{"sigma_a_peak":1,"sigma_s":1,"alpha":)" +
                                std::string(alpha) + "}"),
                ElementsAre("/material/coefficients/alpha"))
        << alpha;
  EXPECT_THAT(material_faults(
                  R"("coefficients":{"sigma_a":[0,-1,2],"sigma_s":-1,"alpha":2,"g":-1,"ior":0.5})"),
              UnorderedElementsAre("/material/coefficients/sigma_a/1",
                                   "/material/coefficients/sigma_s", "/material/coefficients/alpha",
                                   "/material/coefficients/g", "/material/coefficients/ior"));
}

TEST(AppearanceRequest, SpectraThatCannotAbsorbAreRefused) {
  const auto absorber = [](const std::string& members) {
    return material_faults(R"("cube":)" + some_cube + R"(,"absorber":{)" + members + "}");
  };
  EXPECT_THAT(absorber(R"("wavelengths_nm":[400,700],"values":[0,0])"),
              ElementsAre("/material/absorber/values"));
  EXPECT_THAT(absorber(R"("wavelengths_nm":[400,700],"values":[1,-0.1])"),
              ElementsAre("/material/absorber/values/1"));
  EXPECT_THAT(
      absorber(R"("wavelengths_nm":[700,400],"values":[1,1,1])"),
      UnorderedElementsAre("/material/absorber/wavelengths_nm", "/material/absorber/values"));
  EXPECT_THAT(absorber(R"("rgb":[0,0,0])"), ElementsAre("/material/absorber/rgb"));
  EXPECT_THAT(absorber(R"("rgb":[1,-1,0])"), ElementsAre("/material/absorber/rgb/1"));
}

TEST(AppearanceRequest, AllFaultsComeAtOnce) {
  EXPECT_THAT(faults_of(R"({"material":{"cube":{"absorption":2,"roughness":-1},"ior":0,"shine":1},
                            "slab":{"thickness_mm":-1,"width_mm":3},
                            "quality":{"standard_error":2},"seed":0.5,"glow":true})"),
              UnorderedElementsAre("/material/cube/absorption", "/material/cube/roughness",
                                   "/material/cube/scattering", "/material/ior", "/material/shine",
                                   "/slab/thickness_mm", "/slab/width_mm",
                                   "/quality/standard_error", "/seed", "/glow"));
}

TEST(AppearanceRequest, PigmentsGiveTheAbsorption) {
  const auto request = *parse_appearance_request(
      R"({"material":{"cube":)" + some_cube +
          R"(,"pigment":{"absorption_per_scattering":0.1}},"slab":{"thickness_mm":1}})",
      shipped_catalog());
  EXPECT_EQ(request.material.pigment_absorption_per_scattering, 0.1);
  EXPECT_THAT(material_faults(R"("coefficients":{"sigma_a_peak":1,"sigma_s":1,"alpha":0},
                                 "pigment":{"absorption_per_scattering":0.1})"),
              ElementsAre("/material/pigment"));
}

TEST(AppearanceAnswer, HasEveryQuantityWithItsError) {
  const json answer = answer_to(slab_of(R"(,"quality":{"standard_error":0.01})"));
  for (const char* incidence : {"normal", "diffuse"}) {
    const json& at = answer[incidence];
    for (const auto& [object, keys] : {std::pair<std::string, std::vector<std::string>>{
                                           "reflectance", {"specular", "diffuse", "total"}},
                                       {"transmittance", {"regular", "diffuse", "total"}},
                                       {"reflected", {"xyz", "lab", "bands"}},
                                       {"transmitted", {"xyz", "lab", "bands"}}})
      for (const std::string& key : keys) {
        const std::size_t count = key == "bands" ? 20 : 3;
        EXPECT_EQ(at[object][key].size(), count) << object << key;
        EXPECT_EQ(at[object]["standard_error"][key].size(), count) << object << key;
      }
    for (int c = 0; c < 3; ++c) EXPECT_LE(at["reflectance"]["standard_error"]["total"][c], 0.01);
  }
  EXPECT_TRUE(answer["normal"]["transmitted"]["haze"].is_number());
  EXPECT_TRUE(answer["normal"]["transmitted"]["standard_error"]["clarity"].is_number());
  EXPECT_EQ(answer["bands_nm"].front(), 380);
  EXPECT_EQ(answer["bands_nm"].back(), 780);
  EXPECT_EQ(answer["bands_nm"].size(), 21u);
  EXPECT_EQ(answer["transport"], "walk");
  EXPECT_EQ(answer["slab"]["thickness_mm"], 0.2);
  EXPECT_TRUE(answer["material"].contains("coefficients"));
}

TEST(AppearanceAnswer, OfPigmentsIsThatOfTheirCoefficients) {
  const auto answer = [](const std::string& material) {
    json value = answer_to(R"({"material":{)" + material +
                           R"(,"absorber":"amber"},"slab":{"thickness_mm":1}})");
    value.erase("seconds");
    value.erase("material");
    return value;
  };
  EXPECT_EQ(answer(R"("coefficients":{"sigma_a_peak":0,"sigma_s":20,"alpha":0.1},
                      "pigment":{"absorption_per_scattering":0.05})"),
            answer(R"("coefficients":{"sigma_a_peak":1,"sigma_s":20,"alpha":0.1})"));
}

TEST(AppearanceAnswer, OfDensePigmentsIsColouredAndOpaque) {
  const json answer = answer_to(
      R"({"material":{"cube":{"absorption":0,"roughness":0,"scattering":1},"absorber":{"rgb":[0,0.5,1]},
          "pigment":{"absorption_per_scattering":0.1111111111111111}},"slab":{"thickness_mm":1}})");
  const json& total = answer["normal"]["reflectance"]["total"];
  EXPECT_NEAR(total[0], 1, 1e-5);
  EXPECT_NEAR(total[2].get<double>() / 0.2600, 1, 2e-3) << "Giovanelli (1955), albedo 0.9";
  EXPECT_LT(answer["normal"]["transmittance"]["total"][0], 1e-5);
  EXPECT_NEAR(answer["material"]["albedo"], 0.9, 1e-12);
  EXPECT_EQ(answer["transport"], "adding-doubling");
}

TEST(AppearanceAnswer, SaysNullWhereThereIsNothingToSay) {
  const json black = answer_to(
      R"({"material":{"cube":{"absorption":1,"roughness":0,"scattering":0.5}},"slab":{"thickness_mm":1}})");
  EXPECT_TRUE(black["normal"]["transmitted"]["haze"].is_null());
  EXPECT_TRUE(black["normal"]["transmitted"]["clarity"].is_null());
  const json rgb = answer_to(
      R"({"material":{"coefficients":{"sigma_a":[0.1,1,2],"alpha":0,"sigma_s":0}},"slab":{"thickness_mm":1}})");
  EXPECT_TRUE(rgb["bands_nm"].is_null());
  EXPECT_TRUE(rgb["normal"]["reflected"]["bands"].is_null());
  EXPECT_EQ(rgb["samples"], 0);
}

}  // namespace
}  // namespace translucube::api

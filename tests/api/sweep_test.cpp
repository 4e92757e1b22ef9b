#include "api/request/sweep.h"

#include <nlohmann/json.hpp>
#include <set>

#include "tests/api/fixture.h"

namespace translucube::api {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// A sweep over the base of the fixture's cube with these members beside it.
std::string sweep_with(const std::string& members, const std::string& of_base = {}) {
  return R"({"base":{"material":{"cube":)" + some_cube + "}" + of_base + "}" +
         (members.empty() ? "" : ",") + members + "}";
}
std::string axes(const std::string& members) { return sweep_with(R"("axes":{)" + members + "}"); }

Sweep accepted_sweep(const std::string& text, const Catalog& catalog = shipped_catalog()) {
  return accepted(parse_sweep_request(text, catalog), text);
}

std::vector<std::string> sweep_pointers(const std::string& text,
                                        const Catalog& catalog = shipped_catalog()) {
  return fault_pointers(parse_sweep_request(text, catalog));
}

TEST(SweepRequest, AnAxisIsAListInItsOrder) {
  const Sweep sweep = accepted_sweep(axes(R"("absorption":[0.5,0,1],"scattering":[0.4])"));
  EXPECT_THAT(sweep.absorption, ElementsAre(0.5, 0, 1));
  EXPECT_THAT(sweep.scattering, ElementsAre(0.4));
}

TEST(SweepRequest, AnIntervalHasItsEndsExactlyAndEvenSteps) {
  const Sweep sweep = accepted_sweep(axes(
      R"("absorption":{"from":0.1,"to":0.7,"count":7},"roughness":{"from":1,"to":0,"count":3},)"
      R"("scattering":{"from":0.3,"to":0.3,"count":1})"));
  ASSERT_EQ(sweep.absorption.size(), 7u);
  EXPECT_EQ(sweep.absorption.front(), 0.1);
  EXPECT_EQ(sweep.absorption.back(), 0.7);
  for (std::size_t i = 0; i < 7; ++i) EXPECT_NEAR(sweep.absorption[i], 0.1 * double(i + 1), 1e-15);
  EXPECT_THAT(sweep.roughness, ElementsAre(1, 0.5, 0));
  EXPECT_THAT(sweep.scattering, ElementsAre(0.3));
}

TEST(SweepRequest, WhatIsLeftOutIsTheBases) {
  for (const char* members : {"", R"("axes":{})"}) {
    const Sweep sweep = accepted_sweep(sweep_with(members, R"(,"seed":7)"));
    EXPECT_THAT(sweep.absorption, ElementsAre(0.3));
    EXPECT_THAT(sweep.roughness, ElementsAre(0.3));
    EXPECT_THAT(sweep.scattering, ElementsAre(0.5));
    EXPECT_THAT(sweep.absorbers, ElementsAre(AbsorberRequest("red-glass")));
    EXPECT_EQ(sweep.base, accepted(request_with(R"("seed":7)")));
    EXPECT_EQ(sweep.point_count(), 1u);
  }
}

TEST(SweepRequest, AbsorbersAreNamesOrObjects) {
  const Sweep sweep = accepted_sweep(sweep_with(R"("absorbers":["amber",{"rgb":[0,1,1]},)"
                                                R"({"wavelengths_nm":[400,700],"values":[1,0]}])"));
  ASSERT_EQ(sweep.absorbers.size(), 3u);
  EXPECT_EQ(sweep.absorbers[0], AbsorberRequest("amber"));
  EXPECT_TRUE(std::holds_alternative<RgbAbsorber>(sweep.absorbers[1]));
  EXPECT_TRUE(std::holds_alternative<SpectralAbsorber>(sweep.absorbers[2]));
}

TEST(SweepRequest, WrongAxesAreToldWhereTheyAre) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {R"("absorption":[])", "/axes/absorption"},
      {R"("absorption":[0.5,0.5])", "/axes/absorption"},
      {R"("absorption":[0,-0.0])", "/axes/absorption"},
      {R"("absorption":[0,1.5])", "/axes/absorption/1"},
      {R"("absorption":[0,"1"])", "/axes/absorption/1"},
      {R"("absorption":0.5)", "/axes/absorption"},
      {R"("absorption":null)", "/axes/absorption"},
      {R"("absorption":{"from":-1,"to":1,"count":2})", "/axes/absorption/from"},
      {R"("absorption":{"from":0,"to":2,"count":2})", "/axes/absorption/to"},
      {R"("absorption":{"from":0,"to":1,"count":0})", "/axes/absorption/count"},
      {R"("absorption":{"from":0,"to":1,"count":1})", "/axes/absorption/count"},
      {R"("absorption":{"from":0,"to":1,"count":2.5})", "/axes/absorption/count"},
      {R"("absorption":{"from":0,"to":1,"count":20001})", "/axes/absorption/count"},
      {R"("absorption":{"from":0,"to":1})", "/axes/absorption/count"},
      {R"("absorption":{"from":0.5,"to":0.5,"count":2})", "/axes/absorption"},
      {R"("absorption":{"from":0,"to":1,"count":2,"step":1})", "/axes/absorption/step"},
      {R"("anisotropy":[0])", "/axes/anisotropy"},
      {R"("absorption":{"from":0,"to":1,"count":101},"roughness":{"from":0,"to":1,"count":199})",
       "/axes"},
  };
  for (const auto& [members, pointer] : wrong)
    EXPECT_THAT(sweep_pointers(axes(members)), ElementsAre(pointer)) << members;
}

TEST(SweepRequest, TheNumberOfPointsIsBoundedNotTheAxes) {
  EXPECT_EQ(accepted_sweep(axes(R"("absorption":{"from":0,"to":1,"count":20000})")).point_count(),
            20'000u);
  EXPECT_THAT(sweep_pointers(sweep_with(R"("axes":{"absorption":{"from":0,"to":1,"count":10001}},)"
                                        R"("absorbers":["amber","red-glass"])")),
              ElementsAre("/axes"));
}

TEST(SweepRequest, WrongAbsorbersAreToldWhereTheyAre) {
  const std::vector<std::pair<std::string, std::string>> wrong{
      {"[]", "/absorbers"},
      {R"("amber")", "/absorbers"},
      {R"(["amber","none"])", "/absorbers/1"},
      {R"(["amber","red-glass","amber"])", "/absorbers/2"},
      {R"([{"rgb":[0,1,1]},{"rgb":[0,1,1]}])", "/absorbers/1"},
      {R"([{"rgb":[0,1]}])", "/absorbers/0/rgb"}};
  for (const auto& [absorbers, pointer] : wrong)
    EXPECT_THAT(sweep_pointers(sweep_with(R"("absorbers":)" + absorbers)), ElementsAre(pointer))
        << absorbers;
}

TEST(SweepRequest, TellsTheFaultsOfAllItsParts) {
  EXPECT_THAT(sweep_pointers("{}"), ElementsAre("/base"));
  EXPECT_THAT(sweep_pointers("[]"), ElementsAre(""));
  EXPECT_THAT(sweep_pointers(
                  R"({"base":{"material":{"cube":{"absorption":2,"roughness":0,"scattering":0}},)"
                  R"("sead":1},"axes":{"roughness":[2]},"absorbers":[],"axis":0})"),
              testing::UnorderedElementsAre("/base/material/cube/absorption", "/base/sead",
                                            "/axes/roughness/0", "/absorbers", "/axis"));
}

std::string base_of_material(const std::string& material, const std::string& members) {
  return R"({"base":{"material":{)" + material + "}" + members;
}
const std::string pigment_base = base_of_material(
    R"("cube":)" + some_cube + R"(,"pigment":{"absorption_per_scattering":0.1})", "");

TEST(SweepRequest, RefusesBasesThatHaveNoSuchGrid) {
  EXPECT_THAT(sweep_pointers(base_of_material(
                  R"("coefficients":{"sigma_a_peak":1,"alpha":0.1,"sigma_s":5})", "}}")),
              ElementsAre("/base/material"));
  EXPECT_THAT(sweep_pointers(sweep_with("", R"(,"explorable":true)")),
              ElementsAre("/base/explorable"));
  EXPECT_THAT(sweep_pointers(pigment_base + R"(},"axes":{"absorption":[0,1]}})"),
              ElementsAre("/axes/absorption"));
  EXPECT_THAT(sweep_pointers(pigment_base + R"(,"model":"dipole"},"axes":{"scattering":[0.5,1]}})"),
              ElementsAre("/axes/scattering"));
  EXPECT_THAT(sweep_pointers(pigment_base + R"(},"axes":{"scattering":[0.5,1]}})"), IsEmpty());
}

TEST(SweepRequest, BoundsTheSamplesOfAllTracedImages) {
  Catalog catalog = shipped_catalog();
  catalog.limits.camera_samples = 64 * 64 * 10 * 4;
  const std::string base = R"(,"image":{"width":64,"height":64},"quality":{"samples":10})";
  const auto sweep = [&](const std::string& members) { return sweep_with(members, base); };
  EXPECT_THAT(sweep_pointers(sweep(R"("axes":{"roughness":[0,0.1,0.2,0.3]})"), catalog), IsEmpty());
  EXPECT_THAT(
      sweep_pointers(sweep(R"("axes":{"absorption":{"from":0,"to":1,"count":99}})"), catalog),
      IsEmpty())
      << "absorption is developed";
  EXPECT_THAT(sweep_pointers(sweep(R"("axes":{"roughness":[0,0.1,0.2,0.3,0.4]})"), catalog),
              ElementsAre("/base/quality/samples"));
}

TEST(SweepRequest, ItsCanonicalFormParsesBackToIt) {
  for (const std::string& text :
       {sweep_with(""), axes(R"("absorption":{"from":0.1,"to":0.7,"count":7},"roughness":[1,0.2])"),
        sweep_with(R"("absorbers":["amber",{"rgb":[0.1,1,0.3]},)"
                   R"({"wavelengths_nm":[400,500,700],"values":[1,0.3,0]}])",
                   R"(,"seed":99,"quality":{"seconds":0.3})"),
        pigment_base + R"(},"axes":{"scattering":[0,1]}})"}) {
    const Sweep sweep = accepted_sweep(text);
    const std::string canonical = canonical_json(sweep);
    const Sweep again = accepted_sweep(canonical);
    EXPECT_EQ(again, sweep) << canonical;
    EXPECT_EQ(canonical_json(again), canonical);
  }
}

}  // namespace
}  // namespace translucube::api

#include "api/request/redevelop.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "api/request/canonical.h"
#include "api/request/parse.h"
#include "api/request/scene_spec.h"
#include "tests/api/fixture.h"
#include "tests/support/repository.h"

namespace translucube::api {
namespace {

using nlohmann::json;
using testing::ElementsAre;

std::string canonical(const std::string& material, bool explorable = true) {
  const std::string text =
      R"({"material":)" + material + R"(,"explorable":)" + (explorable ? "true" : "false") + "}";
  return canonical_json(accepted(text, shipped_catalog()));
}

const std::string inside =
    R"({"cube":{"absorption":0.3,"roughness":0.3,"scattering":0.5},"reference_thickness_mm":5})";

Redeveloped redeveloped(const std::string& material, const Redevelopment& asked) {
  return accepted(redevelop(canonical(material), asked, shipped_catalog()), material);
}

TEST(Redevelop, TakesAbsorptionOfTheReferenceThickness) {
  const Redeveloped half = redeveloped(inside, {0.5, {}});
  EXPECT_DOUBLE_EQ(half.absorption.sigma_a_peak, std::log(2.0) / 5);
  EXPECT_EQ(json::parse(half.request)["material"]["cube"]["absorption"], 0.5);
  EXPECT_TRUE(std::isinf(redeveloped(inside, {1.0, {}}).absorption.sigma_a_peak));
}

TEST(Redevelop, KeepsWhatIsNotAsked) {
  const Redeveloped named = redeveloped(inside, {{}, "amber"});
  EXPECT_DOUBLE_EQ(named.absorption.sigma_a_peak, -std::log(0.7) / 5);
  const auto request = *parse_render_request(named.request, shipped_catalog());
  EXPECT_EQ(canonical_json(request), named.request) << "it is canonical";
  EXPECT_EQ(std::get<std::string>(request.material.absorber), "amber");
  EXPECT_EQ(std::get<CubePoint>(request.material.point).roughness, 0.3);
}

TEST(Redevelop, GivesTheMaterialThatItsRequestDescribes) {
  for (const std::string& material :
       {inside,
        std::string(R"({"coefficients":{"sigma_a":[0.1,0.4,0.2],"alpha":0.1,"sigma_s":2}})"),
        std::string(R"({"coefficients":{"sigma_a_peak":0.3,"alpha":0,"sigma_s":2}})")})
    for (const Redevelopment& asked :
         {Redevelopment{0.8, {}}, Redevelopment{{}, "amber"}, Redevelopment{0.2, "amber"},
          Redevelopment{1.0, "amber"}, Redevelopment{0.0, {}}}) {
      const Redeveloped made = redeveloped(material, asked);
      const auto request = *parse_render_request(made.request, shipped_catalog());
      const Material described = scene_spec(request, shipped_catalog()).material;
      EXPECT_EQ(described.coefficients.sigma_a_peak, made.absorption.sigma_a_peak) << made.request;
      EXPECT_EQ(described.absorber, made.absorption.absorber) << made.request;
      EXPECT_NEAR(
          described.coefficients.sigma_s,
          parse_render_request(canonical(material), shipped_catalog())->material.point.index() == 0
              ? described.coefficients.sigma_s
              : 2,
          1e-12);
    }
}

TEST(Redevelop, KeepsTheColourOfCoefficientsOfEachChannel) {
  const Redeveloped made = redeveloped(
      R"({"coefficients":{"sigma_a":[0.1,0.4,0.2],"alpha":0.1,"sigma_s":2}})", {0.5, {}});
  const auto& rgb = std::get<RgbAbsorber>(made.absorption.absorber).relative;
  EXPECT_THAT(rgb, ElementsAre(0.25, 1, 0.5));
}

TEST(Redevelop, TakesAnAbsorberThatHasNoName) {
  const Redeveloped rgb = redeveloped(inside, {0.5, R"({"rgb":[0.2,1,1]})"});
  EXPECT_THAT(std::get<RgbAbsorber>(rgb.absorption.absorber).relative, ElementsAre(0.2, 1, 1));
  EXPECT_EQ(json::parse(rgb.request)["material"]["absorber"]["rgb"], json({0.2, 1, 1}));
  const Redeveloped own =
      redeveloped(inside, {{}, R"({"wavelengths_nm":[400,700],"values":[1,0]})"});
  EXPECT_THAT(std::get<SpectralAbsorber>(own.absorption.absorber).values, ElementsAre(1, 0));
  const auto refused = [](const std::string& absorber) {
    return fault_pointers(redevelop(canonical(inside), {{}, absorber}, shipped_catalog()));
  };
  EXPECT_THAT(refused(R"({"rgb":[0,0,0]})"), ElementsAre("?absorber/rgb"));
  EXPECT_THAT(refused("{"), ElementsAre("?absorber"));
  EXPECT_THAT(refused(R"({"rgb":[1,1,1],"rgb":[1,1,1]})"), ElementsAre("?absorber"));
}

TEST(Redevelop, OtherSamplesAreAnotherQuality) {
  const std::string request = with_samples(canonical(inside), 12);
  EXPECT_EQ(json::parse(request)["quality"], (json{{"samples", 12}}));
  const auto parsed = parse_render_request(request, shipped_catalog());
  EXPECT_EQ(canonical_json(*parsed), request);
}

TEST(Redevelop, RefusesWhatItDoesNotKnow) {
  const std::string request = canonical(inside);
  EXPECT_THAT(fault_pointers(redevelop(request, {1.5, "nothing"}, shipped_catalog())),
              ElementsAre("?absorber", "?absorption"));
  EXPECT_THAT(fault_pointers(redevelop(request, {std::nan(""), {}}, shipped_catalog())),
              ElementsAre("?absorption"));
}

TEST(Redevelop, RefusesARenderWithoutPathLengthsNamingTheParameters) {
  const auto result = redevelop(canonical(inside, false), {0.5, "amber"}, shipped_catalog());
  EXPECT_EQ(result.problem().code, ProblemCode::conflict);
  EXPECT_THAT(fault_pointers(result), ElementsAre("?absorption", "?absorber"));
}

TEST(Redevelop, ReadsAbsorptionAsAWholeNumberText) {
  EXPECT_EQ(absorption_number("0.25"), 0.25);
  EXPECT_EQ(absorption_number("1"), 1.0);
  EXPECT_FALSE(std::signbit(*absorption_number("-0")));
  for (const char* text :
       {"", " 0.5", "0.5 ", "nan", "inf", "-0.1", "1.0001", "0,5", "+0.5", "1e9"})
    EXPECT_EQ(absorption_number(text), std::nullopt) << text;
}

}  // namespace
}  // namespace translucube::api

#include <algorithm>

#include "tests/api/fixture.h"

namespace translucube::api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

std::string coefficients(const std::string& members, const std::string& beside = "") {
  return R"({"material":{"coefficients":{)" + members + "}" + beside + "}}";
}

TEST(MaterialRequest, ShortestRequestGetsEveryDefault) {
  const RenderRequest request = accepted(R"({"material":{"cube":)" + some_cube + "}}");
  EXPECT_EQ(std::get<CubePoint>(request.material.point), (CubePoint{0.3, 0.3, 0.5}));
  RenderRequest defaults = shipped_catalog().defaults;
  defaults.material.point = request.material.point;
  EXPECT_EQ(request, defaults);
}

TEST(MaterialRequest, CornersOfTheCubeAreInIt) {
  for (const char* point : {R"({"absorption":0,"roughness":0,"scattering":0})",
                            R"({"absorption":1,"roughness":1.0,"scattering":1e0})"})
    accepted(R"({"material":{"cube":)" + std::string(point) + "}}");
}

TEST(MaterialRequest, CubeTellsAllItsFaultsAtOnce) {
  EXPECT_THAT(
      pointers(
          R"({"material":{"cube":{"absorption":1.5,"roughness":"x","density":1},"ior":5,"x":0}})"),
      UnorderedElementsAre("/material/cube/absorption", "/material/cube/roughness",
                           "/material/cube/scattering", "/material/cube/density", "/material/ior",
                           "/material/x"));
}

TEST(MaterialRequest, DetailsSayWhatIsRight) {
  EXPECT_EQ(fault_at("/material/ior", material_with(R"("ior":5)")), "must be a number in [1, 4]");
  EXPECT_EQ(fault_at("/material/anisotropy", material_with(R"("anisotropy":1)")),
            "must be a number in (-1, 1)");
  EXPECT_EQ(
      fault_at("/material/reference_thickness_mm", material_with(R"("reference_thickness_mm":0)")),
      "must be a number in [1e-06, 1e+06]");
  EXPECT_THAT(fault_at("/material/absorber", material_with(R"("absorber":"x")")),
              HasSubstr("amber, blood, "));
  EXPECT_EQ(
      fault_at("/material/iro", material_with(R"("iro":1.5)")),
      "unknown key; known here: absorber, anisotropy, coefficients, cube, ior, oil_film, pigment, "
      "reference_thickness_mm");
}

TEST(MaterialRequest, ExactlyOneOfCubeAndCoefficients) {
  const std::string both = R"({"material":{"cube":)" + some_cube +
                           R"(,"coefficients":{"sigma_a_peak":1,"alpha":0,"sigma_s":1}}})";
  EXPECT_EQ(fault_at("/material", both), "must have only one of cube, coefficients");
  EXPECT_EQ(fault_at("/material", R"({"material":{}})"), "must have one of cube, coefficients");
  EXPECT_EQ(fault_at("/material", "{}"), "is required");
}

TEST(MaterialRequest, CoefficientsOfAnAbsorbersPeak) {
  const auto material = accepted(coefficients(R"("sigma_a_peak":0.5,"alpha":0.1,"sigma_s":5)",
                                              R"(,"absorber":"tea")"))
                            .material;
  EXPECT_EQ(std::get<CoefficientsRequest>(material.point), (CoefficientsRequest{0.5, 0.1, 5}));
  EXPECT_EQ(std::get<std::string>(material.absorber), "tea");
}

TEST(MaterialRequest, CoefficientsOfEachChannelHaveNoAbsorber) {
  const std::string members = R"("sigma_a":[0,0.5,2],"alpha":0.1,"sigma_s":5)";
  const auto material = accepted(coefficients(members)).material;
  const CoefficientsRequest expected{std::array<double, 3>{0, 0.5, 2}, 0.1, 5};
  EXPECT_EQ(std::get<CoefficientsRequest>(material.point), expected);
  fault_at("/material/absorber", coefficients(members, R"(,"absorber":"tea")"));
}

TEST(MaterialRequest, CoefficientsMayHoldAnisotropyAndIor) {
  const auto material =
      accepted(coefficients(R"("sigma_a_peak":0,"alpha":0,"sigma_s":5,"g":-0.5,"ior":1.33)"))
          .material;
  EXPECT_EQ(material.anisotropy, -0.5);
  EXPECT_EQ(material.ior, 1.33);
  EXPECT_THAT(pointers(coefficients(R"("sigma_a_peak":0,"alpha":0,"sigma_s":5,"g":0,"ior":1)",
                                    R"(,"anisotropy":0,"ior":1)")),
              UnorderedElementsAre("/material/coefficients/g", "/material/coefficients/ior"));
}

TEST(MaterialRequest, RgbAbsorberIsKeptAsGiven) {
  const auto material = accepted(material_with(R"("absorber":{"rgb":[0.3,2,2]})")).material;
  EXPECT_EQ(std::get<RgbAbsorber>(material.absorber), (RgbAbsorber{{0.3, 2, 2}}));
}

TEST(MaterialRequest, SpectrumIsKeptAsGiven) {
  const auto material =
      accepted(material_with(R"("absorber":{"wavelengths_nm":[400,500.5],"values":[0,7]})"))
          .material;
  EXPECT_EQ(std::get<SpectralAbsorber>(material.absorber),
            (SpectralAbsorber{{400, 500.5}, {0, 7}}));
}

TEST(MaterialRequest, SpectrumHasAtMost4096Samples) {
  std::string wavelengths, values;
  for (int i = 0; i < 4096; ++i) {
    wavelengths += (i ? "," : "") + std::to_string(300 + i);
    values += i ? ",1" : "1";
  }
  const auto absorber = [](const std::string& w, const std::string& v) {
    return material_with(R"("absorber":{"wavelengths_nm":[)" + w + R"(],"values":[)" + v + "]}");
  };
  accepted(absorber(wavelengths, values));
  EXPECT_THAT(pointers(absorber(wavelengths + ",5000", values + ",1")),
              ElementsAre("/material/absorber/wavelengths_nm", "/material/absorber/values"));
}

TEST(MaterialRequest, SpectrumTellsWhereItsWavelengthsStopRising) {
  const std::string text =
      material_with(R"("absorber":{"wavelengths_nm":[400,500,500],"values":[1,1,1]})");
  EXPECT_EQ(fault_at("/material/absorber/wavelengths_nm", text),
            "must rise strictly; it does not after index 1");
}

TEST(MaterialRequest, PigmentsTakeTheirAbsorptionFromTheScattering) {
  const auto material =
      accepted(material_with(R"("pigment":{"absorption_per_scattering":0.1})")).material;
  EXPECT_EQ(material.pigment_absorption_per_scattering, 0.1);
  EXPECT_FALSE(accepted(material_with(R"("pigment":false)"))
                   .material.pigment_absorption_per_scattering.has_value());
  const std::string coefficients =
      R"({"material":{"coefficients":{"alpha":0,"sigma_s":2,"sigma_a_peak":1},"pigment":{"absorption_per_scattering":0.1}}})";
  EXPECT_THAT(fault_at("/material/pigment", coefficients), HasSubstr("sigma_a_peak must be 0"));
}

TEST(MaterialRequest, MinusZeroIsZero) {
  const auto material = accepted(material_with(R"("anisotropy":-0.0)")).material;
  EXPECT_FALSE(std::signbit(material.anisotropy));
}

}  // namespace
}  // namespace translucube::api

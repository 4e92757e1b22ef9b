#include "api/request/scene_spec.h"
#include "tests/api/fixture.h"

namespace translucube::api {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::UnorderedElementsAre;

std::string image(const std::string& width, const std::string& height) {
  return request_with(R"("image":{"width":)" + width + R"(,"height":)" + height + "}");
}
std::string quality(const std::string& members) {
  return request_with(R"("quality":{)" + members + "}");
}

TEST(Request, WholeExampleOfTheDesignIsAccepted) {
  const RenderRequest request = accepted(R"({
    "material": {
      "cube": {"absorption": 0.3, "roughness": 0.3, "scattering": 0.5},
      "absorber": "red-glass",
      "ior": 1.5, "anisotropy": 0.0, "pigment": false, "reference_thickness_mm": 10
    },
    "scene": {
      "object": {"type": "sphere", "radius_mm": 20},
      "environment": {"image": "forest", "rotation_deg": 0, "scale": 1},
      "camera": {"position_mm": [0, 0, 90], "target_mm": [0, 0, 0], "up": [0, 1, 0], "vfov_deg": 32}
    },
    "image": {"width": 512, "height": 512},
    "quality": {"relative_error": 0.02},
    "model": "transport",
    "seed": 1
  })");
  // The example says what the defaults are.
  EXPECT_EQ(request, accepted(R"({"material":{"cube":)" + some_cube + "}}"));
}

TEST(Request, TellsTheFaultsOfAllItsParts) {
  EXPECT_THAT(pointers(R"({"material":{"cube":{"absorption":2,"roughness":0,"scattering":0}},)"
                       R"("scene":{"object":{"radius_mm":-1}},"image":{"width":2.7,"height":0},)"
                       R"("quality":{"samples":1,"seconds":1},"model":"path","explorable":1,)"
                       R"("seed":-1,"sed":1,"sed":2,"x":1e999})"),
              UnorderedElementsAre("/material/cube/absorption", "/scene/object/radius_mm",
                                   "/image/width", "/image/height", "/quality", "/model",
                                   "/explorable", "/seed", "/sed", "/sed", "/x", "/x"));
}

TEST(Request, NumberThatIsTooLargeIsOneFaultOfItsField) {
  EXPECT_THAT(pointers(image("1e999", "64")), ElementsAre("/image/width"));
  EXPECT_THAT(pointers(material_with(R"("ior":1e999)")), ElementsAre("/material/ior"));
}

TEST(Request, ImageHasAtMostTheLimitOfPixels) {
  EXPECT_EQ(accepted(image("4096", "4096")).width, 4096);
  EXPECT_EQ(accepted(image("1", "16777216")).height, 16777216);
  EXPECT_EQ(fault_at("/image", image("4096", "4097")), "width x height must be at most 16777216");
  fault_at("/image", image("100000", "100000"));
  fault_at("/image", image("65536", "65536"));  // 2^32: no pixels at all in 32 bits
  // The other side keeps its default.
  fault_at("/image", request_with(R"("image":{"width":100000})"));
}

TEST(Request, WidthsThatWouldWrapAreRefused) {
  for (const char* width :
       {"4294967297", "18446744073709551617", "-4294967295", "9223372036854775807"})
    EXPECT_EQ(fault_at("/image/width", image(width, "1")), "must be an integer from 1 to 16777216");
}

TEST(Request, IntegersAreNumbersWithoutAFraction) {
  for (const char* width : {"100", "100.0", "1e2", "0.1e3", "10000e-2"})
    EXPECT_EQ(accepted(image(width, "1")).width, 100) << width;
  for (const char* width :
       {"2.7", "1e300", "-512.0", "100.00001", "5e-1", "\"512\"", "true", "null", "[512]"})
    fault_at("/image/width", image(width, "1"));
}

TEST(Request, QualityIsOneOfThree) {
  EXPECT_EQ(accepted(quality(R"("samples":64)")).quality, Quality(SampleTarget{64}));
  EXPECT_EQ(accepted(quality(R"("relative_error":1)")).quality, Quality(ErrorTarget{1}));
  EXPECT_EQ(accepted(quality(R"("seconds":3600)")).quality, Quality(TimeTarget{3600}));
  fault_at("/quality", quality(""));
  fault_at("/quality", quality(R"("samples":1,"relative_error":0.1)"));
  fault_at("/quality", quality(R"("samples":1,"relative_error":0.1,"seconds":1)"));
}

TEST(Request, QualityHasLimits) {
  EXPECT_EQ(accepted(quality(R"("samples":1048576)")).quality, Quality(SampleTarget{1048576}));
  fault_at("/quality/samples", quality(R"("samples":1048577)"));
  fault_at("/quality/samples", quality(R"("samples":0)"));
  fault_at("/quality/relative_error", quality(R"("relative_error":0)"));
  fault_at("/quality/relative_error", quality(R"("relative_error":1.001)"));
  fault_at("/quality/seconds", quality(R"("seconds":0)"));
  fault_at("/quality/seconds", quality(R"("seconds":3600.1)"));
}

TEST(Request, LimitsAreTheCatalogs) {
  Catalog catalog = shipped_catalog();
  catalog.limits = {.body_bytes = 200, .pixels = 100, .samples = 7, .seconds = 2};
  fault_at("/image", image("11", "10"), catalog);
  fault_at("/quality/samples", quality(R"("samples":8)"), catalog);
  fault_at("/quality/seconds", quality(R"("seconds":2.5)"), catalog);
  const std::string padded = image("10", "10") + std::string(200, ' ');
  const auto result = parse_render_request(padded, catalog);
  EXPECT_EQ(result.problem().code, ProblemCode::payload_too_large);
}

TEST(Request, SeedsAreExactInEveryJsonReader) {
  EXPECT_EQ(accepted(request_with(R"("seed":0)")).seed, 0u);
  EXPECT_EQ(accepted(request_with(R"("seed":-0)")).seed, 0u);
  EXPECT_EQ(accepted(request_with(R"("seed":9007199254740991)")).seed, 9007199254740991u);
  fault_at("/seed", request_with(R"("seed":9007199254740992)"));
  fault_at("/seed", request_with(R"("seed":-1)"));
  EXPECT_EQ(accepted(request_with(R"("seed":1.0)")).seed, 1u);
  EXPECT_EQ(accepted(request_with(R"("seed":9.007199254740991e15)")).seed, 9007199254740991u);
  for (const char* seed : {"1.5", "-1.0", "9007199254740992.0", "1e16", "1.8446744073709552e19"})
    fault_at("/seed", request_with(R"("seed":)" + std::string(seed)));
}

TEST(Request, PartsThatAreNotServedYetAreReadFirst) {
  EXPECT_EQ(fault_at("/model", request_with(R"("model":"path")")), "must be transport or dipole");
  accepted(request_with(R"("model":"transport","explorable":false)"));
}

TEST(Request, TheDipoleModelSaysWhatItCannotServe) {
  const auto with_g = [](const std::string& g, const std::string& model) {
    return R"({"model":")" + model + R"(","material":{"anisotropy":)" + g + R"(,"cube":)" +
           some_cube + "}}";
  };
  EXPECT_EQ(accepted(request_with(R"("model":"dipole")")).model, Model::dipole);
  accepted(with_g("0.9", "dipole"));
  accepted(with_g("0.95", "transport"));
  EXPECT_THAT(fault_at("/material/anisotropy", with_g("0.95", "dipole")), HasSubstr("similarity"));
  fault_at("/material/anisotropy", with_g("-0.91", "dipole"));
  EXPECT_THAT(fault_at("/material/coefficients/g",
                       R"({"model":"dipole","material":{"coefficients":
                           {"sigma_a_peak":0,"alpha":0,"sigma_s":1,"g":0.99}}})"),
              HasSubstr("similarity"));
  EXPECT_THAT(pointers(R"({"model":"dipole","material":{"pigment":{"absorption_per_scattering":1},
                            "cube":{"absorption":0,"roughness":0,"scattering":1}}})"),
              testing::Contains("/material/cube/scattering"));
  EXPECT_THAT(pointers(request_with(R"("model":"dipole","explorable":true)")),
              testing::Contains("/explorable"));
}

TEST(Request, TheDipoleModelWeighsByTheScatteringCoordinate) {
  const auto opacity = [](const std::string& text) {
    const SceneSpec spec = scene_spec(accepted(text), shipped_catalog());
    return std::get<DipoleModel>(spec.model).opacity;
  };
  EXPECT_EQ(opacity(request_with(R"("model":"dipole")")), 0.5);
  EXPECT_NEAR(opacity(R"({"model":"dipole","material":{"reference_thickness_mm":5,"anisotropy":0.5,
                          "coefficients":{"sigma_a_peak":0,"alpha":0,"sigma_s":1.6}}})"),
              3.0 / (1 + 3.0), 1e-12);
  const SceneSpec exact = scene_spec(accepted(request_with(R"("seed":1)")), shipped_catalog());
  EXPECT_TRUE(std::holds_alternative<ExactTransport>(exact.model));
}

TEST(Request, ExplorableRendersAreServedWithinTheirShareOfThePixels) {
  EXPECT_TRUE(accepted(request_with(R"("explorable":true)")).explorable);
  const auto image = [](const std::string& width) {
    return request_with(R"("explorable":true,"image":{"height":1024,"width":)" + width + "}");
  };
  accepted(image("1024"));
  EXPECT_THAT(fault_at("/image", image("1025")), HasSubstr("explorable"));
}

}  // namespace
}  // namespace translucube::api

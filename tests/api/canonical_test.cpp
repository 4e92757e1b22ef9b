#include "api/request/canonical.h"

#include <nlohmann/json.hpp>
#include <random>

#include "tests/api/fixture.h"

namespace translucube::api {
namespace {

/// Random requests that use every form of every part that this version serves.
class RequestGenerator {
 public:
  explicit RequestGenerator(std::uint64_t seed) : random_(seed) {}

  RenderRequest next() {
    RenderRequest request = shipped_catalog().defaults;
    request.material = material();
    request.object = object();
    if (coin()) request.backdrop = backdrop();
    request.environment = {environment_source(), uniform(-1e4, 1e4), coin() ? 0 : magnitude(-9, 9)};
    if (coin())
      request.camera = {{uniform(-90, 90), uniform(-90, 90), uniform(50, 90)},
                        {uniform(-9, 9), uniform(-9, 9), uniform(-9, 9)},
                        {uniform(-0.1, 0.1), 1, 0.25},
                        uniform(1e-6, 179.9)};
    request.width = 1 + static_cast<int>(random_() % 4096);
    request.height = 1 + static_cast<int>(random_() % 4096);
    request.quality = quality();
    request.seed = random_() >> 11;
    return request;
  }

 private:
  bool coin() { return (random_() & 1) != 0; }
  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double magnitude(double low, double high) {
    return std::pow(10, uniform(low + 1e-3, high - 1e-3));
  }
  double unit() { return random_() % 8 == 0 ? 0 : random_() % 8 == 0 ? 1 : uniform(0, 1); }

  ObjectRequest object() {
    switch (random_() % 6) {
      case 0:
        return SphereObject{magnitude(-6, 9)};
      case 1:
        return PlateObject{uniform(1, 9), uniform(1, 9), magnitude(-5, 3)};
      case 2:
        return BoxObject{uniform(1, 9), uniform(1, 9), uniform(1, 9)};
      case 3:
        return WedgeObject{uniform(1, 9), uniform(1, 9), unit(), uniform(1, 9)};
      case 4:
        return BowlObject{uniform(10, 90), uniform(1, 9)};
      default:
        return shipped_catalog().defaults.object;
    }
  }

  BackdropSpec backdrop() {
    return {static_cast<BackdropKind>(random_() % 2),
            static_cast<Pattern>(random_() % 4),
            coin() ? 0 : magnitude(-9, 9),
            magnitude(-6, 9),
            unit(),
            unit()};
  }

  MaterialRequest material() {
    MaterialRequest material = shipped_catalog().defaults.material;
    if (coin()) material.oil_film = OilFilmRequest{{uniform(-9, 9), unit(), 1}, uniform(-1e4, 1e4)};
    material.ior = uniform(1, 4);
    material.anisotropy = uniform(-0.999, 0.999);
    material.reference_thickness_mm = magnitude(-6, 6);
    material.absorber = absorber();
    switch (random_() % 3) {
      case 0:
        material.point = CubePoint{unit(), unit(), unit()};
        break;
      case 1:
        material.point = CoefficientsRequest{magnitude(-300, 18), unit(), magnitude(-300, 18)};
        break;
      default:
        material.point =
            CoefficientsRequest{std::array{magnitude(-9, 9), unit(), 0.0}, unit(), unit()};
        material.absorber = shipped_catalog().defaults.material.absorber;
    }
    return material;
  }

  AbsorberRequest absorber() {
    switch (random_() % 3) {
      case 0:
        return "cobalt-blue";
      case 1:
        return RgbAbsorber{{magnitude(-300, 300), unit(), unit()}};
      default: {
        SpectralAbsorber spectrum;
        const std::size_t size = 2 + random_() % 50;
        for (std::size_t i = 0; i < size; ++i) {
          spectrum.wavelengths_nm.push_back(300 + 10 * static_cast<double>(i) + unit());
          spectrum.values.push_back(unit());
        }
        spectrum.values[0] = 0.5;
        return spectrum;
      }
    }
  }

  decltype(EnvironmentRequest::source) environment_source() {
    if (coin()) return NamedEnvironment{coin() ? "forest" : "sunrise"};
    return ConstantEnvironment{{magnitude(-9, 9), unit(), unit()}};
  }

  Quality quality() {
    switch (random_() % 3) {
      case 0:
        return SampleTarget{static_cast<std::uint32_t>(1 + random_() % 50000)};
      case 1:
        return ErrorTarget{uniform(1e-6, 1)};
      default:
        return TimeTarget{magnitude(-6, 3.5)};
    }
  }

  std::mt19937_64 random_;
};

TEST(CanonicalRequest, ParsesBackToTheSameRequest) {
  RequestGenerator generator(2);
  for (int i = 0; i < 2000; ++i) {
    const RenderRequest request = generator.next();
    const std::string text = canonical_json(request);
    const auto back = parse_render_request(text, shipped_catalog());
    ASSERT_TRUE(back) << text << '\n' << to_text(back.problem());
    ASSERT_EQ(*back, request) << text;
    ASSERT_EQ(canonical_json(*back), text);
  }
}

TEST(CanonicalRequest, DifferentRequestsHaveDifferentTexts) {
  RequestGenerator generator(3);
  for (int i = 0; i < 200; ++i) {
    const RenderRequest a = generator.next(), b = generator.next();
    ASSERT_FALSE(a == b);
    EXPECT_NE(canonical_json(a), canonical_json(b));
  }
}

TEST(CanonicalRequest, ParsesBackWithoutTheDefaultsItWasMadeWith) {
  // A stored request must not change its meaning with the configuration.
  Catalog other = shipped_catalog();
  other.defaults.material.ior = 1.33;
  other.defaults.camera.vfov_deg = 60;
  other.defaults.width = 64;
  other.defaults.seed = 99;
  other.defaults.quality = SampleTarget{4};
  other.defaults.environment = {ConstantEnvironment{}, 45, 2};
  other.defaults.object = SphereObject{3};
  other.defaults.backdrop = BackdropSpec{BackdropKind::print, Pattern::grid, 1, 2, 0.5, 0.25};
  other.defaults.material.oil_film = OilFilmRequest{{0, 1, 0}, 3};
  RequestGenerator generator(4);
  for (int i = 0; i < 200; ++i) {
    const std::string text = canonical_json(generator.next());
    ASSERT_EQ(canonical_json(accepted(text, other)), text);
  }
}

TEST(CanonicalRequest, IsTheSameForEveryWayToSayIt) {
  const std::string expected = canonical_json(
      accepted(R"({"material":{"cube":{"absorption":0,"roughness":1,"scattering":0.5}}})"));
  for (
      const char* text :
      {R"({"material":{"cube":{"scattering":0.5,"roughness":1.0,"absorption":-0.0}}})",
       R"({ "seed" : 1, "material": {"cube":{"absorption":0e5,"roughness":10e-1,"scattering":5e-1},)"
       R"("ior":1.50,"anisotropy":-0}})",
       R"({"material":{"cube":{"absorption":0,"rough\u006eess":1,"scattering":0.5}},)"
       R"("scene":{"camera":{"up":[0,1.0,-0.0]}}})"})
    EXPECT_EQ(canonical_json(accepted(text)), expected);
}

TEST(CanonicalRequest, CoefficientsHaveOnePlaceForAnisotropyAndIor) {
  EXPECT_EQ(
      canonical_json(accepted(
          R"({"material":{"coefficients":{"sigma_a_peak":1,"alpha":0,"sigma_s":1,"g":0.5,"ior":2}}})")),
      canonical_json(
          accepted(R"({"material":{"coefficients":{"sigma_a_peak":1,"alpha":0,"sigma_s":1},)"
                   R"("anisotropy":0.5,"ior":2}})")));
}

TEST(CanonicalRequest, FillsInEveryDefaultWithSortedKeys) {
  EXPECT_EQ(
      canonical_json(accepted(R"({"material":{"cube":)" + some_cube + "}}")),
      R"({"explorable":false,"image":{"height":512,"width":512},)"
      R"("material":{"absorber":"red-glass","anisotropy":0.0,)"
      R"("cube":{"absorption":0.3,"roughness":0.3,"scattering":0.5},)"
      R"("ior":1.5,"oil_film":false,"pigment":false,"reference_thickness_mm":10.0},)"
      R"("model":"transport","quality":{"relative_error":0.02},)"
      R"("scene":{"backdrop":false,"camera":{"position_mm":[0.0,0.0,90.0],"target_mm":[0.0,0.0,0.0],)"
      R"("up":[0.0,1.0,0.0],"vfov_deg":32.0},)"
      R"("environment":{"image":"forest","rotation_deg":0.0,"scale":1.0},)"
      R"("object":{"radius_mm":20.0,"type":"sphere"}},"seed":1})");
}

TEST(CanonicalRequest, KeepsTheFormInWhichTheMaterialWasGiven) {
  const auto document = nlohmann::json::parse(canonical_json(
      accepted(R"({"material":{"coefficients":{"sigma_a":[0,1,2],"alpha":0.5,"sigma_s":3}}})")));
  EXPECT_EQ(document["material"]["coefficients"],
            nlohmann::json::parse(R"({"sigma_a":[0.0,1.0,2.0],"alpha":0.5,"sigma_s":3.0})"));
  EXPECT_FALSE(document["material"].contains("cube"));
  EXPECT_FALSE(document["material"].contains("absorber"));
}

}  // namespace
}  // namespace translucube::api

// Colour management against the standards' own formulas: every matrix here is computed from
// primaries and whites, independently of config/display.ocio.

#include "picture/color.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <vector>

#include "tests/support/repository.h"

namespace translucube {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Vector = std::array<double, 3>;
using Matrix = std::array<Vector, 3>;
using Xy = std::array<double, 2>;

constexpr Xy d65 = {0.3127, 0.3290}, aces_white = {0.32168, 0.33767};
constexpr std::array<Xy, 3> rec709 = {{{0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}}};
constexpr std::array<Xy, 3> p3 = {{{0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}}};
constexpr std::array<Xy, 3> rec2020 = {{{0.708, 0.292}, {0.170, 0.797}, {0.131, 0.046}}};
constexpr std::array<Xy, 3> ap1 = {{{0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}}};

Matrix multiply(const Matrix& a, const Matrix& b) {
  Matrix result{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k) result[i][j] += a[i][k] * b[k][j];
  return result;
}

Vector multiply(const Matrix& m, const Vector& v) {
  Vector result{};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) result[i] += m[i][k] * v[k];
  return result;
}

/// By Gauss-Jordan elimination with pivoting.
Matrix inverse(Matrix m) {
  Matrix result = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  for (int column = 0; column < 3; ++column) {
    int pivot = column;
    for (int row = column; row < 3; ++row)
      if (std::abs(m[row][column]) > std::abs(m[pivot][column])) pivot = row;
    std::swap(m[column], m[pivot]);
    std::swap(result[column], result[pivot]);
    const double scale = 1 / m[column][column];
    for (int j = 0; j < 3; ++j) m[column][j] *= scale, result[column][j] *= scale;
    for (int row = 0; row < 3; ++row) {
      const double factor = m[row][column];
      for (int j = 0; row != column && j < 3; ++j) {
        m[row][j] -= factor * m[column][j];
        result[row][j] -= factor * result[column][j];
      }
    }
  }
  return result;
}

Vector xyz_of(const Xy& xy) { return {xy[0] / xy[1], 1, (1 - xy[0] - xy[1]) / xy[1]}; }

/// RGB to XYZ of a space with these primaries and this white (SMPTE RP 177).
Matrix to_xyz(const std::array<Xy, 3>& primaries, const Xy& white) {
  Matrix m{};
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 3; ++k) m[k][c] = xyz_of(primaries[c])[k];
  const Vector scale = multiply(inverse(m), xyz_of(white));
  for (int c = 0; c < 3; ++c)
    for (int k = 0; k < 3; ++k) m[k][c] *= scale[c];
  return m;
}

/// Bradford's adaptation of XYZ.
Matrix adapt(const Xy& from, const Xy& to) {
  const Matrix cone = {
      {{0.8951, 0.2664, -0.1614}, {-0.7502, 1.7135, 0.0367}, {0.0389, -0.0685, 1.0296}}};
  const Vector a = multiply(cone, xyz_of(from)), b = multiply(cone, xyz_of(to));
  const Matrix gain = {{{b[0] / a[0], 0, 0}, {0, b[1] / a[1], 0}, {0, 0, b[2] / a[2]}}};
  return multiply(inverse(cone), multiply(gain, cone));
}

double srgb(double v) {
  v = std::clamp(v, 0.0, 1.0);
  return v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
}
double gamma24(double v) { return std::pow(std::clamp(v, 0.0, 1.0), 1 / 2.4); }

/// The config that ships, whatever $OCIO says where the tests run.
class Color : public testing::Test {
 protected:
  Color() {
    if (const char* value = std::getenv("OCIO")) environment_ = value;
    ::unsetenv("OCIO");
  }
  ~Color() override {
    if (environment_.empty())
      ::unsetenv("OCIO");
    else
      ::setenv("OCIO", environment_.c_str(), 1);
  }

  const std::filesystem::path shipped_ = in_repository("config/display.ocio");

 private:
  std::string environment_;
};

Image pixel(const Vector& rgb) {
  Image image(1, 1);
  for (int c = 0; c < 3; ++c) image.pixels[c] = static_cast<float>(rgb[c]);
  return image;
}

Vector shown(const ColorConfig& config, const Vector& rgb, const char* display, const char* view) {
  Image image = pixel(rgb);
  config.apply_display(image, display, view);
  return {image.pixels[0], image.pixels[1], image.pixels[2]};
}

const Vector samples[] = {{1, 0, 0},          {0, 1, 0},       {0, 0, 1},     {1, 1, 1},
                          {0.18, 0.18, 0.18}, {0.5, 0.2, 0.9}, {0, 0, 0},     {-0.3, 0.1, 0.4},
                          {7, 0.5, 0.01},     {0.001, 0, 0},   {2, 0.7, 0.3}, {0.02, 0.4, 0.8}};

void expect_display(const ColorConfig& config, const char* display,
                    const std::array<Xy, 3>& primaries, double (*encode)(double),
                    double tolerance) {
  const Matrix m = multiply(inverse(to_xyz(primaries, d65)), to_xyz(rec709, d65));
  for (const Vector& rgb : samples) {
    const Vector linear = multiply(m, rgb), got = shown(config, rgb, display, "plain");
    for (int c = 0; c < 3; ++c) {
      // A curve that is vertical at 0 makes 1e-8 of float matrix into 5e-4: compare the light.
      const double expected = encode(linear[c]);
      const double slack = linear[c] < 1e-5 ? 1e-3 : tolerance;
      EXPECT_NEAR(got[c], expected, slack)
          << display << " of " << rgb[0] << ", " << rgb[1] << ", " << rgb[2] << " channel " << c;
    }
  }
}

TEST_F(Color, ShippedConfigHasItsDisplaysAndViewsInOrder) {
  const ColorConfig config(shipped_);
  std::vector<std::string> names;
  for (const Display& display : config.displays()) {
    names.push_back(display.name);
    EXPECT_THAT(display.views, ElementsAre("plain", "ACES SDR", "raw"));
  }
  EXPECT_THAT(names, ElementsAre("sRGB", "Display P3", "Rec.1886", "Rec.2020"));
}

TEST_F(Color, SrgbOfMiddleGreyIsThePublishedCodeValue) {
  const ColorConfig config(shipped_);
  for (const double code : shown(config, {0.18, 0.18, 0.18}, "sRGB", "plain"))
    EXPECT_NEAR(code, 0.46135612950044164, 1e-6);  // 1.055 * 0.18^(1/2.4) - 0.055
}

TEST_F(Color, PlainIsColorimetricOnEveryDisplay) {
  const ColorConfig config(shipped_);
  // OpenColorIO joins the two parts of the sRGB curve where their slopes meet: 1e-5 off below it.
  expect_display(config, "sRGB", rec709, srgb, 1.5e-5);
  expect_display(config, "Display P3", p3, srgb, 1.5e-5);
  expect_display(config, "Rec.1886", rec709, gamma24, 2e-6);
  expect_display(config, "Rec.2020", rec2020, gamma24, 2e-6);
}

TEST_F(Color, Rec1886HasGamma24) {
  const ColorConfig config(shipped_);
  EXPECT_NEAR(shown(config, {0.5, 0.5, 0.5}, "Rec.1886", "plain")[1], std::pow(0.5, 1 / 2.4), 1e-6);
}

TEST_F(Color, PlainClipsToTheDisplayAndKeepsWhite) {
  const ColorConfig config(shipped_);
  for (const Display& display : config.displays()) {
    for (const double code : shown(config, {1, 1, 1}, display.name.c_str(), "plain"))
      EXPECT_NEAR(code, 1, 1e-6);
    for (const double code : shown(config, {500, 800, 33664}, display.name.c_str(), "plain"))
      EXPECT_NEAR(code, 1, 1e-6);
    for (const double code : shown(config, {-5, -5, -5}, display.name.c_str(), "plain"))
      EXPECT_EQ(code, 0);
  }
}

TEST_F(Color, NonFiniteLightStillGivesCodeValues) {
  const ColorConfig config(shipped_);
  const double inf = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Display& display : config.displays())
    for (const char* view : {"plain", "ACES SDR"})
      for (const Vector& rgb : {Vector{inf, 1, 1}, Vector{nan, 1, 1}, Vector{-inf, inf, nan}})
        for (const double code : shown(config, rgb, display.name.c_str(), view)) {
          EXPECT_GE(code, 0) << display.name << "/" << view;
          EXPECT_LE(code, 1) << display.name << "/" << view;
        }
}

TEST_F(Color, AcesSdrMapsMiddleGreyToTenPercentOfWhite) {
  // ACES 1.0: 18 % grey is shown at 4.8 of 48 cd/m2 in a dark room; the dim-surround video
  // transform raises it by the exponent 0.9811 (10.4 %), an sRGB code value near 0.356.
  const ColorConfig config(shipped_);
  const Vector grey = shown(config, {0.18, 0.18, 0.18}, "sRGB", "ACES SDR");
  EXPECT_NEAR(grey[0], srgb(std::pow(0.1, 0.9811)), 2e-3);
  EXPECT_NEAR(grey[0], grey[1], 1e-4);
  EXPECT_NEAR(grey[1], grey[2], 1e-4);
}

TEST_F(Color, AcesSdrRisesFromBlackToWhiteWithoutAStep) {
  const ColorConfig config(shipped_);
  for (const Display& display : config.displays()) {
    const char* const name = display.name.c_str();
    EXPECT_NEAR(shown(config, {0, 0, 0}, name, "ACES SDR")[1], 0, 1e-3);
    double last = 0;
    for (double v = 1e-4; v < 1e3; v *= 1.1) {
      const double code = shown(config, {v, v, v}, name, "ACES SDR")[1];
      EXPECT_GE(code, last) << name << " at " << v;
      EXPECT_LE(code, 1) << name << " at " << v;
      EXPECT_LT(code - last, 0.03) << name << " at " << v;
      last = code;
    }
    EXPECT_NEAR(last, 1, 1e-3) << name;
  }
}

TEST_F(Color, RawLeavesTheNumbers) {
  const ColorConfig config(shipped_);
  for (const Display& display : config.displays()) {
    Image image = pixel({-3.5, 0.18, 33664});
    const std::vector<float> before = image.pixels;
    config.apply_display(image, display.name, "raw");
    EXPECT_EQ(image.pixels, before) << display.name;
  }
}

TEST_F(Color, SceneSpacesAreThoseOfTheirStandards) {
  const ColorConfig config(shipped_);
  const Matrix xyz = to_xyz(rec709, d65);
  const Matrix acescg =
      multiply(inverse(multiply(adapt(aces_white, d65), to_xyz(ap1, aces_white))), xyz);
  const Matrix identity = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  const std::pair<const char*, Matrix> spaces[] = {
      {"lin_rec709", identity}, {"ACEScg", acescg}, {"XYZ", xyz}};
  for (const auto& [space, m] : spaces)
    for (const Vector& rgb : samples) {
      Image image = pixel(rgb);
      config.apply_colorspace(image, space);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(image.pixels[c], multiply(m, rgb)[c], 1e-6 * std::abs(rgb[0]) + 3e-7) << space;
    }
}

TEST_F(Color, SceneSpacesDoNotClip) {
  const ColorConfig config(shipped_);
  Image image = pixel({33664, -2, 0.5});
  config.apply_colorspace(image, "ACEScg");
  EXPECT_GT(image.pixels[0], 20000);
  image = pixel({33664, -2, 0.5});
  config.apply_colorspace(image, "lin_rec709");
  EXPECT_THAT(image.pixels, ElementsAre(33664, -2, 0.5));
}

template <typename Call>
std::string error_of(Call call) {
  try {
    call();
  } catch (const ColorError& error) {
    return error.what();
  }
  return "";
}

TEST_F(Color, UnknownNamesAreRefusedWithTheKnownOnes) {
  const ColorConfig config(shipped_);
  Image image = pixel({1, 1, 1});
  EXPECT_THAT(error_of([&] { config.apply_display(image, "CRT", "plain"); }),
              HasSubstr(R"(no display "CRT", only "sRGB", "Display P3", "Rec.1886", "Rec.2020")"));
  EXPECT_THAT(error_of([&] { config.apply_display(image, "sRGB", "film"); }),
              HasSubstr(R"(has no view "film", only "plain", "ACES SDR", "raw")"));
  EXPECT_THAT(error_of([&] { config.apply_colorspace(image, "sRGB"); }),
              HasSubstr(R"(no colour space "sRGB", only "lin_rec709", "ACEScg", "XYZ")"));
  EXPECT_THAT(image.pixels, ElementsAre(1, 1, 1));
}

class ColorEnvironment : public Color {
 protected:
  ColorEnvironment() {
    std::string pattern = (std::filesystem::temp_directory_path() / "color_XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~ColorEnvironment() override { std::filesystem::remove_all(folder_); }

  /// A config of version 2 with one display that shows the scene space `shown` as it is.
  void use_config(const std::string& roles, const std::string& spaces, const std::string& shown) {
    std::ofstream(folder_ / "other.ocio")
        << "ocio_profile_version: 2\nroles:\n  default: raw\n"
        << roles << "file_rules:\n  - !<Rule> {name: Default, colorspace: default}\n"
        << "displays:\n  Studio:\n    - !<View> {name: show, colorspace: " << shown << "}\n"
        << "colorspaces:\n  - !<ColorSpace>\n    name: raw\n    isdata: true\n"
        << spaces;
    ::setenv("OCIO", (folder_ / "other.ocio").c_str(), 1);
  }

  std::filesystem::path folder_;
};

TEST_F(ColorEnvironment, OcioVariableWinsOverTheShippedConfig) {
  use_config("",
             "  - !<ColorSpace>\n    name: lin_rec709\n  - !<ColorSpace>\n    name: ACEScg\n"
             "  - !<ColorSpace>\n    name: XYZ\n",
             "ACEScg");
  const ColorConfig config(shipped_);
  ASSERT_EQ(config.displays().size(), 1u);
  EXPECT_EQ(config.displays()[0].name, "Studio");
  EXPECT_THAT(config.displays()[0].views, ElementsAre("show"));
}

TEST_F(ColorEnvironment, EmptyOcioVariableIsNone) {
  ::setenv("OCIO", "", 1);
  EXPECT_EQ(ColorConfig(shipped_).displays().size(), 4u);
}

TEST_F(ColorEnvironment, SpacesThatAForeignConfigLacksAreReachedThroughAces) {
  // Only ACES2065-1 is there, as the interchange role: everything else is a known matrix away.
  use_config("  aces_interchange: AP0\n  cie_xyz_d65_interchange: raw\n",
             "  - !<ColorSpace>\n    name: AP0\n", "AP0");
  const ColorConfig foreign(shipped_);
  ::unsetenv("OCIO");
  const ColorConfig ours(shipped_);
  for (const char* space : {"lin_rec709", "ACEScg", "XYZ"})
    for (const Vector& rgb : samples) {
      Image a = pixel(rgb), b = pixel(rgb);
      foreign.apply_colorspace(a, space);
      ours.apply_colorspace(b, space);
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(a.pixels[c], b.pixels[c], 2e-6) << space;
    }
  // Shown in AP0, whose white is equal amounts.
  for (const double v : shown(foreign, {0.5, 0.5, 0.5}, "Studio", "show"))
    EXPECT_NEAR(v, 0.5, 1e-6);
  EXPECT_NEAR(shown(foreign, {1, 0, 0}, "Studio", "show")[0], 0.439632981919, 1e-6);
}

TEST_F(ColorEnvironment, ConfigThatLacksTheSceneSpacesIsRefusedByName) {
  use_config("", "  - !<ColorSpace>\n    name: ACEScg\n", "ACEScg");
  EXPECT_THAT(error_of([&] { ColorConfig config(shipped_); }),
              HasSubstr(R"(lacks the scene-linear colour space "lin_rec709", "XYZ")"));
}

TEST_F(ColorEnvironment, UnreadableConfigIsRefusedByName) {
  EXPECT_THAT(error_of([&] { ColorConfig config(folder_ / "none.ocio"); }), HasSubstr("none.ocio"));
  std::ofstream(folder_ / "bad.ocio") << "ocio_profile_version: [";
  EXPECT_THAT(error_of([&] { ColorConfig config(folder_ / "bad.ocio"); }), HasSubstr("bad.ocio"));
  ::setenv("OCIO", (folder_ / "gone.ocio").c_str(), 1);
  EXPECT_THAT(error_of([&] { ColorConfig config(shipped_); }), HasSubstr("gone.ocio"));
}

}  // namespace
}  // namespace translucube

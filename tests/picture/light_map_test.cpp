// Light means what its file says: every attribute that changes the meaning of pixels is honoured or
// refused by name, in every format. Right values by the formats' own documents.

#include "picture/light_map.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <numbers>
#include <vector>

#include "picture/image_io.h"
#include "picture/light/decode.h"
#include "picture/light/primaries.h"

namespace translucube::test {
namespace {

using testing::ElementsAre;
using testing::FloatNear;
using testing::HasSubstr;

namespace fs = std::filesystem;

Image light(const std::string& bytes) { return decode_light(bytes); }

std::string refusal(const std::string& bytes) {
  try {
    light(bytes);
  } catch (const ImageError& error) {
    return error.what();
  }
  return "taken";
}

void expect_pixel(const Image& image, int x, int y, std::array<double, 3> rgb,
                  double tolerance = 1e-5) {
  for (std::size_t c = 0; c < 3; ++c)
    EXPECT_NEAR(image.pixels[3 * (std::size_t(y) * image.width + x) + c], rgb[c], tolerance)
        << "channel " << c << " at " << x << " " << y;
}

double srgb(double code) {
  return code <= 0.04045 ? code / 12.92 : std::pow((code + 0.055) / 1.055, 2.4);
}

// ---- Radiance

/// 2 x 3 pixels that are all different: red tells the column, green the row.
std::string hdr(const std::string& header, const std::string& resolution,
                const std::vector<std::array<int, 4>>& pixels) {
  std::string text = "#?RADIANCE\n" + header + "\n" + resolution + "\n";
  for (const auto& p : pixels)
    for (const int b : p) text.push_back(static_cast<char>(b));
  return text;
}
const std::string rgbe = "FORMAT=32-bit_rle_rgbe\n";

TEST(RadianceLight, IsUprightWhateverTheOrderOfItsPixels) {
  // The picture as it is seen, top row first: pixel (x, y) is (64 (x + 1), 64 (y + 1), 0) / 256.
  constexpr int width = 3, height = 2;
  const auto seen = [](int x, int y) {
    return std::array<int, 4>{64 * (x + 1), 64 * (y + 1), 0, 128};
  };
  for (const bool rows : {true, false})
    for (const bool top : {true, false})
      for (const bool left : {true, false}) {
        const std::string y_axis = std::string(top ? "-" : "+") + "Y " + std::to_string(height),
                          x_axis = std::string(left ? "+" : "-") + "X " + std::to_string(width);
        const std::string resolution = rows ? y_axis + " " + x_axis : x_axis + " " + y_axis;
        std::vector<std::array<int, 4>> stored;
        const auto add = [&](int i, int j) {
          stored.push_back(seen(left ? i : width - 1 - i, top ? j : height - 1 - j));
        };
        if (rows)
          for (int j = 0; j < height; ++j)
            for (int i = 0; i < width; ++i) add(i, j);
        else
          for (int i = 0; i < width; ++i)
            for (int j = 0; j < height; ++j) add(i, j);
        const Image image = light(hdr(rgbe, resolution, stored));
        SCOPED_TRACE(resolution);
        ASSERT_EQ(image.width, width);
        ASSERT_EQ(image.height, height);
        for (int y = 0; y < height; ++y)
          for (int x = 0; x < width; ++x)
            expect_pixel(image, x, y, {.25 * (x + 1), .25 * (y + 1), 0});
      }
}

const std::vector<std::array<int, 4>> grey_half{{128, 128, 128, 128}};  // .5

Image one_pixel(const std::string& header) {
  return light(hdr(rgbe + header, "-Y 1 +X 1", grey_half));
}

TEST(RadianceLight, HasItsExposureUndone) {
  expect_pixel(one_pixel(""), 0, 0, {.5, .5, .5});
  expect_pixel(one_pixel("EXPOSURE=2\n"), 0, 0, {.25, .25, .25});
  expect_pixel(one_pixel("EXPOSURE= 2.0\nEXPOSURE=.5e1\n"), 0, 0, {.05, .05, .05});
  expect_pixel(one_pixel("COLORCORR=2 1 .5\n"), 0, 0, {.25, .5, 1});
  expect_pixel(one_pixel("EXPOSURE=2\nCOLORCORR= 2 1 1\nCOLORCORR=1 1 4\n"), 0, 0,
               {.125, .25, .0625});
  expect_pixel(one_pixel("GAMMA=2.2\n"), 0, 0,
               {std::pow(.5, 2.2), std::pow(.5, 2.2), std::pow(.5, 2.2)});
  expect_pixel(one_pixel("SOFTWARE=x=y\n# EXPOSURE=2\nVIEW= -vtv\n"), 0, 0, {.5, .5, .5});
}

TEST(RadianceLight, HasItsPrimariesHonoured) {
  const double x = .5 / .95047 * .95047;  // grey stays grey: white goes to white
  expect_pixel(one_pixel("PRIMARIES= .68 .32 .265 .69 .15 .06 .3127 .329\n"), 0, 0, {x, x, x});
  const std::string xyz = "#?RADIANCE\nFORMAT=32-bit_rle_xyze\n\n-Y 1 +X 1\n";
  // (.5, .5, .5) in XYZ: by the matrix of IEC 61966-2-1.
  expect_pixel(light(xyz + "\x80\x80\x80\x80"), 0, 0,
               {.5 * (3.2404542 - 1.5371385 - .4985314), .5 * (-.9692660 + 1.8760108 + .0415560),
                .5 * (.0556434 - .2040259 + 1.0572252)},
               3e-4);
}

TEST(RadianceLight, IsReadInBothRunLengthForms) {
  std::string text = "#?RGBE\n" + rgbe + "\n-Y 1 +X 8\n";
  text += std::string("\x02\x02\x00\x08", 4);
  for (int c = 0; c < 4; ++c)
    text += c == 0 ? std::string("\x08\x10\x20\x30\x40\x50\x60\x70\x80", 9)
                   : std::string(1, char(128 + 8)) + '\x80';
  const Image packed = light(text);
  for (int x = 0; x < 8; ++x) expect_pixel(packed, x, 0, {(x + 1) / 16., .5, .5});
  const Image old =
      light(hdr(rgbe, "-Y 1 +X 7", {{128, 0, 0, 128}, {1, 1, 1, 5}, {0, 128, 0, 128}}));
  for (int x = 0; x < 6; ++x) expect_pixel(old, x, 0, {.5, 0, 0});
  expect_pixel(old, 6, 0, {0, .5, 0});
}

TEST(RadianceLight, IsRefusedByWhatIsNotUnderstood) {
  const auto bad = [](const std::string& header, const std::string& resolution = "-Y 1 +X 1") {
    return refusal(hdr(header, resolution, grey_half));
  };
  EXPECT_THAT(bad("FORMAT=32-bit_rle_luv\n"), HasSubstr("FORMAT"));
  EXPECT_THAT(bad(""), HasSubstr("no FORMAT"));
  EXPECT_THAT(bad(rgbe + "EXPOSURE=0\n"), HasSubstr("exposure"));
  EXPECT_THAT(bad(rgbe + "EXPOSURE=-1\n"), HasSubstr("exposure"));
  EXPECT_THAT(bad(rgbe + "EXPOSURE=two\n"), HasSubstr("EXPOSURE"));
  EXPECT_THAT(bad(rgbe + "COLORCORR=1 1\n"), HasSubstr("COLORCORR"));
  EXPECT_THAT(bad(rgbe + "GAMMA=0\n"), HasSubstr("gamma"));
  EXPECT_THAT(bad(rgbe + "PRIMARIES=.3 .3 .3 .3 .3 .3 .3 .3\n"), HasSubstr("span no colours"));
  for (const char* resolution : {"-Y 1", "-Y 1 +Y 1", "-Y 0 +X 1", "-Y -1 +X 1", "*Y 1 +X 1",
                                 "-Y 1 +X 1 x", "-Y 99999 +X 99999", "+Z 1 +X 1"})
    EXPECT_NE(bad(rgbe, resolution), "taken") << resolution;
  EXPECT_THAT(refusal(hdr(rgbe, "-Y 2 +X 1", grey_half)), HasSubstr("cut off"));
}

// ---- PNG

std::string big(std::uint32_t v) { return {char(v >> 24), char(v >> 16), char(v >> 8), char(v)}; }
std::uint32_t crc(const std::string& bytes) {
  std::uint32_t c = ~0u;
  for (const unsigned char b : bytes) {
    c ^= b;
    for (int k = 0; k < 8; ++k) c = c & 1 ? 0xedb88320u ^ c >> 1 : c >> 1;
  }
  return ~c;
}
std::string chunk(const std::string& name, const std::string& data) {
  return big(static_cast<std::uint32_t>(data.size())) + name + data + big(crc(name + data));
}
std::string deflated(const std::string& data) {  // stored
  std::uint32_t a = 1, b = 0;
  for (const unsigned char c : data) {
    a = (a + c) % 65521;
    b = (b + a) % 65521;
  }
  const auto n = static_cast<std::uint16_t>(data.size()), m = static_cast<std::uint16_t>(~n);
  return std::string("\x78\x01\x01", 3) + char(n) + char(n >> 8) + char(m) + char(m >> 8) + data +
         big(b << 16 | a);
}
/// One row of pixels of 8 bits.
std::string png(int color_type, int width, const std::string& row, const std::string& chunks = "") {
  return "\x89PNG\r\n\x1a\n" +
         chunk("IHDR", big(width) + big(1) + std::string("\x08", 1) + char(color_type) +
                           std::string(3, '\0')) +
         chunks + chunk("IDAT", deflated(std::string(1, '\0') + row)) + chunk("IEND", "");
}
const std::string grey_128 = "\x80\x80\x80";

TEST(PngLight, IsSrgbUnlessItSaysOtherwise) {
  const double code = 128 / 255.;
  const auto one = [](const std::string& chunks) { return light(png(2, 1, grey_128, chunks)); };
  const auto expect = [](const Image& image, double v) { expect_pixel(image, 0, 0, {v, v, v}); };
  expect(one(""), srgb(code));
  expect(one(chunk("sRGB", std::string(1, '\0'))), srgb(code));
  expect(one(chunk("gAMA", big(45455))), std::pow(code, 1 / .45455));
  expect(one(chunk("gAMA", big(100000))), code);
  expect(one(chunk("gAMA", big(100000)) + chunk("sRGB", std::string(1, '\0'))), srgb(code));
  expect(one(chunk("cICP", std::string("\x01\x08\x00\x01", 4))), code);
  expect(one(chunk("cICP", std::string("\x01\x0d\x00\x01", 4)) + chunk("gAMA", big(100000))),
         srgb(code));
  expect(one(chunk("cICP", std::string("\x01\x01\x00\x01", 4))),
         std::pow((code + .099) / 1.099, 1 / .45));
  EXPECT_THAT(refusal(png(2, 1, grey_128, chunk("cICP", std::string("\x09\x10\x00\x01", 4)))),
              HasSubstr("PQ"));
  EXPECT_THAT(refusal(png(2, 1, grey_128, chunk("gAMA", big(0)))), HasSubstr("gAMA"));
}

TEST(PngLight, HasItsPrimariesHonoured) {
  std::string xy;
  for (const int v : {31270, 32900, 68000, 32000, 26500, 69000, 15000, 6000}) xy += big(v);
  // Display P3's red in Rec.709, as issue F3 has it.
  const Image p3 = light(png(2, 1, std::string("\xff\x00\x00", 3), chunk("cHRM", xy)));
  expect_pixel(p3, 0, 0, {1.2249, -.0421, -.0196}, 1e-4);
  const Image cicp = light(
      png(2, 1, std::string("\xff\x00\x00", 3), chunk("cICP", std::string("\x0c\x0d\x00\x01", 4))));
  expect_pixel(cicp, 0, 0, {1.2249, -.0421, -.0196}, 1e-4);
}

TEST(PngLight, HasItsAlphaMultipliedInLinearLight) {
  const double code = 128 / 255.;
  expect_pixel(light(png(6, 1, "\x80\x80\x80\x80")), 0, 0,
               {srgb(code) * code, srgb(code) * code, srgb(code) * code});
  expect_pixel(light(png(4, 1, "\x80\x80")), 0, 0,
               {srgb(code) * code, srgb(code) * code, srgb(code) * code});
  expect_pixel(light(png(0, 1, "\x80")), 0, 0, {srgb(code), srgb(code), srgb(code)});
}

// ---- EXR

template <class T>
std::string raw(T v) {
  return {reinterpret_cast<const char*>(&v), sizeof v};
}
std::string attribute(const std::string& name, const std::string& type, const std::string& value) {
  return name + '\0' + type + '\0' + raw(std::int32_t(value.size())) + value;
}
std::string box(int x0, int y0, int x1, int y1) { return raw(x0) + raw(y0) + raw(x1) + raw(y1); }

/// An uncompressed picture of 2 x 1 pixels, each channel of the values 1 and 2.
std::string exr(const std::vector<std::string>& channels, const std::string& more = "",
                const std::string& display = box(0, 0, 1, 0), int type = 2) {
  std::string list;
  for (const std::string& name : channels)
    list += name + '\0' + raw(type) + std::string(4, '\0') + raw(1) + raw(1);
  list += '\0';
  std::string text = std::string("\x76\x2f\x31\x01\x02\0\0\0", 8) +
                     attribute("channels", "chlist", list) +
                     attribute("compression", "compression", std::string(1, '\0')) +
                     attribute("dataWindow", "box2i", box(0, 0, 1, 0)) +
                     attribute("displayWindow", "box2i", display) +
                     attribute("lineOrder", "lineOrder", std::string(1, '\0')) +
                     attribute("pixelAspectRatio", "float", raw(1.0f)) +
                     attribute("screenWindowCenter", "v2f", raw(0.0f) + raw(0.0f)) +
                     attribute("screenWindowWidth", "float", raw(1.0f)) + more + '\0';
  std::string line;
  for (std::size_t c = 0; c < channels.size(); ++c)
    line += type == 2 ? raw(1.0f) + raw(2.0f) : raw(1u) + raw(2u);
  text += raw(std::uint64_t(text.size() + 8));
  return text + raw(0) + raw(std::int32_t(line.size())) + line;
}
std::string chromaticities(std::array<float, 8> xy) {
  std::string value;
  for (const float v : xy) value += raw(v);
  return attribute("chromaticities", "chromaticities", value);
}

TEST(ExrLight, IsInTheChannelsThatMeanLight) {
  for (const auto& channels :
       std::vector<std::vector<std::string>>{{"B", "G", "R"},
                                             {"b", "g", "r"},
                                             {"Y"},
                                             {"A", "B", "G", "R"},
                                             {"A", "Y"},
                                             {"B", "G", "R", "Z"},
                                             {"B", "G", "N.X", "R", "depth.V"}}) {
    const Image image = light(exr(channels));
    expect_pixel(image, 0, 0, {1, 1, 1});
    expect_pixel(image, 1, 0, {2, 2, 2});
  }
  for (const auto& channels :
       std::vector<std::vector<std::string>>{{"Z"},
                                             {"A"},
                                             {"U", "V"},
                                             {"G", "R"},
                                             {"R"},
                                             {"B", "R"},
                                             {"A", "G", "R"},
                                             {"diffuse.B", "diffuse.G", "diffuse.R"},
                                             {"X", "Y.x"},
                                             {"BY", "RY", "Y"}})
    EXPECT_NE(refusal(exr(channels)), "taken") << channels[0];
  EXPECT_THAT(refusal(exr({"Z"})), HasSubstr("(Z)"));
  EXPECT_THAT(refusal(exr({"G", "R"})), HasSubstr("(G, R)"));
  EXPECT_THAT(refusal(exr({"B", "G", "R"}, "", box(0, 0, 1, 0), 0)), HasSubstr("integers"));
}

TEST(ExrLight, IsConvertedFromItsPrimaries) {
  const Chromaticities p3{{.68, .32}, {.265, .69}, {.15, .06}, {.3127, .329}};
  const Matrix3 m = rgb_to_rec709(p3);
  EXPECT_NEAR(m[0][0], 1.2249, 1e-4);
  EXPECT_NEAR(m[1][0], -.0421, 1e-4);
  EXPECT_NEAR(m[2][0], -.0196, 1e-4);
  // White stays white, from any white.
  for (const Chromaticities& c :
       {p3, Chromaticities{{.7347, .2653}, {0, 1}, {.0001, -.077}, {.32168, .33767}},
        Chromaticities{{.713, .293}, {.165, .83}, {.128, .044}, {.32168, .33767}},
        Chromaticities{{1, 0}, {0, 1}, {0, 0}, {1 / 3., 1 / 3.}}}) {
    const Matrix3 to = rgb_to_rec709(c);
    for (const auto& row : to) EXPECT_NEAR(row[0] + row[1] + row[2], 1, 1e-9);
  }
  const Image grey =
      light(exr({"B", "G", "R"},
                chromaticities({.713f, .293f, .165f, .83f, .128f, .044f, .32168f, .33767f})));
  expect_pixel(grey, 1, 0, {2, 2, 2});
  const Image same = light(
      exr({"B", "G", "R"}, chromaticities({.64f, .33f, .3f, .6f, .15f, .06f, .3127f, .329f})));
  EXPECT_EQ(same.pixels, light(exr({"B", "G", "R"})).pixels);
  EXPECT_THAT(
      refusal(exr({"B", "G", "R"}, chromaticities({.3f, .3f, .3f, .3f, .3f, .3f, .3f, .3f}))),
      HasSubstr("span no colours"));
  EXPECT_NE(refusal(exr({"B", "G", "R"}, chromaticities({NAN, .3f, .3f, .6f, .1f, .1f, .3f, .3f}))),
            "taken");
}

TEST(ExrLight, IsRefusedWhereItIsNoWholeLatLongMap) {
  const std::vector<std::string> rgb{"B", "G", "R"};
  EXPECT_NE(refusal(exr(rgb, attribute("envmap", "envmap", std::string(1, '\0')))), "x");
  light(exr(rgb, attribute("envmap", "envmap", std::string(1, '\0'))));
  EXPECT_THAT(refusal(exr(rgb, attribute("envmap", "envmap", "\x01"))), HasSubstr("cube map"));
  for (const std::string& display : {box(0, 0, 3, 1), box(-1, 0, 1, 0), box(0, 0, 0, 0)})
    EXPECT_THAT(refusal(exr(rgb, "", display)), HasSubstr("display window"));
  EXPECT_THAT(
      refusal(exr(rgb, attribute("translucube:colorspace", "string", "Display P3/standard"))),
      HasSubstr("display"));
}

TEST(AnyLight, IsBoundedAndFinite) {
  const auto of = [](float value) {
    std::string text = exr({"Y"});
    return text.replace(text.size() - 4, 4, raw(value));
  };
  expect_pixel(light(of(1e9f)), 1, 0, {1e9, 1e9, 1e9}, 100);
  for (const float value : {1.1e9f, -1.1e9f, 3e38f, INFINITY, -INFINITY, NAN})
    EXPECT_THAT(refusal(of(value)), HasSubstr("at pixel (1, 0)")) << value;
}

TEST(AnyLight, OfAnotherFormatIsRefused) {
  for (const char* bytes : {"", "GIF89a", "P6 1 1 255 abc", "SDPX", "BM", "v 0 0 0"})
    EXPECT_THAT(refusal(bytes), HasSubstr("neither OpenEXR")) << bytes;
}

TEST(AnyLight, CutOffIsRefused) {
  const std::string files[] = {exr({"B", "G", "R"}), png(2, 1, grey_128),
                               hdr(rgbe, "-Y 1 +X 2", {{1, 2, 3, 128}, {4, 5, 6, 128}})};
  for (const std::string& whole : files)
    for (const std::size_t length : {whole.size() / 4, whole.size() / 2, whole.size() * 3 / 4})
      EXPECT_NE(refusal(whole.substr(0, length)), "taken") << length << " of " << whole.size();
}

// ---- the files that this program writes itself

TEST(OwnPictures, AreLightWhereTheyAreNotForADisplay) {
  Image picture(2, 2);
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) picture.pixels[i] = .1f * (1 + i % 3);
  const fs::path folder =
      fs::temp_directory_path() / ("translucube_own_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const auto written = [&](ImageFormat format, const std::string& space) {
    const fs::path file = folder / "picture";
    ImageMetadata metadata;
    metadata.colorspace = space;
    write_image(file, picture, format, metadata);
    return file;
  };
  expect_pixel(read_light_map(written(ImageFormat::exr, "lin_rec709")), 1, 1, {.1, .2, .3});
  for (const ImageFormat format : {ImageFormat::png, ImageFormat::tiff, ImageFormat::jpeg})
    expect_pixel(read_light_map(written(format, "sRGB/standard")), 1, 1,
                 {srgb(.1), srgb(.2), srgb(.3)}, format == ImageFormat::jpeg ? 5e-3 : 1e-3);
  for (const ImageFormat format : {ImageFormat::png, ImageFormat::tiff, ImageFormat::jpeg})
    EXPECT_THROW(read_light_map(written(format, "Display P3/standard")), ImageError);
  fs::remove_all(folder);
}

/// A JPEG of 16 x 8 whose left half is white, with an EXIF orientation.
std::string jpeg(int orientation) {
  Image picture(16, 8);
  for (int y = 0; y < 8; ++y)
    for (int x = 0; x < 16; ++x)
      for (int c = 0; c < 3; ++c) picture.pixels[3 * (16 * y + x) + c] = x < 8 ? 1.0f : 0.0f;
  const fs::path file =
      fs::temp_directory_path() / ("translucube_jpeg_" + std::to_string(::getpid()));
  write_image(file, picture, ImageFormat::jpeg, {});
  std::ifstream in(file, std::ios::binary);
  std::string bytes(std::istreambuf_iterator<char>(in), {});
  fs::remove(file);
  const std::string exif =
      std::string("Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0", 25) +
      char(orientation) + std::string(6, '\0');
  const auto length = static_cast<char>(exif.size() + 2);
  return bytes.insert(2, std::string("\xff\xe1\0", 3) + length + exif);
}

TEST(JpegLight, IsUprightByItsExifOrientation) {
  struct Seen {
    int orientation, width, height, white_x, white_y;
  };
  for (const Seen& seen : {Seen{1, 16, 8, 2, 4},
                           {2, 16, 8, 13, 4},
                           {3, 16, 8, 13, 4},
                           {4, 16, 8, 2, 4},
                           {5, 8, 16, 4, 2},
                           {6, 8, 16, 4, 2},
                           {7, 8, 16, 4, 13},
                           {8, 8, 16, 4, 13}}) {
    const Image image = light(jpeg(seen.orientation));
    SCOPED_TRACE(seen.orientation);
    ASSERT_EQ(image.width, seen.width);
    ASSERT_EQ(image.height, seen.height);
    expect_pixel(image, seen.white_x, seen.white_y, {1, 1, 1}, .02);
    expect_pixel(image, image.width - 1 - seen.white_x, image.height - 1 - seen.white_y, {0, 0, 0},
                 .02);
  }
}

}  // namespace
}  // namespace translucube::test

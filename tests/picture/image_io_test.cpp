// Image files: what is written is read back, and what cannot be used is refused by name.

#include "picture/image_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <thread>
#include <vector>

#include "picture/version.h"
#include "tests/support/repository.h"

#ifdef __SANITIZE_ADDRESS__
#include <sanitizer/lsan_interface.h>
#endif

namespace translucube {
namespace {

using testing::HasSubstr;

const std::vector<ImageFormat> all_formats = [] {
  std::vector<ImageFormat> formats;
  for (const ImageFormatRow& row : image_formats) formats.push_back(row.format);
  return formats;
}();

class ImageIo : public testing::Test {
 protected:
  ImageIo() {
    std::string pattern = (std::filesystem::temp_directory_path() / "image_io_XXXXXX").string();
    folder_ = ::mkdtemp(pattern.data());
  }
  ~ImageIo() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path path(const std::string& file) const { return folder_ / file; }
  std::filesystem::path write_bytes(const std::string& file, const std::string& bytes) const {
    std::ofstream(path(file), std::ios::binary) << bytes;
    return path(file);
  }

 private:
  std::filesystem::path folder_;
};

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Values in [0, 1] that no two neighbours share.
Image ramp(int width, int height) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = static_cast<float>(i % 1009) / 1008.0f;
  return image;
}

double srgb_to_linear(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

std::string error_of(const std::filesystem::path& file) {
  try {
    read_image(file);
  } catch (const ImageError& error) {
    return error.what();
  }
  return "";
}

TEST_F(ImageIo, FormatsAreFoundByNameAndByExtension) {
  EXPECT_EQ(format_named("png"), ImageFormat::png);
  EXPECT_EQ(format_named("jpg"), std::nullopt);
  EXPECT_EQ(format_of("a/b.png"), ImageFormat::png);
  EXPECT_EQ(format_of("b.c.JPG"), ImageFormat::jpeg);
  EXPECT_EQ(format_of("b.jpeg"), ImageFormat::jpeg);
  EXPECT_EQ(format_of("b.tif"), ImageFormat::tiff);
  EXPECT_EQ(format_of("b.exr"), ImageFormat::exr);
  EXPECT_EQ(format_of("b.gif"), std::nullopt);
  for (const char* none : {"", "b", "png", ".png", "b."}) EXPECT_EQ(format_of(none), std::nullopt);
  for (const ImageFormat format : all_formats) {
    EXPECT_EQ(format_named(name(format)), format);
    EXPECT_EQ(format_of("b" + std::string(row_of(format).extension)), format);
  }
  EXPECT_EQ(mime_type(ImageFormat::png), "image/png");
  EXPECT_EQ(mime_type(ImageFormat::jpeg), "image/jpeg");
}

TEST_F(ImageIo, ExrKeepsEveryFloatBitForBit) {
  Image image = ramp(37, 19);
  image.pixels[0] = 33664.25f;
  image.pixels[1] = -0.125f;
  image.pixels[2] = 1e-30f;
  write_image(path("a.exr"), image, ImageFormat::exr, {"{}", "lin_rec709"});
  const Image back = read_image(path("a.exr"));
  EXPECT_EQ(back.width, 37);
  EXPECT_EQ(back.height, 19);
  EXPECT_EQ(back.pixels, image.pixels);
}

TEST_F(ImageIo, DisplayFormatsKeepTheirBitDepth) {
  const Image image = ramp(64, 48);
  const std::pair<ImageFormat, double> tolerances[] = {{ImageFormat::png, 0.5 / 65535},
                                                       {ImageFormat::tiff, 0.5 / 65535}};
  for (const auto& [format, tolerance] : tolerances) {
    write_image(path("a"), image, format, {"{}", "sRGB/plain"});
    const Image back = read_image(path("a"));  // reading makes it linear
    ASSERT_EQ(back.pixels.size(), image.pixels.size());
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      ASSERT_NEAR(back.pixels[i], srgb_to_linear(image.pixels[i]), 2.4 * tolerance + 1e-6)
          << name(format);
  }
}

TEST_F(ImageIo, JpegIsCloseOnASmoothPicture) {
  Image image(64, 64);
  for (int y = 0; y < 64; ++y)
    for (int x = 0; x < 64; ++x)
      for (int c = 0; c < 3; ++c) image.pixels[3 * (64 * y + x) + c] = (x + y + 20.0f * c) / 200.0f;
  write_image(path("a.jpg"), image, ImageFormat::jpeg, {"{}", "sRGB/plain"});
  const Image back = read_image(path("a.jpg"));
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    ASSERT_NEAR(back.pixels[i], srgb_to_linear(image.pixels[i]), 0.02);
}

TEST_F(ImageIo, MetadataSurvivesInEveryFormat) {
  const ImageMetadata metadata{
      R"({"absorber":"red-\"glass\"","file":"Wälder/森.exr","note":"back\\slash, 'quote', tab\t"})",
      "Display P3/ACES SDR"};
  for (const ImageFormat format : all_formats) {
    write_image(path("a"), ramp(8, 8), format, metadata);
    const ImageMetadata back = read_metadata(path("a"));
    EXPECT_EQ(back.request, metadata.request) << name(format);
    EXPECT_EQ(back.colorspace, metadata.colorspace) << name(format);
  }
}

TEST_F(ImageIo, LongRequestsSurviveWhereTheFormatHasRoomAndBreakNoOther) {
  // 64 KiB end a JPEG segment: libjpeg would end the process.
  for (const std::size_t length : {59'999u, 60'001u, 70'000u, 1'000'000u}) {
    const ImageMetadata metadata{std::string(length, 'r'), "sRGB/plain"};
    for (const ImageFormat format : all_formats) {
      write_image(path("a"), ramp(8, 8), format, metadata);
      const bool room =
          format == ImageFormat::png || format == ImageFormat::exr || length <= 60'000;
      EXPECT_EQ(read_metadata(path("a")).request, room ? metadata.request : "") << name(format);
      EXPECT_EQ(read_metadata(path("a")).colorspace, "sRGB/plain") << name(format);
    }
  }
}

TEST_F(ImageIo, MetadataOfAnotherVersionIsReadToo) {
  write_image(path("a.tiff"), ramp(8, 8), ImageFormat::tiff, {"{}", "sRGB/plain"});
  std::string bytes = bytes_of(path("a.tiff"));
  const std::string program = "Translucube ", version(project_version());
  const std::size_t at = bytes.find(program + version + ", ");
  ASSERT_NE(at, bytes.npos);
  bytes.replace(at + program.size(), version.size(), std::string(version.size(), '9'));
  const ImageMetadata metadata = read_metadata(write_bytes("b.tiff", bytes));
  EXPECT_EQ(metadata.request, "{}");
  EXPECT_EQ(metadata.colorspace, "sRGB/plain");
}

TEST_F(ImageIo, ForeignFilesHaveNoMetadata) {
  const auto file = write_bytes("a.ppm", "P6 1 1 255\nabc");
  EXPECT_EQ(read_metadata(file).request, "");
  EXPECT_EQ(read_metadata(file).colorspace, "");
}

TEST_F(ImageIo, SamePictureGivesTheSameBytes) {
  const auto write = [&](ImageFormat format) {
    write_image(path("a"), ramp(8, 8), format, {"{}", "sRGB/plain"});
    return bytes_of(path("a"));
  };
  std::vector<std::string> first;
  for (const ImageFormat format : all_formats) first.push_back(write(format));
  // A date in a header would differ from the next second on.
  std::this_thread::sleep_for(std::chrono::milliseconds(1050));
  for (std::size_t i = 0; i < all_formats.size(); ++i)
    EXPECT_EQ(first[i], write(all_formats[i])) << name(all_formats[i]);
}

TEST_F(ImageIo, ExrHeaderHasTheChromaticitiesOfItsColorspace) {
  const std::pair<const char*, float> red_x[] = {
      {"lin_rec709", 0.64f}, {"ACEScg", 0.713f}, {"XYZ", 1.0f}};
  for (const auto& [colorspace, x] : red_x) {
    write_image(path("a.exr"), ramp(4, 4), ImageFormat::exr, {"{}", colorspace});
    const std::string bytes = bytes_of(path("a.exr"));
    // OpenEXR header entry: name, type, 4 bytes of size, 8 little-endian floats.
    const std::string entry("chromaticities\0chromaticities\0\x20\0\0\0", 34);
    const auto at = bytes.find(entry);
    ASSERT_NE(at, std::string::npos) << colorspace;
    float first;
    std::memcpy(&first, bytes.data() + at + entry.size(), sizeof first);
    EXPECT_EQ(first, x) << colorspace;
  }
}

TEST_F(ImageIo, OnlyTrueSrgbIsTaggedSo) {
  const auto tagged = [&](const char* colorspace) {
    write_image(path("a.png"), ramp(4, 4), ImageFormat::png, {"{}", colorspace});
    const std::string bytes = bytes_of(path("a.png"));
    // The chunk: its length, 1, before its name.
    return bytes.find(std::string("\0\0\0\1sRGB", 8)) != std::string::npos;
  };
  EXPECT_TRUE(tagged("sRGB/plain"));
  EXPECT_FALSE(tagged("sRGB/raw"));
  EXPECT_FALSE(tagged("Display P3/plain"));
  EXPECT_FALSE(tagged("Rec.2020/plain"));
}

// A 2 x 1 grey + alpha PNG (255, 128; opaque) and a 1 x 1 RGBA one (255, 51, 0, 255), both 8 bit
// with a gAMA chunk that says linear.
constexpr unsigned char grey_alpha_png[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x02, 0x00, 0x00, 0x00, 0x01, 0x08, 0x04, 0x00, 0x00, 0x00, 0x5e,
    0x2b, 0xb7, 0x01, 0x00, 0x00, 0x00, 0x04, 0x67, 0x41, 0x4d, 0x41, 0x00, 0x01, 0x86, 0xa0,
    0x31, 0xe8, 0x96, 0x5f, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63,
    0xf8, 0xff, 0xbf, 0xe1, 0x3f, 0x00, 0x08, 0xfd, 0x03, 0x7e, 0x2c, 0x7c, 0x17, 0xc5, 0x00,
    0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};
constexpr unsigned char rgba_png[] = {
    0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x48, 0x44,
    0x52, 0x00, 0x00, 0x00, 0x01, 0x00, 0x00, 0x00, 0x01, 0x08, 0x06, 0x00, 0x00, 0x00, 0x1f,
    0x15, 0xc4, 0x89, 0x00, 0x00, 0x00, 0x04, 0x67, 0x41, 0x4d, 0x41, 0x00, 0x01, 0x86, 0xa0,
    0x31, 0xe8, 0x96, 0x5f, 0x00, 0x00, 0x00, 0x0d, 0x49, 0x44, 0x41, 0x54, 0x78, 0xda, 0x63,
    0xf8, 0x6f, 0xcc, 0xf0, 0x1f, 0x00, 0x05, 0x99, 0x02, 0x32, 0xd9, 0xf6, 0xd6, 0x1f, 0x00,
    0x00, 0x00, 0x00, 0x49, 0x45, 0x4e, 0x44, 0xae, 0x42, 0x60, 0x82};

TEST_F(ImageIo, GreyWithAlphaIsSpreadOverTheChannels) {
  const auto file =
      write_bytes("a.png", {reinterpret_cast<const char*>(grey_alpha_png), sizeof grey_alpha_png});
  const Image image = read_image(file);
  ASSERT_EQ(image.width, 2);
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(image.pixels[c], 1.0f);
    EXPECT_NEAR(image.pixels[3 + c], 128.0 / 255, 1e-6);
  }
}

TEST_F(ImageIo, AlphaIsLeftOut) {
  const auto file =
      write_bytes("a.png", {reinterpret_cast<const char*>(rgba_png), sizeof rgba_png});
  const Image image = read_image(file);
  ASSERT_EQ(image.pixels.size(), 3u);
  EXPECT_EQ(image.pixels[0], 1.0f);
  EXPECT_NEAR(image.pixels[1], 0.2, 1e-6);
  EXPECT_EQ(image.pixels[2], 0.0f);
}

TEST_F(ImageIo, GreyIsSpreadOverTheChannels) {
  const Image image = read_image(write_bytes("a.pgm", "P5 2 1 255\n\xff\x80"));
  for (int c = 0; c < 3; ++c) {
    EXPECT_EQ(image.pixels[c], 1.0f);
    EXPECT_EQ(image.pixels[3 + c], image.pixels[3]);
  }
}

TEST_F(ImageIo, NonFinitePixelsAreRefusedWithTheirPlace) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    Image image = ramp(5, 4);
    image.pixels[3 * (5 * 2 + 3) + 1] = bad;
    write_image(path("a.exr"), image, ImageFormat::exr, {});
    EXPECT_THAT(error_of(path("a.exr")), HasSubstr("not finite at pixel (3, 2)"));
  }
}

TEST_F(ImageIo, UnusableFilesAreRefusedByName) {
  EXPECT_THAT(error_of(path("missing.exr")), HasSubstr("missing.exr: No such file"));
  EXPECT_THAT(error_of(path("")), HasSubstr("not a regular file"));
  // OpenImageIO would invent an image for this name.
  EXPECT_THAT(error_of(path("a.null")), HasSubstr("No such file"));
  EXPECT_THAT(error_of(write_bytes("text.exr", "hello")), HasSubstr("text.exr: not a readable"));
  EXPECT_THAT(error_of(write_bytes("empty.png", "")), HasSubstr("empty.png: not a readable"));
  EXPECT_THROW(read_metadata(path("missing.exr")), ImageError);
}

TEST_F(ImageIo, CutOffFilesAreRefused) {
  for (const ImageFormat format : {ImageFormat::png, ImageFormat::exr, ImageFormat::tiff}) {
    write_image(path("whole"), ramp(200, 100), format, {"{}", "sRGB/plain"});
    const std::string bytes = bytes_of(path("whole"));
    const auto cut = write_bytes("cut", bytes.substr(0, bytes.size() / 2));
#ifdef __SANITIZE_ADDRESS__
    // libpng leaves through a longjmp that skips a destructor of OpenImageIO's: 31 bytes, not ours.
    const __lsan::ScopedDisabler no_leak_check;
#endif
    EXPECT_THROW(read_image(cut), ImageError) << name(format);
  }
}

TEST_F(ImageIo, HeadersThatClaimTooManyPixelsAreRefusedBeforeTheMemoryIsTaken) {
  EXPECT_THAT(error_of(write_bytes("big.ppm", "P6 20000 20000 255\nabc")),
              HasSubstr("20000 x 20000 pixels, more than 2^28"));
}

TEST_F(ImageIo, FullDiskIsAnError) {
  // The kernel's always-full device: for JPEG a failed write would make libjpeg end the process.
  for (const ImageFormat format : all_formats) {
    try {
      write_image("/dev/full", ramp(256, 256), format, {"{}", "sRGB/plain"});
      ADD_FAILURE() << name(format) << " was written to a full disk";
    } catch (const ImageError& error) {
      EXPECT_THAT(error.what(), HasSubstr("No space left on device")) << name(format);
    }
  }
}

TEST_F(ImageIo, FolderThatIsNotThereIsAnError) {
  EXPECT_THROW(write_image(path("none/a.png"), ramp(4, 4), ImageFormat::png, {}), ImageError);
}

TEST_F(ImageIo, EmptyAndOversizedImagesAreNotWritten) {
  EXPECT_THROW(write_image(path("a.png"), Image(), ImageFormat::png, {}), ImageError);
  EXPECT_THROW(write_image(path("a.jpg"), Image(65'501, 1), ImageFormat::jpeg, {}), ImageError);
  EXPECT_NO_THROW(write_image(path("a.jpg"), Image(65'500, 1), ImageFormat::jpeg, {}));
}

TEST_F(ImageIo, ShippedEnvironmentsAreReadable) {
  const std::filesystem::path folder = in_repository("config/environments");
  const std::pair<const char*, float> peaks[] = {{"forest.exr", 1010}, {"sunrise.exr", 33664}};
  for (const auto& [file, peak] : peaks) {
    const Image image = read_image(folder / file);
    EXPECT_EQ(image.width, 1024);
    EXPECT_EQ(image.height, 512);
    EXPECT_NEAR(*std::max_element(image.pixels.begin(), image.pixels.end()) / peak, 1, 0.02);
  }
}

}  // namespace
}  // namespace translucube

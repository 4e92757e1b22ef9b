// Contact sheets: pictures land in their cells with their colours, and nothing else changes.

#include "picture/sheet/contact_sheet.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "picture/reduce.h"
#include "tests/support/repository.h"

namespace translucube {
namespace {

using Pixel = std::array<float, 3>;

Image picture(int width, int height, const std::function<Pixel(int, int)>& color) {
  Image image(width, height);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      std::copy_n(color(x, y).begin(), 3, image.pixels.begin() + 3 * (y * width + x));
  return image;
}

Image uniform(int width, int height, const Pixel& color) {
  return picture(width, height, [&](int, int) { return color; });
}

Image checker(int size) {
  return picture(size, size, [](int x, int y) {
    const float v = (x + y) % 2 == 0 ? 0.0f : 1.0f;
    return Pixel{v, v, v};
  });
}

const float* at(const Image& image, int x, int y) {
  return image.pixels.data() + 3 * (std::size_t(y) * image.width + x);
}

Pixel mean(const Image& image, const Box& box) {
  std::array<double, 3> sum{};
  for (int y = box.y; y < box.y + box.height; ++y)
    for (int x = box.x; x < box.x + box.width; ++x)
      for (int c = 0; c < 3; ++c) sum[c] += at(image, x, y)[c];
  const double area = double(box.width) * box.height;
  return {float(sum[0] / area), float(sum[1] / area), float(sum[2] / area)};
}

/// Pixels of the box that differ between two sheets.
int differences(const Image& a, const Image& b, const Box& box) {
  int count = 0;
  for (int y = box.y; y < box.y + box.height; ++y)
    for (int x = box.x; x < box.x + box.width; ++x)
      count += !std::equal(at(a, x, y), at(a, x, y) + 3, at(b, x, y));
  return count;
}

class ContactSheetTest : public testing::Test {
 protected:
  static SheetSpec spec(int width, int height) {
    SheetSpec result;
    result.title = "sphere";
    result.axes = {{{"absorption a", {"0", "0.5", "1"}},
                    {"roughness r", {"0", "1"}},
                    {"scattering s", {"0.25", "0.75"}},
                    {"", {"red-glass", "amber"}}}};
    result.picture_width = width;
    result.picture_height = height;
    result.cell_size = 40;
    return result;
  }

  static std::vector<SheetCell> cells() {
    std::vector<SheetCell> result;
    for (int i = 0; i < 24; ++i) result.push_back({i % 3, i / 3 % 2, i / 6 % 2, i / 12});
    return result;
  }

  const Font font_ = find_font();
  const ColorConfig colors_{in_repository("config/display.ocio")};
};

TEST(Reduce, IsTheMeanOverTheArea) {
  for (const int size : {2, 3, 7, 16, 33}) {
    const Image reduced = reduce(checker(66), size, size);
    const Pixel average = mean(reduced, {0, 0, size, size});
    EXPECT_NEAR(average[0], 0.5, 1e-6) << size;
  }
  const Image half = reduce(checker(64), 32, 32);
  for (const float value : half.pixels) EXPECT_EQ(value, 0.5f);

  const Image ramp = picture(5, 1, [](int x, int) { return Pixel{float(x), 10.0f * x, 1}; });
  const Image two = reduce(ramp, 2, 1);  // pixels 0, 1 and half of 2; half of 2, 3 and 4
  EXPECT_NEAR(two.pixels[0], (0 + 1 + 0.5 * 2) / 2.5, 1e-6);
  EXPECT_NEAR(two.pixels[3], (0.5 * 2 + 3 + 4) / 2.5, 1e-6);
  EXPECT_NEAR(two.pixels[4], 10 * (0.5 * 2 + 3 + 4) / 2.5, 1e-5);
}

TEST(Reduce, ToTheSameSizeGivesTheSameValues) {
  const Image image = picture(7, 5, [](int x, int y) { return Pixel{0.1f * x, 1e6f * y, -3.7f}; });
  EXPECT_EQ(reduce(image, 7, 5).pixels, image.pixels);
}

TEST_F(ContactSheetTest, PicturesLandInTheirCellsWithTheirColours) {
  const SheetLayout layout = lay_out_sheet(spec(100, 60), font_);
  ContactSheet sheet(layout, font_, scene_linear_look());
  const auto color_of = [](const SheetCell& c) {
    return Pixel{0.1f + 5 * c[0], 0.2f + c[1], 0.3f + c[2] + 10 * c[3]};
  };
  for (const SheetCell& cell : cells()) {
    // As bright on the left as dark on the right: the cell's mean is the colour.
    const Pixel color = color_of(cell);
    sheet.place(cell, picture(100, 60, [&](int x, int) {
                  const float f = 2 * (x + 0.5f) / 100;
                  return Pixel{f * color[0], f * color[1], f * color[2]};
                }));
  }
  for (const SheetCell& cell : cells()) {
    const Pixel found = mean(sheet.image(), layout.thumbnail(cell));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], color_of(cell)[c], 1e-4);
    const Box box = layout.thumbnail(cell);
    EXPECT_LT(at(sheet.image(), box.x, box.y)[0],
              at(sheet.image(), box.x + box.width - 1, box.y)[0]);
  }
}

TEST_F(ContactSheetTest, PicturesAreReducedInLinearLightThenEncoded) {
  const SheetLayout layout = lay_out_sheet(spec(80, 80), font_);
  ContactSheet linear(layout, font_, scene_linear_look());
  ContactSheet display(layout, font_, display_look(colors_, "sRGB", "plain"));
  const SheetCell cell = {1, 1, 0, 1};
  linear.place(cell, checker(80));
  display.place(cell, checker(80));
  const double srgb = 1.055 * std::pow(0.5, 1 / 2.4) - 0.055;
  const Box box = layout.thumbnail(cell);
  for (int y = box.y; y < box.y + box.height; ++y)
    for (int x = box.x; x < box.x + box.width; ++x) {
      EXPECT_NEAR(at(linear.image(), x, y)[1], 0.5, 1e-6);
      EXPECT_NEAR(at(display.image(), x, y)[1], srgb, 1e-4);
    }
}

TEST_F(ContactSheetTest, PlacingChangesNothingOutsideTheCell) {
  const SheetLayout layout = lay_out_sheet(spec(80, 80), font_);
  const ContactSheet empty(layout, font_, scene_linear_look());
  ContactSheet sheet(layout, font_, scene_linear_look());
  sheet.place({2, 0, 1, 0}, uniform(80, 80, {7, 7, 7}));
  sheet.mark({0, 1, 0, 0}, "canceled");
  const int all = differences(empty.image(), sheet.image(), {0, 0, layout.width, layout.height});
  const int inside = differences(empty.image(), sheet.image(), layout.cell({2, 0, 1, 0})) +
                     differences(empty.image(), sheet.image(), layout.cell({0, 1, 0, 0}));
  EXPECT_EQ(all, inside);
}

TEST_F(ContactSheetTest, TextsAndFramesAreNeutralAndNothingElseIsDrawn) {
  const SheetLayout layout = lay_out_sheet(spec(80, 80), font_);
  const SheetLook look = scene_linear_look();
  const ContactSheet sheet(layout, font_, look);
  Image unwritten = sheet.image();
  for (const SheetText& text : layout.texts) {
    EXPECT_GT(mean(sheet.image(), text.box)[0], look.background) << text.text;
    for (int y = text.box.y; y < text.box.y + text.box.height; ++y)
      std::fill_n(unwritten.pixels.begin() + 3 * (std::size_t(y) * layout.width + text.box.x),
                  3 * text.box.width, look.background);
  }
  for (const SheetCell& cell : cells()) {
    const Box box = layout.cell(cell);
    EXPECT_EQ(at(sheet.image(), box.x, box.y)[0], look.frame);
    EXPECT_EQ(at(sheet.image(), box.x + box.width / 2, box.y + box.height / 2)[0], look.background);
    for (int y = box.y; y < box.y + box.height; ++y)
      std::fill_n(unwritten.pixels.begin() + 3 * (std::size_t(y) * layout.width + box.x),
                  3 * box.width, look.background);
  }
  EXPECT_TRUE(std::all_of(unwritten.pixels.begin(), unwritten.pixels.end(),
                          [&](float v) { return v == look.background; }));
}

TEST_F(ContactSheetTest, AMissingCellShowsItsStateUntilThePictureComes) {
  const SheetLayout layout = lay_out_sheet(spec(80, 80), font_);
  const SheetCell cell = {0, 0, 0, 0};
  ContactSheet sheet(layout, font_, scene_linear_look());
  const Image empty = sheet.image();
  sheet.mark(cell, "failed");
  const Image failed = sheet.image();
  EXPECT_GT(differences(empty, failed, layout.cell(cell)), 20);
  sheet.mark(cell, "queued");
  EXPECT_GT(differences(sheet.image(), failed, layout.cell(cell)), 20);
  sheet.mark(cell, "a state whose name is much too long for the cell");
  sheet.mark(cell, "");
  EXPECT_EQ(sheet.image().pixels, empty.pixels);
  sheet.mark(cell, "queued");
  sheet.place(cell, uniform(80, 80, {2, 3, 4}));
  const Pixel found = mean(sheet.image(), layout.cell(cell));
  EXPECT_FLOAT_EQ(found[0], 2);
  EXPECT_FLOAT_EQ(found[2], 4);
}

TEST_F(ContactSheetTest, ATinyPictureLiesInTheMiddleOfItsClearedCell) {
  const SheetLayout layout = lay_out_sheet(spec(5, 3), font_);
  const SheetLook look = scene_linear_look();
  ContactSheet sheet(layout, font_, look);
  const Image tiny = picture(5, 3, [](int x, int y) { return Pixel{1.0f * x, 2.0f * y, 9}; });
  sheet.mark({0, 0, 0, 0}, "failed");
  sheet.place({0, 0, 0, 0}, tiny);
  const Box cell = layout.cell({0, 0, 0, 0}), box = layout.thumbnail({0, 0, 0, 0});
  for (int y = 0; y < 3; ++y)
    EXPECT_TRUE(
        std::equal(at(tiny, 0, y), at(tiny, 0, y) + 15, at(sheet.image(), box.x, box.y + y)));
  EXPECT_EQ(at(sheet.image(), cell.x, cell.y)[0], look.background);
}

TEST_F(ContactSheetTest, RefusesOtherSizesCellsAndDisplays) {
  ContactSheet sheet(lay_out_sheet(spec(80, 80), font_), font_, scene_linear_look());
  EXPECT_THROW(sheet.place({0, 0, 0, 0}, Image(81, 80)), std::invalid_argument);
  EXPECT_THROW(sheet.place({3, 0, 0, 0}, Image(80, 80)), std::out_of_range);
  EXPECT_THROW(sheet.mark({0, 0, 0, 2}, "failed"), std::out_of_range);
  ContactSheet nowhere(lay_out_sheet(spec(80, 80), font_), font_,
                       display_look(colors_, "no display", "plain"));
  EXPECT_THROW(nowhere.place({0, 0, 0, 0}, Image(80, 80)), ColorError);
}

}  // namespace
}  // namespace translucube

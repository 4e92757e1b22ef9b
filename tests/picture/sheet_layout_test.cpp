// The layout of contact sheets: nothing overlaps, everything fits, what cannot fit is refused.

#include "picture/sheet/sheet_layout.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace translucube {
namespace {

using testing::Contains;
using testing::Each;
using testing::EndsWith;
using testing::Field;
using testing::HasSubstr;
using testing::Not;

SheetAxis axis(const std::string& title, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(count == 1 ? 0.3 : double(i) / (count - 1));
  return {title, number_labels(values)};
}

SheetSpec sweep(const std::array<int, 4>& counts, int width = 512, int height = 512) {
  SheetSpec spec;
  spec.title = "sphere under forest";
  spec.axes = {axis("absorption a", counts[0]),
               axis("roughness r", counts[1]),
               axis("scattering s", counts[2]),
               {}};
  for (int i = 0; i < counts[3]; ++i)
    spec.axes[3].labels.push_back("absorber-" + std::to_string(i));
  spec.picture_width = width;
  spec.picture_height = height;
  spec.cell_size = 128;
  return spec;
}

std::vector<SheetCell> cells_of(const SheetLayout& layout) {
  std::vector<SheetCell> cells;
  const auto [a, r, s, k] = layout.counts;
  for (int i = 0; i < a * r * s * k; ++i)
    cells.push_back({i % a, i / a % r, i / a / r % s, i / a / r / s});
  return cells;
}

/// Draws every box into a map of the sheet; the number of pixels that two claim or that lie
/// outside.
std::int64_t clashes(const SheetLayout& layout) {
  std::vector<bool> taken(std::size_t(layout.width) * layout.height);
  std::int64_t count = 0;
  const auto claim = [&](const Box& box) {
    for (int y = box.y; y < box.y + box.height; ++y)
      for (int x = box.x; x < box.x + box.width; ++x) {
        if (x < 0 || y < 0 || x >= layout.width || y >= layout.height) {
          ++count;
          continue;
        }
        auto pixel = taken[std::size_t(y) * layout.width + x];
        count += pixel;
        pixel = true;
      }
  };
  for (const SheetText& text : layout.texts) claim(text.box);
  for (const SheetCell& cell : cells_of(layout)) claim(layout.cell(cell));
  return count;
}

class SheetLayoutTest : public testing::Test {
 protected:
  /// Lays out and checks what holds for every layout.
  SheetLayout lay_out(const SheetSpec& spec) const {
    const SheetLayout layout = lay_out_sheet(spec, font_);
    EXPECT_LE(layout.width, 16384);
    EXPECT_LE(layout.height, 16384);
    EXPECT_LE(std::int64_t{layout.width} * layout.height, spec.max_pixels);
    EXPECT_EQ(clashes(layout), 0);
    for (const SheetText& text : layout.texts) {
      EXPECT_GE(text.size, 10);
      EXPECT_LE(text.size, 24);
      const Box box = text.upright ? Box{0, 0, text.box.height, text.box.width} : text.box;
      EXPECT_EQ(box.width, font_.width(text.text, text.size));
      EXPECT_EQ(box.height, font_.line_height(text.size));
    }
    return layout;
  }

  const Font font_ = find_font();
};

std::vector<std::string> strings(const SheetLayout& layout) {
  std::vector<std::string> result;
  for (const SheetText& text : layout.texts) result.push_back(text.text);
  return result;
}

TEST_F(SheetLayoutTest, NothingOverlapsWhateverTheShape) {
  const std::vector<std::array<int, 4>> shapes = {
      {1, 1, 1, 1}, {5, 1, 1, 1}, {1, 5, 1, 1},  {1, 1, 5, 1},  {1, 1, 1, 5}, {2, 2, 1, 1},
      {5, 5, 5, 1}, {3, 2, 3, 3}, {21, 1, 4, 3}, {1, 21, 4, 1}, {1, 1, 7, 5}, {11, 11, 11, 1}};
  for (const auto& counts : shapes)
    for (const auto& [width, height] : {std::pair{512, 512}, {640, 200}, {100, 700}, {2000, 20}}) {
      SCOPED_TRACE(testing::PrintToString(counts) + ", pictures " + std::to_string(width) + " x " +
                   std::to_string(height));
      for (const int cell_size : {32, 128, 300}) {
        SheetSpec spec = sweep(counts, width, height);
        spec.cell_size = cell_size;
        lay_out(spec);
      }
    }
}

TEST_F(SheetLayoutTest, TheLargestSweepShrinksToFit) {
  const SheetLayout layout = lay_out(sweep({21, 21, 21, 3}));
  EXPECT_LT(layout.thumbnail_width, 128);
  EXPECT_GE(layout.thumbnail_width, 40);
  EXPECT_GT(std::int64_t{layout.width} * layout.height, (std::int64_t{1} << 26) * 8 / 10);
}

TEST_F(SheetLayoutTest, LongLabelsAreShortenedAndStillDoNotOverlap) {
  SheetSpec spec = sweep({4, 4, 3, 2});
  const std::string name(300, 'w');
  for (SheetAxis& a : spec.axes)
    for (std::string& label : a.labels) label = name;
  EXPECT_THAT(strings(lay_out(spec)), Contains(EndsWith("w\u2026")));
  spec.axes[0].title = spec.axes[1].title = spec.axes[2].title = spec.title = name;
  spec.cell_size = 32;
  lay_out(spec);
}

TEST_F(SheetLayoutTest, EveryValueIsLabelledInFullWhereNumbersFit) {
  const SheetLayout layout = lay_out(sweep({21, 21, 5, 1}, 64, 64));
  const std::vector<std::string> texts = strings(layout);
  EXPECT_EQ(std::count(texts.begin(), texts.end(), "0.35"), 5 * 2);
  EXPECT_EQ(std::count(texts.begin(), texts.end(), "absorption a"), 5);
  EXPECT_THAT(texts, Contains("scattering s = 0.25"));
  EXPECT_THAT(texts, Each(Not(HasSubstr("\u2026"))));
}

TEST_F(SheetLayoutTest, ColumnLabelsTooWideForTheirColumnStandUpright) {
  SheetSpec spec = sweep({3, 2, 1, 1});
  spec.cell_size = 32;
  spec.axes[0].labels = {"0.0001235", "0.5", "1"};
  const SheetLayout layout = lay_out(spec);
  EXPECT_THAT(layout.texts, Contains(testing::AllOf(Field(&SheetText::text, "0.0001235"),
                                                    Field(&SheetText::upright, true))));
}

TEST_F(SheetLayoutTest, AnAxisOfOneValueIsToldInTheTitleAndTakesNoRoom) {
  const SheetLayout one = lay_out(sweep({5, 1, 1, 1}));
  EXPECT_THAT(strings(one), Contains(HasSubstr("roughness r = 0.3  \u00b7  scattering s = 0.3")));
  EXPECT_THAT(strings(one), Not(Contains("roughness r")));
  EXPECT_LT(one.cell({0, 0, 0, 0}).x, lay_out(sweep({5, 2, 1, 1})).cell({0, 0, 0, 0}).x);
  EXPECT_THAT(strings(lay_out(sweep({5, 1, 1, 1}))), Contains(HasSubstr("absorber-0")));
}

TEST_F(SheetLayoutTest, PanelsWrapAndGroupsStartRows) {
  const SheetLayout wrapped = lay_out(sweep({5, 5, 6, 1}));
  EXPECT_EQ(wrapped.cell({0, 0, 0, 0}).y, wrapped.cell({0, 0, 2, 0}).y);
  EXPECT_LT(wrapped.cell({0, 0, 0, 0}).y, wrapped.cell({0, 0, 3, 0}).y);
  const SheetLayout row = lay_out(sweep({5, 5, 3, 1}));
  EXPECT_EQ(row.cell({0, 0, 0, 0}).y, row.cell({0, 0, 2, 0}).y);
  const SheetLayout grouped = lay_out(sweep({5, 5, 3, 2}));
  EXPECT_EQ(grouped.cell({0, 0, 0, 0}).x, grouped.cell({0, 0, 0, 1}).x);
  EXPECT_LT(grouped.cell({0, 0, 2, 0}).y, grouped.cell({0, 0, 0, 1}).y);
}

TEST_F(SheetLayoutTest, PicturesKeepTheirAspectAndAreNeverEnlarged) {
  const SheetLayout wide = lay_out(sweep({2, 2, 1, 1}, 640, 320));
  EXPECT_EQ(wide.thumbnail_width, 128);
  EXPECT_EQ(wide.thumbnail_height, 64);
  const SheetLayout tiny = lay_out(sweep({2, 2, 1, 1}, 9, 7));
  EXPECT_EQ(tiny.thumbnail_width, 9);
  EXPECT_EQ(tiny.thumbnail_height, 7);
  EXPECT_GE(tiny.cell({0, 0, 0, 0}).width, 10);
}

TEST_F(SheetLayoutTest, RefusesWhatDoesNotFit) {
  EXPECT_THROW(lay_out_sheet(sweep({600, 2, 1, 1}), font_), SheetError);
  EXPECT_THROW(lay_out_sheet(sweep({100000, 1, 1, 1}), font_), SheetError);
  EXPECT_THROW(lay_out_sheet(sweep({1000, 1000, 1000, 1}), font_), SheetError);
  EXPECT_THROW(lay_out_sheet(sweep({1, 1, 600, 900}), font_), SheetError);
  SheetSpec large = sweep({1000, 1, 1, 1}, 20000, 20000);
  large.cell_size = 20000;
  EXPECT_THROW(lay_out_sheet(large, font_), SheetError);
  SheetSpec small = sweep({5, 5, 1, 1});
  small.max_pixels = 160 * 160;
  try {
    lay_out_sheet(small, font_);
    FAIL();
  } catch (const SheetError& error) {
    EXPECT_THAT(error.what(), HasSubstr("5 x 5 x 1 x 1 cells"));
    EXPECT_THAT(error.what(), HasSubstr("25600"));
  }
}

TEST_F(SheetLayoutTest, RefusesWhatIsNoSheet) {
  SheetSpec spec = sweep({2, 2, 1, 1});
  spec.axes[2].labels.clear();
  EXPECT_THROW(lay_out_sheet(spec, font_), std::invalid_argument);
  EXPECT_THROW(lay_out_sheet(sweep({2, 2, 1, 1}, 0, 10), font_), std::invalid_argument);
  const SheetLayout layout = lay_out(sweep({2, 3, 1, 1}));
  EXPECT_THROW(layout.cell({2, 0, 0, 0}), std::out_of_range);
  EXPECT_THROW(layout.cell({0, -1, 0, 0}), std::out_of_range);
}

}  // namespace
}  // namespace translucube

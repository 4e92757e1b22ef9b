// Text: where its ink lies, how it is shortened, and what numbers are called.

#include "picture/sheet/text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <vector>

#include "tests/support/repository.h"

namespace translucube {
namespace {

using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;

class Text : public testing::Test {
 protected:
  const Font font_ = find_font();
};

double ink(const TextMask& mask) {
  return std::accumulate(mask.coverage.begin(), mask.coverage.end(), 0.0);
}

TEST_F(Text, CoversSomeOfItsMaskAndStaysWithinZeroAndOne) {
  for (const int size : {10, 13, 24}) {
    const TextMask mask = font_.draw("absorption gj 0.25", size);
    EXPECT_EQ(mask.width, font_.width("absorption gj 0.25", size));
    EXPECT_EQ(mask.height, font_.line_height(size));
    const auto [least, most] = std::minmax_element(mask.coverage.begin(), mask.coverage.end());
    EXPECT_EQ(*least, 0);
    EXPECT_GT(*most, 0.8f) << size;
    EXPECT_LE(*most, 1);
    EXPECT_GT(ink(mask), 0.05 * mask.width * mask.height);
  }
}

TEST_F(Text, NoInkIsCutOffAtTheBorders) {
  const TextMask mask = font_.draw("\u00c5jWf", 18);
  const auto at = [&](int x, int y) { return mask.coverage[std::size_t(y) * mask.width + x]; };
  for (int x = 0; x < mask.width; ++x) {
    EXPECT_EQ(at(x, 0), 0);
    EXPECT_EQ(at(x, mask.height - 1), 0);
  }
  const TextMask twice = font_.draw("\u00c5jWf \u00c5jWf", 18);
  EXPECT_NEAR(ink(twice), 2 * ink(mask), 0.01 * ink(twice));
}

TEST_F(Text, WidthGrowsWithTheSizeAndTheTextAndIsKerned) {
  EXPECT_NEAR(font_.width("roughness", 20), 2 * font_.width("roughness", 10), 3);
  EXPECT_GT(font_.width("roughness r", 10), font_.width("roughness", 10));
  EXPECT_LT(font_.width_em("AVAV"), 2 * font_.width_em("A") + 2 * font_.width_em("V") - 0.05);
  EXPECT_EQ(font_.width_em(""), 0);
}

TEST_F(Text, IsShortenedWithAnEllipsisOnlyWhereItDoesNotFit) {
  const std::string text = "ultramarine blue";
  const int whole = font_.width(text, 12);
  EXPECT_EQ(font_.shorten(text, 12, whole), text);
  std::size_t before = 0;
  for (int room = 0; room < whole; ++room) {
    const std::string fitting = font_.shorten(text, 12, room);
    if (fitting.empty()) continue;
    EXPECT_LE(font_.width(fitting, 12), room);
    EXPECT_THAT(fitting, EndsWith("\u2026"));
    EXPECT_EQ(fitting.rfind(text.substr(0, fitting.size() - 3), 0), 0u);
    EXPECT_GE(fitting.size(), before);
    before = fitting.size();
  }
  EXPECT_GT(before, text.size() / 2);
  EXPECT_EQ(font_.shorten(text, 12, 3), "");
}

TEST_F(Text, CodePointsAreNotCutAndMalformedOnesAreReplaced) {
  EXPECT_NEAR(font_.width_em("\u03b1\u03b2"), font_.width_em("\u03b1") + font_.width_em("\u03b2"),
              0.05);
  const std::string shortened = font_.shorten("\u03b1\u03b2\u03b3\u03b4\u03b5\u03b6", 12, 30);
  EXPECT_EQ((shortened.size() - 3) % 2, 0u) << shortened;
  const double replacement = font_.width_em("\ufffd");
  EXPECT_DOUBLE_EQ(font_.width_em("\xff"), replacement);
  EXPECT_DOUBLE_EQ(font_.width_em("\xce"), replacement);
  EXPECT_GT(ink(font_.draw("\xe2\x80", 12)), 0);
}

TEST(FindFont, NamesEveryFileThatIsMissing) {
  const std::vector<std::filesystem::path> files = {"/nowhere/a.ttf", "/nowhere/b.ttf"};
  try {
    find_font(files);
    FAIL();
  } catch (const TextError& error) {
    EXPECT_THAT(error.what(), HasSubstr("/nowhere/a.ttf, /nowhere/b.ttf"));
    EXPECT_THAT(error.what(), HasSubstr("fonts-dejavu-core"));
  }
}

TEST(FindFont, RefusesWhatIsNoFont) {
  const std::vector<std::filesystem::path> files = {in_repository("CMakeLists.txt")};
  EXPECT_THROW(find_font(files), TextError);
}

TEST(NumberLabels, AreTheShortestText) {
  EXPECT_THAT(number_labels(std::vector{0.0, 0.3, 0.1 + 0.2 - 0.05, 1.0}),
              ElementsAre("0", "0.3", "0.25", "1"));
  EXPECT_THAT(number_labels(std::vector{1.0 / 3, 0.0375, 1e-6}),
              ElementsAre("0.3333", "0.0375", "1e-06"));
}

TEST(NumberLabels, TellDifferentValuesApart) {
  EXPECT_THAT(number_labels(std::vector{0.99999, 1.0}), ElementsAre("0.99999", "1"));
  EXPECT_THAT(number_labels(std::vector{0.5, 0.5}), ElementsAre("0.5", "0.5"));
  EXPECT_THAT(number_labels(std::vector{0.1, 0.1 + 0x1p-56}), testing::SizeIs(2));
}

}  // namespace
}  // namespace translucube

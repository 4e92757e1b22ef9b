#include "api/base/json_reader.h"

#include <gtest/gtest.h>

#include <cmath>

namespace translucube::api {
namespace {

constexpr std::uint64_t roomy = 1 << 20;

JsonDocument document(std::string_view text) {
  auto result = read_json(text, roomy);
  if (!result) {
    ADD_FAILURE() << to_text(result.problem());
    return {};
  }
  return *std::move(result);
}

Problem problem(std::string_view text, std::uint64_t most_bytes = roomy) {
  auto result = read_json(text, most_bytes);
  if (result) {
    ADD_FAILURE() << "accepted: " << text;
    return {};
  }
  return result.problem();
}

TEST(JsonReader, ReadsWhatItIsGiven) {
  const std::string text =
      R"( {"a":[1,-2,2.5,1e3,true,false,null,"\u20ac\ud83d\ude00\n/"],"b":{"c":[]},"":{}} )";
  const JsonDocument read = document(text);
  EXPECT_TRUE(read.faults.empty());
  EXPECT_EQ(read.value, nlohmann::json::parse(text));
}

TEST(JsonReader, ReadsScalarsAsDocuments) {
  EXPECT_EQ(document("7").value, 7);
  EXPECT_EQ(document("\"x\"").value, "x");
  EXPECT_TRUE(document("null").value.is_null());
}

TEST(JsonReader, FindsEveryDuplicateKey) {
  const auto faults = document(R"({"a":1,"a":2,"b":[{},{"c/d":1,"c/d":{"e":1,"e":2}}]})").faults;
  EXPECT_EQ(faults.list(), (std::vector<Fault>{{"/a", "duplicate key"},
                                               {"/b/1/c~1d", "duplicate key"},
                                               {"/b/1/c~1d/e", "duplicate key"}}));
}

TEST(JsonReader, SameKeyInTwoObjectsIsNoDuplicate) {
  EXPECT_TRUE(document(R"({"a":{"x":1},"b":{"x":1},"c":[{"x":1},{"x":1}]})").faults.empty());
}

TEST(JsonReader, FindsEveryNumberThatIsTooLarge) {
  const JsonDocument read = document(R"({"a":1e999,"b":[0,-1e400],"c":1,"a":2})");
  EXPECT_EQ(read.faults.list(),
            (std::vector<Fault>{{"/a", "must be a number within double precision"},
                                {"/b/1", "must be a number within double precision"},
                                {"/a", "duplicate key"}}));
  EXPECT_TRUE(std::isnan(read.value["b"][1].get<double>()));
  EXPECT_EQ(read.value["b"][0], 0);
  EXPECT_EQ(read.value["c"], 1);
}

TEST(JsonReader, StopsAtTheNinthNumberThatIsTooLarge) {
  std::string text = "[1e999";
  for (int i = 0; i < 20; ++i) text += ",1e999";
  const Problem refused = problem(text + "]");
  EXPECT_EQ(refused.code, ProblemCode::invalid_request);
  EXPECT_EQ(refused.faults.size(), 9u);
}

TEST(JsonReader, LargestAndSmallestDoublesAreRead) {
  const JsonDocument read = document("[1.7976931348623157e308,5e-324,1e-999]");
  EXPECT_TRUE(read.faults.empty());
  EXPECT_EQ(read.value[0], 1.7976931348623157e308);
  EXPECT_EQ(read.value[1], 5e-324);
}

TEST(JsonReader, TakesSixteenLevelsAndNoMore) {
  EXPECT_TRUE(document(std::string(16, '[') + std::string(16, ']')).faults.empty());
  const Problem refused = problem(std::string(17, '[') + std::string(17, ']'));
  EXPECT_EQ(refused.code, ProblemCode::invalid_request);
  ASSERT_EQ(refused.faults.size(), 1u);
  EXPECT_EQ(refused.faults[0].pointer, "/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0/0");
}

TEST(JsonReader, DepthIsNotTheNumberOfContainers) {
  std::string text = "[";
  for (int i = 0; i < 1000; ++i) text += "[[]],{},";
  EXPECT_TRUE(document(text + "[]]").faults.empty());
}

TEST(JsonReader, TellsTheByteOfASyntaxError) {
  EXPECT_EQ(problem(R"({"a":1,})").detail, "not JSON near byte 7 of 8");
  EXPECT_EQ(problem("x").detail, "not JSON near byte 0 of 1");
  EXPECT_EQ(problem("{} x").detail, "not JSON near byte 3 of 4");
  EXPECT_EQ(problem("{\"a\"").detail, "the document ends too early, after 4 bytes");
  EXPECT_EQ(problem("").detail, "the document ends too early, after 0 bytes");
}

TEST(JsonReader, NeverEchoesTheDocument) {
  for (const char* text : {R"({"secret" 1})", "secret", R"({"a":"secret)", R"(["secret)",
                           "{\"a\":\"secret\x01\"}", "[secret]"}) {
    const Problem refused = problem(text);
    EXPECT_EQ(refused.code, ProblemCode::malformed_json);
    EXPECT_EQ(to_json(refused).find("secret"), std::string::npos) << text;
  }
}

TEST(JsonReader, RefusesAByteOrderMark) {
  EXPECT_EQ(problem("\xEF\xBB\xBF{}").code, ProblemCode::malformed_json);
}

TEST(JsonReader, RefusesAZeroByteAnywhere) {
  using namespace std::string_view_literals;
  EXPECT_EQ(problem("{}\0"sv).detail, "not JSON near byte 2 of 3");
  EXPECT_EQ(problem("{}\0garbage"sv).code, ProblemCode::malformed_json);
  EXPECT_EQ(problem("\"a\0b\""sv).code, ProblemCode::malformed_json);
}

TEST(JsonReader, RefusesTextThatIsNotUtf8) {
  for (const char* text :
       {"\"\x80\"", "\"\xc0\xaf\"", "\"\xed\xa0\x80\"", "\"\xf4\x90\x80\x80\"", "{\"\xff\":1}"})
    EXPECT_EQ(problem(text).code, ProblemCode::malformed_json);
}

TEST(JsonReader, RefusesMoreBytesThanAllowed) {
  EXPECT_EQ(problem("[1,2]", 4).code, ProblemCode::payload_too_large);
  EXPECT_TRUE(read_json("[1,2]", 5));
}

TEST(JsonReader, SyntaxErrorAfterOtherFaultsIsASyntaxError) {
  EXPECT_EQ(problem(R"({"a":1,"a":1e999,)").code, ProblemCode::malformed_json);
}

}  // namespace
}  // namespace translucube::api

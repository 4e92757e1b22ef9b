#include <algorithm>
#include <ctime>
#include <set>

#include "api/base/faults.h"
#include "tests/api/fixture.h"
#include "tests/support/malformed_corpus.h"

namespace translucube::api {
namespace {

const std::vector<test::MalformedBody>& corpus() {
  static const auto bodies = test::malformed_bodies();
  return bodies;
}

TEST(MalformedCorpus, HasTwoHundredDifferentBodies) {
  std::set<std::string> texts;
  for (const auto& body : corpus()) texts.insert(body.text);
  EXPECT_EQ(texts.size(), corpus().size());
  EXPECT_GE(texts.size(), 200u);
}

TEST(MalformedCorpus, IsAnsweredWithTheExpectedProblem) {
  for (const auto& body : corpus()) {
    const auto result = parse_render_request(body.text, shipped_catalog());
    ASSERT_FALSE(result) << body.name << " was accepted";
    const Problem& problem = result.problem();
    EXPECT_EQ(kind(problem.code).status, body.status) << body.name << '\n' << to_text(problem);
    if (body.status == 422) {
      const bool told =
          std::any_of(problem.faults.begin(), problem.faults.end(),
                      [&](const Fault& fault) { return fault.pointer == body.pointer; });
      EXPECT_TRUE(told) << body.name << " wants " << body.pointer << '\n' << to_text(problem);
    } else {
      EXPECT_TRUE(problem.faults.empty()) << body.name;
    }
    EXPECT_LE(problem.faults.size(), Faults::most + 1) << body.name;
  }
}

TEST(MalformedCorpus, HasOneFaultForEachBodyThatSaysOneThingWrong) {
  // A fault must not drag others along. These bodies do hold several.
  const std::set<std::string> several{"many-faults",
                                      "overflow-and-unknown-key",
                                      "cube-empty",
                                      "coefficients-empty",
                                      "absorber-no-wavelengths",
                                      "mesh-with-radius",
                                      "duplicate-unknown-key",
                                      "duplicate-in-array-of-objects",
                                      "camera-up-strings",
                                      "environment-image-and-file",
                                      "environment-all-three"};
  for (const auto& body : corpus()) {
    if (!body.name.ends_with(".json") || body.status != 422) continue;
    const std::string what = body.name.substr(4, body.name.size() - 9);
    const auto result = parse_render_request(body.text, shipped_catalog());
    const auto& faults = result.problem().faults;
    if (several.contains(what))
      EXPECT_GT(faults.size(), 1u) << body.name;
    else
      EXPECT_EQ(faults.size(), 1u) << body.name << '\n' << to_text(result.problem());
  }
}

TEST(MalformedCorpus, IsAnsweredInMilliseconds) {
  double slowest = 0;
  std::string which;
  for (const auto& body : corpus()) {
    // CPU time, and of three: other processes must not fail this test.
    double fastest = 1e9;
    for (int i = 0; i < 3; ++i) {
      const std::clock_t start = std::clock();
      const auto result = parse_render_request(body.text, shipped_catalog());
      const std::string answer = to_json(result.problem());
      const double ms = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
      fastest = std::min(fastest, ms);
      if (fastest < 10) break;
    }
    if (fastest > slowest) slowest = fastest, which = body.name;
  }
  RecordProperty("slowest", which);
  RecordProperty("milliseconds", std::to_string(slowest));
  // A mebibyte of hostile keys in a debug build with sanitizers; a release build needs less than
  // half.
  EXPECT_LT(slowest, 2000) << which;
}

TEST(MalformedCorpus, AnswersStaySmallWhateverTheBody) {
  for (const auto& body : corpus()) {
    const auto result = parse_render_request(body.text, shipped_catalog());
    EXPECT_LT(to_json(result.problem()).size(), 64u << 10) << body.name;
  }
}

}  // namespace
}  // namespace translucube::api

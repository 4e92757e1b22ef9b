// The version stands in one place, CMakeLists.txt, and is told in six.

#include "picture/version.h"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "api/openapi.h"
#include "server/base/metrics.h"
#include "tests/server/fixture.h"
#include "tests/server/process/process.h"

namespace translucube::server::test {
namespace {

using testing::HasSubstr;

TEST(VersionTest, IsToldTheSameByAllThatTellIt) {
  const std::string version(project_version());
  EXPECT_THAT(version, testing::MatchesRegex("[0-9]+\\.[0-9]+\\.[0-9]+"));
  EXPECT_EQ(run_translucube({"--version"}).output, "translucube " + version + '\n');
  const auto document = nlohmann::json::parse(api::openapi_document());
  EXPECT_EQ(document["info"]["version"], version);
  EXPECT_THAT(Metrics().text(),
              HasSubstr("\ntranslucube_build_info{version=\"" + version + "\"} 1\n"));

  const TempFolder folder;
  const std::string exr = (folder / "a.exr").string(), png = (folder / "a.png").string();
  const Ran ran = run_translucube({"render", "-", "-o", exr, "-o", png}, small_request(1));
  ASSERT_EQ(ran.status, 0) << ran.errors;
  EXPECT_THAT(OpenFile::open(exr)->read_all(), HasSubstr("Translucube " + version));
  EXPECT_THAT(OpenFile::open(png)->read_all(),
              HasSubstr("Translucube " + version + ", pixels in "));
}

TEST(VersionTest, TheChangelogSaysWhatIsNewInIt) {
  std::ifstream changelog(in_repository("CHANGELOG.md"));
  std::string line;
  while (std::getline(changelog, line) && !line.starts_with("## ")) {
  }
  EXPECT_THAT(line, testing::StartsWith("## " + std::string(project_version()) + " ("));
}

}  // namespace
}  // namespace translucube::server::test

// What the command line writes: never over what it reads, through links, with the mode that is
// there, told by its own name where it cannot, and never at the cost of another output.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/server/fixture.h"
#include "tests/server/process/process.h"
#include "tests/server/temp_folder.h"

namespace translucube::server::test {
namespace {

using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class OutputFilesTest : public testing::Test {
 protected:
  OutputFilesTest() {
    write("r.json", small_request(4));
    std::string explorable = small_request(4);
    explorable.insert(1, R"("explorable":true,)");
    write("x.json", explorable);
    write("s.json", R"({"base":)" + small_request(4) + R"(,"axes":{"roughness":[0,1]}})");
    write("slab.json", R"({"material":{"cube":{"absorption":0.3,"roughness":0,"scattering":0}},"slab":{"thickness_mm":1}})");
  }

  void write(const std::string& name, const std::string& text) {
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }

  /// By a shell, in the folder.
  int shell(const std::string& command) const {
    const int status = std::system(("cd '" + folder_.path().string() + "' && " + command).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

  TempFolder folder_;
  const std::string program_ = TRANSLUCUBE_BINARY;
};

TEST_F(OutputFilesTest, AreNeverOneWithAnotherOrWithWhatIsRead) {
  ASSERT_EQ(run_translucube(
                {"render", at("x.json"), "-o", at("p.png"), "--explorable-out", at("film.exr")})
                .status,
            0);
  write("map.exr", text_of(folder_ / "film.exr"));
  fs::create_symlink("film.exr", folder_ / "link.exr");
  fs::create_hard_link(folder_ / "film.exr", folder_ / "twin.exr");
  fs::create_symlink("new.exr", folder_ / "dangling.exr");
  fs::create_directory(folder_ / "out");
  write("out/sweep.json", text_of(folder_ / "s.json"));
  const std::string film = text_of(folder_ / "film.exr"), request = text_of(folder_ / "r.json");
  const std::vector<std::vector<std::string>> commands{
      {"develop", at("film.exr"), "-o", at("film.exr")},
      {"develop", at("film.exr"), "-o", at("link.exr")},
      {"develop", at("link.exr"), "-o", at("film.exr")},
      {"develop", at("film.exr"), "-o", at("twin.exr")},
      {"develop", at("film.exr"), "-o", at("./out/../film.exr")},
      {"render", at("x.json"), "-o", at("new.exr"), "--explorable-out", at("new.exr")},
      {"render", at("x.json"), "-o", at("new.exr"), "--explorable-out", at("dangling.exr")},
      {"render", at("r.json"), "-o", at("new.exr"), "-o", at("new.exr")},
      {"render", at("r.json"), "-o", at("new.exr"), "--stats", at("new.exr")},
      {"render", at("r.json"), "-o", at("new.exr"), "--stats", at("r.json")},
      {"appearance", at("slab.json"), "-o", at("slab.json")},
      {"sweep", at("out/sweep.json"), "-o", at("out")}};
  const std::string slab = text_of(folder_ / "slab.json"), sweep = text_of(folder_ / "s.json");
  for (const auto& command : commands) {
    const Ran ran = run_translucube(command);
    SCOPED_TRACE(testing::PrintToString(command));
    EXPECT_EQ(ran.status, 2);
    EXPECT_THAT(ran.errors, HasSubstr("is the same file as"));
    EXPECT_EQ(text_of(folder_ / "film.exr"), film);
    EXPECT_EQ(text_of(folder_ / "r.json"), request);
    EXPECT_EQ(text_of(folder_ / "slab.json"), slab);
    EXPECT_EQ(text_of(folder_ / "out/sweep.json"), sweep);
    EXPECT_FALSE(fs::exists(folder_ / "new.exr"));
  }
}

TEST_F(OutputFilesTest, KeepLinksAndModes) {
  fs::create_directory(folder_ / "real");
  write("real/t.exr", "old");
  fs::create_symlink("real/t.exr", folder_ / "link.exr");
  fs::create_symlink("real/new.exr", folder_ / "dangling.exr");
  fs::create_symlink("link.exr", folder_ / "chain.exr");
  write("private.exr", "old");
  ASSERT_EQ(::chmod(at("private.exr").c_str(), 0600), 0);
  for (const char* name : {"link.exr", "dangling.exr", "chain.exr", "private.exr"})
    EXPECT_EQ(run_translucube({"render", at("r.json"), "-o", at(name)}).status, 0) << name;
  for (const char* name : {"link.exr", "dangling.exr", "chain.exr"})
    EXPECT_TRUE(fs::is_symlink(folder_ / name)) << name;
  EXPECT_NE(text_of(folder_ / "real/t.exr"), "old");
  EXPECT_TRUE(fs::is_regular_file(folder_ / "real/new.exr"));
  EXPECT_EQ(fs::status(folder_ / "private.exr").permissions(),
            fs::perms::owner_read | fs::perms::owner_write);
}

TEST_F(OutputFilesTest, ThatCannotBeWrittenAreToldBeforeTheWork) {
  write("long.json", small_request(1'000'000));
  for (const char* file : {"/proc/a.exr", "/nowhere/a.exr", "/dev/null.exr/a.exr"}) {
    const Ran ran = run_translucube({"render", at("long.json"), "-o", file});
    EXPECT_EQ(ran.status, 1) << file;
    EXPECT_THAT(ran.errors, Not(HasSubstr(".translucube"))) << file;
  }
}

TEST_F(OutputFilesTest, AFailureCostsNoOtherOutputAndNamesItself) {
  write("large.json", small_request(4, 1, 64));
  // No file longer than 8 KiB: a picture of 64 x 64 pixels in EXR has 49.
  EXPECT_EQ(shell("trap '' XFSZ; ulimit -f 8; exec '" + program_ +
                  "' render large.json -o large.exr --stats stats.json 2>errors"),
            1);
  EXPECT_THAT(text_of(folder_ / "stats.json"), HasSubstr("samples"));
  EXPECT_FALSE(fs::exists(folder_ / "large.exr"));
  EXPECT_THAT(text_of(folder_ / "errors"), HasSubstr("large.exr: "));
  for (const auto& entry : fs::directory_iterator(folder_.path()))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".")) << entry.path();
}

TEST_F(OutputFilesTest, StandardOutputThatTakesNothingIsAnError) {
  for (const char* arguments :
       {"token --name a", "render r.json --pixel 0,0", "sweep s.json --dry-run",
        "appearance slab.json", "--version", "--help", "render --help"}) {
    EXPECT_EQ(shell("'" + program_ + "' " + arguments + " >/dev/full 2>errors"), 1) << arguments;
    EXPECT_THAT(text_of(folder_ / "errors"), HasSubstr("standard output cannot be written"))
        << arguments;
  }
}

TEST_F(OutputFilesTest, ACameraInTheBodyIsTold) {
  std::string inside = small_request(4);
  inside.insert(1, R"("scene":{"camera":{"position_mm":[0,0,5]}},)");
  write("inside.json", inside);
  const Ran ran =
      run_translucube({"render", at("inside.json"), "-o", at("i.exr"), "--stats", at("i.json")});
  EXPECT_EQ(ran.status, 0);
  EXPECT_THAT(ran.errors, HasSubstr("The camera is inside the body."));
  EXPECT_THAT(text_of(folder_ / "i.json"), HasSubstr("\"camera_inside\": true"));
}

}  // namespace
}  // namespace translucube::server::test

// A data folder that an old version has written serves the new one.

#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "picture/image_io.h"
#include "server/store/sqlite/connection.h"
#include "tests/server/fixture.h"
#include "tests/support/repository.h"

namespace translucube::server::test {
namespace {

using api::JobState;

constexpr const char* succeeded = "01KDVDNAZ8M8S4386A9CRDCD44";
constexpr const char* failed = "01KDVDNBYG4746X3GD750SXPNE";
constexpr const char* running = "01KDVDNCXR7B4294NRVYWVBWQH";
constexpr const char* canceled = "01KDVDNDX0FENRNE4DREK4CFPF";
constexpr const char* queued = "01KDVDNEW8NABJ6EB62CGSMDQ2";

/// As version 1 left it: a picture lies in the folder of its render.
void write_version_1(const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  const DataFolder data(folder);
  std::ifstream file(in_repository("tests/server/store/store_v1.sql"));
  const std::string statements(std::istreambuf_iterator<char>(file), {});
  sql::Connection(data.store_file(), sql::Connection::Access::read_write).execute(statements);
  std::filesystem::create_directories(data.artifacts() / succeeded);
  write_image(data.artifacts() / succeeded / "image-0-1.exr", Image(8, 8), ImageFormat::exr,
              {"{}", "lin_rec709"});
}

TEST(StoreUpgrade, WhatVersion1HadIsThere) {
  const TempFolder folder;
  write_version_1(folder.path());
  FakeRenderer renderer;
  TestService service(folder.path(), renderer.engine());

  const api::RenderStatus done = service.wait(succeeded);
  EXPECT_EQ(done.state, JobState::succeeded);
  EXPECT_EQ(done.progress.samples, 24u);
  EXPECT_THAT(done.stats.value_or(""), testing::HasSubstr(R"("transport":"walk")"));
  EXPECT_FALSE(service.exr(succeeded).empty());
  const api::RenderStatus broken = service.wait(failed);
  EXPECT_EQ(broken.state, JobState::failed);
  EXPECT_THAT(broken.error.value_or(""), testing::HasSubstr("/problems/internal"));
  EXPECT_EQ(service.state(canceled), JobState::canceled);
  const auto page = *service.service.list({});
  EXPECT_EQ(page.renders.size(), 5u);
}

TEST(StoreUpgrade, WhatVersion1HadNotFinishedIsFinished) {
  const TempFolder folder;
  write_version_1(folder.path());
  FakeRenderer renderer;
  TestService service(folder.path(), renderer.engine());
  for (const char* id : {running, queued}) {
    EXPECT_EQ(service.wait(id).state, JobState::succeeded) << id;
    EXPECT_EQ(service.wait(id).progress.samples, 24u) << id;
    EXPECT_FALSE(service.exr(id).empty()) << id;
  }
}

TEST(StoreUpgrade, IsDoneOnce) {
  const TempFolder folder;
  write_version_1(folder.path());
  FakeRenderer renderer;
  for (int start = 0; start < 2; ++start) {
    TestService service(folder.path(), renderer.engine());
    EXPECT_FALSE(service.exr(succeeded).empty());
    if (start == 0) {
      EXPECT_EQ(service.service.remove(failed), std::nullopt);
    }
    EXPECT_FALSE(service.service.get(failed));
  }
}

TEST(StoreUpgrade, ARenderOfVersion1IsRemovedWithItsPicture) {
  const TempFolder folder;
  write_version_1(folder.path());
  FakeRenderer renderer;
  TestService service(folder.path(), renderer.engine());
  ASSERT_TRUE(std::filesystem::exists(service.data.artifacts() / succeeded));
  EXPECT_EQ(service.service.remove(succeeded), std::nullopt);
  EXPECT_FALSE(std::filesystem::exists(service.data.artifacts() / succeeded));
}

}  // namespace
}  // namespace translucube::server::test

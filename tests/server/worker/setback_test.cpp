// What is accepted waits for the world to come back: a file that is away, a thread or memory that
// cannot be had, a disk without room.

#include <gmock/gmock.h>

#include <new>
#include <nlohmann/json.hpp>
#include <system_error>

#include "tests/server/fixture.h"
#include "tests/support/tiny_map.h"

namespace translucube::server::test {
namespace {

using api::JobState;
using api::ProblemCode;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

/// The world refuses as long as it is told to.
struct Refusing {
  std::atomic<bool> refuses = true;
  std::atomic<int> times = 0;
  std::function<void()> with;

  void operator()() {
    if (!refuses) return;
    ++times;
    with();
  }
};

SceneError unreadable(const TestService& tested) {
  return {SceneError::Part::environment,
          "cannot read " + tested.catalog.environments.at("forest").string() + ": gone"};
}

TEST(SetbackTest, ANamedEnvironmentThatCannotBeReadDelaysTheRenderHoweverLong) {
  const TempFolder folder;
  FakeRenderer renderer;
  Refusing world;
  renderer.before_build = [&](const SceneSpec&) { world(); };
  TestService tested(folder.path(), renderer.engine());
  world.with = [&] { throw unreadable(tested); };
  const std::string id = tested.submit(small_request(4)).id;
  ASSERT_TRUE(eventually([&] { return world.times >= 4; })) << "past what is refused for good";
  EXPECT_FALSE(api::is_end(tested.state(id)));
  EXPECT_TRUE(tested.service.unready_reason()) << "the service cannot do what it has accepted";
  EXPECT_THAT(*tested.service.unready_reason(), Not(HasSubstr("/")));
  EXPECT_EQ(tested.service.figures().set_back, 1u);
  EXPECT_TRUE(tested.service.submit(small_request(4, 2), {})) << "which is no reason to take none";
  world.refuses = false;
  EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
  EXPECT_TRUE(eventually([&] { return !tested.service.unready_reason(); }));
}

TEST(SetbackTest, ManyRendersWaitForAFolderThatIsAwayAndAllEndWell) {
  const TempFolder folder;
  FakeRenderer renderer;
  Refusing world;
  renderer.before_build = [&](const SceneSpec&) { world(); };
  TestService tested(folder.path(), renderer.engine(), {2, {}});
  world.with = [&] { throw unreadable(tested); };
  std::vector<std::string> ids;
  for (int seed = 1; seed <= 30; ++seed) ids.push_back(tested.submit(small_request(4, seed)).id);
  ASSERT_TRUE(eventually([&] { return world.times >= 30; }));
  world.refuses = false;
  for (const std::string& id : ids) EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
}

/// A service whose requests may name files of a folder.
struct WithFiles {
  WithFiles() {
    fs::create_directories(folder / "files");
    write_file(file, translucube::test::tiny_map);
    tested.catalog.file_folders = {folder / "files"};
  }
  std::string request() const {
    auto document = nlohmann::json::parse(small_request(4));
    document["scene"]["environment"]["file"] = file.string();
    return document.dump();
  }
  const TempFolder folder;
  const fs::path file = folder / "files/sky.exr";
  FakeRenderer renderer;
  TestService tested{folder / "data", renderer.engine()};
};

TEST(SetbackTest, AFileThatVanishesAfterItsSubmissionIsWaitedFor) {
  WithFiles with;
  with.renderer.milliseconds_per_pass = 300;
  const std::string first = with.tested.submit(small_request(4)).id;
  const std::string id = with.tested.submit(with.request()).id;
  fs::rename(with.file, with.folder / "away");
  ASSERT_TRUE(eventually([&] { return with.tested.service.figures().set_back == 1; }));
  EXPECT_FALSE(api::is_end(with.tested.state(id)));
  EXPECT_FALSE(with.tested.service.unready_reason()) << "one client's file is no other's trouble";
  fs::rename(with.folder / "away", with.file);
  EXPECT_EQ(with.tested.wait(id).state, JobState::succeeded);
  EXPECT_EQ(with.tested.wait(first).state, JobState::succeeded);
}

TEST(SetbackTest, AFileThatIsThereAndNoEnvironmentIsRefusedWithoutItsPath) {
  WithFiles with;
  with.renderer.before_build = [&](const SceneSpec&) {
    throw SceneError(SceneError::Part::environment,
                     "cannot read " + with.file.string() + ": no image");
  };
  const api::RenderStatus status = with.tested.wait(with.tested.submit(with.request()).id);
  EXPECT_EQ(status.state, JobState::failed);
  EXPECT_THAT(status.error.value(), HasSubstr("no image"));
  EXPECT_THAT(status.error.value(), Not(HasSubstr(with.folder.path().string())));
  EXPECT_EQ(with.tested.service.figures().set_back, 0u);
}

TEST(SetbackTest, AThreadThatCannotBeHadDelaysTheRender) {
  const TempFolder folder;
  FakeRenderer renderer;
  Refusing world;
  world.with = [] {
    throw std::system_error(std::make_error_code(std::errc::resource_unavailable_try_again));
  };
  renderer.before_pass = [&](const Pass&) { world(); };
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.submit(small_request(4)).id;
  ASSERT_TRUE(eventually([&] { return world.times >= 4; }));
  EXPECT_FALSE(api::is_end(tested.state(id)));
  EXPECT_TRUE(tested.service.unready_reason());
  world.refuses = false;
  EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
}

TEST(SetbackTest, MemoryThatIsThereTheNextTimeDelaysTheRenderOnly) {
  const TempFolder folder;
  FakeRenderer renderer;
  std::atomic<int> times = 0;
  renderer.before_pass = [&](const Pass&) {
    if (++times == 1) throw std::bad_alloc();
  };
  TestService tested(folder.path(), renderer.engine());
  EXPECT_EQ(tested.wait(tested.submit(small_request(4)).id).state, JobState::succeeded);
}

TEST(SetbackTest, ARenderThatCanNeverFitTheMemoryIsRefusedWhenItIsSubmitted) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine(), {.memory_bytes = 200 << 20});
  EXPECT_TRUE(tested.service.submit(small_request(4, 1, 512), {}));
  const auto refused = tested.service.submit(small_request(4, 1, 2048), {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.problem().code, ProblemCode::invalid_request);
  EXPECT_EQ(refused.problem().faults.at(0).pointer, "/image");
  EXPECT_THAT(refused.problem().faults.at(0).detail, HasSubstr("MiB of memory"));
}

TEST(SetbackTest, RendersThatDoNotFitBesideEachOtherAreTracedOneAfterTheOther) {
  const TempFolder folder;
  FakeRenderer renderer;
  renderer.milliseconds_per_pass = 20;
  TestService tested(folder.path(), renderer.engine(), {.workers = 3, .memory_bytes = 200 << 20});
  std::vector<std::string> ids;
  for (int seed = 1; seed <= 4; ++seed)
    ids.push_back(tested.submit(small_request(8, seed, 512)).id);
  for (const std::string& id : ids) EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
  EXPECT_EQ(renderer.most_tracing, 1);
}

TEST(SetbackTest, FilmsOfARenderThatWasCanceledAmidItsCheckpointGo) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService* service = nullptr;
  std::string id;
  std::atomic<bool> canceled = false;
  std::mutex mutex;
  renderer.after_pass = [&](PassFilm&) {
    const std::lock_guard lock(mutex);
    // Between the pass and what is written of it.
    if (!canceled.exchange(true)) service->store.cancel(id);
  };
  TestService tested(folder.path(), renderer.engine());
  {
    const std::lock_guard lock(mutex);
    service = &tested;
    id = tested.submit(small_request(100)).id;
  }
  EXPECT_EQ(tested.wait(id).state, JobState::canceled);
  ASSERT_TRUE(eventually([&] { return canceled.load(); }));
  EXPECT_TRUE(eventually([&] { return tested.artifacts.figures().bytes == 0; }));
}

TEST(SetbackTest, WhatEndedLongAgoIsForgottenWithItsPicture) {
  const TempFolder folder;
  FakeRenderer renderer;
  std::atomic<std::int64_t> ago = 366LL * 86'400'000;
  ServiceOptions options;
  options.store.clock = [&] { return system_clock_ms() - ago; };
  options.keep_days = 365;
  TestService tested(folder.path(), renderer.engine(), options);
  renderer.milliseconds_per_pass = 100;
  const std::string id = tested.submit(small_request(4)).id;
  ago = 0;
  const std::string young = tested.wait(tested.submit(small_request(4, 2)).id).id;
  ago = 366LL * 86'400'000;
  const std::string old = tested.submit(small_request(4, 3)).id;
  EXPECT_TRUE(eventually([&] { return !tested.service.get(old); }));
  ago = 0;
  EXPECT_TRUE(eventually([&] { return tested.artifacts.ids().size() <= 2; }));
  EXPECT_FALSE(tested.exr(young).empty());
  EXPECT_TRUE(tested.service.get(id)) << "it ended just now";
}

}  // namespace
}  // namespace translucube::server::test

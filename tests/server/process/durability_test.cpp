// Disks that refuse, files that are not whole, clocks that jump: what was accepted is not lost, and
// what is served is whole.

#include <gmock/gmock.h>
#include <linux/capability.h>
#include <sys/resource.h>
#include <sys/syscall.h>

#include "tests/server/fixture.h"

namespace translucube::server::test {
namespace {

using api::JobState;
using api::ProblemCode;
using api::Result;
using testing::HasSubstr;

/// No file of this process can be written for as long as it lives, as on a full disk.
class FullDisk {
 public:
  FullDisk() {
    handler_ = ::signal(SIGXFSZ, SIG_IGN);
    ::getrlimit(RLIMIT_FSIZE, &limit_);
    const rlimit none{0, limit_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &none);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &limit_);
    ::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit limit_{};
  sighandler_t handler_;
};

/// This thread, and those that it starts, heed the permissions of files even where they are root's.
class WithoutPrivilege {
 public:
  WithoutPrivilege() {
    ::syscall(SYS_capget, &header_, data_.data());
    auto less = data_;
    for (const int right : {CAP_DAC_OVERRIDE, CAP_DAC_READ_SEARCH})
      less[0].effective &= ~(1u << right);
    ::syscall(SYS_capset, &header_, less.data());
  }
  ~WithoutPrivilege() { ::syscall(SYS_capset, &header_, data_.data()); }
  WithoutPrivilege(const WithoutPrivilege&) = delete;
  WithoutPrivilege& operator=(const WithoutPrivilege&) = delete;

 private:
  __user_cap_header_struct header_{_LINUX_CAPABILITY_VERSION_3, 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> data_{};
};

/// A folder, and all below it, that cannot be written.
class ReadOnly {
 public:
  explicit ReadOnly(std::filesystem::path folder) : folder_(std::move(folder)) { allow(false); }
  ~ReadOnly() { allow(true); }
  ReadOnly(const ReadOnly&) = delete;
  ReadOnly& operator=(const ReadOnly&) = delete;

 private:
  void allow(bool writing) {
    using std::filesystem::perm_options, std::filesystem::perms;
    const auto set = [&](const std::filesystem::path& path) {
      std::filesystem::permissions(path, perms::owner_write,
                                   writing ? perm_options::add : perm_options::remove);
    };
    set(folder_);
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_))
      set(entry.path());
  }
  const std::filesystem::path folder_;
};

/// Slow enough that something can happen to its disk meanwhile.
struct SlowRenderer : FakeRenderer {
  SlowRenderer() { milliseconds_per_pass = 20; }
};

/// Soon again after a disk that refused.
ServiceOptions impatient() {
  ServiceOptions options;
  options.store.lease_ms = 1000;
  return options;
}

std::string undisturbed(const std::string& request) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.submit(request).id;
  EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
  return tested.exr(id);
}

ProblemCode refusal(const Result<server::Submission>& result) {
  return result ? ProblemCode::conflict : result.problem().code;
}

const std::string long_request = small_request(200, 5);

TEST(DurabilityTest, AFullDiskRefusesNewWorkAndLosesNoneOfTheOld) {
  const TempFolder folder;
  SlowRenderer renderer;
  TestService tested(folder.path(), renderer.engine(), impatient());
  const std::string id = tested.submit(long_request).id;
  ASSERT_TRUE(eventually([&] { return renderer.passes > 2; }));
  {
    const FullDisk full;
    ASSERT_TRUE(eventually([&] { return tested.service.unready_reason().has_value(); }));
    EXPECT_EQ(refusal(tested.service.submit(small_request(4), {})), ProblemCode::storage_failure);
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    EXPECT_FALSE(api::is_end(tested.state(id))) << "status is told, and nothing has failed";
  }
  EXPECT_TRUE(eventually([&] { return !tested.service.unready_reason(); }));
  EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
  EXPECT_EQ(tested.exr(id), undisturbed(long_request));
  EXPECT_EQ(tested.wait(tested.submit(small_request(4)).id).state, JobState::succeeded);
}

TEST(DurabilityTest, AFolderThatTurnsReadOnlyMakesTheServiceUnreadyUntilItIsNot) {
  const WithoutPrivilege as_a_user;
  const TempFolder folder;
  SlowRenderer renderer;
  TestService tested(folder.path(), renderer.engine(), impatient());
  const std::string id = tested.submit(long_request).id;
  ASSERT_TRUE(eventually([&] { return renderer.passes > 2; }));
  {
    const ReadOnly locked(folder.path());
    ASSERT_TRUE(eventually([&] { return tested.service.unready_reason().has_value(); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    EXPECT_FALSE(api::is_end(tested.state(id)));
  }
  EXPECT_TRUE(eventually([&] { return !tested.service.unready_reason(); }));
  EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
  EXPECT_EQ(tested.exr(id), undisturbed(long_request));
}

TEST(DurabilityTest, AReadOnlyFolderIsNotServedAndKeepsItsWork) {
  const WithoutPrivilege as_a_user;
  const TempFolder folder;
  std::string id;
  {
    SlowRenderer renderer;
    TestService tested(folder.path(), renderer.engine());
    id = tested.submit(long_request).id;
  }
  {
    const ReadOnly locked(folder.path());
    FakeRenderer renderer;
    try {
      TestService tested(folder.path(), renderer.engine());
      ADD_FAILURE() << "it starts";
    } catch (const StoreError& error) {
      EXPECT_THAT(error.what(), HasSubstr(folder.path().string()));
    }
  }
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
  EXPECT_EQ(tested.exr(id), undisturbed(long_request));
}

TEST(DurabilityTest, AStoreCutShortIsNeitherServedNorTouched) {
  const TempFolder folder;
  std::string picture;
  {
    FakeRenderer renderer;
    TestService tested(folder.path(), renderer.engine());
    for (int seed = 1; seed <= 20; ++seed) {
      const std::string id = tested.submit(small_request(4, seed)).id;
      EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
      picture = tested.content(id);
    }
  }
  const auto store = folder / "jobs.sqlite";
  const std::string whole = read_file(store);
  for (const std::size_t size : {std::size_t(0), std::size_t(50), std::size_t(4096),
                                 std::size_t(5000), whole.size() / 2, whole.size() - 1}) {
    const std::string cut = whole.substr(0, size);
    write_file(store, cut);
    FakeRenderer renderer;
    try {
      TestService tested(folder.path(), renderer.engine());
      ADD_FAILURE() << "it starts with " << size << " of " << whole.size() << " bytes";
    } catch (const StoreError& error) {
      EXPECT_THAT(error.what(), HasSubstr("job store")) << size;
    }
    EXPECT_TRUE(read_file(store) == cut) << size;
    EXPECT_TRUE(std::filesystem::exists(folder.path() / "artifacts" / picture)) << size;
  }
  write_file(store, whole);
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string again = tested.submit(small_request(4, 20)).id;
  EXPECT_EQ(tested.state(again), JobState::succeeded);
  EXPECT_EQ(renderer.passes, 0) << "put back, it is all there";
}

TEST(DurabilityTest, AnImageCutShortIsNeverServedAndIsMadeAgain) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.submit(small_request(16)).id;
  EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
  const std::string whole = tested.exr(id);
  for (const double share : {0.0, 0.5, 0.99}) {
    const StoredResult result = *tested.store.find_result(tested.content(id));
    const auto file = tested.artifacts.path(result.content, result.image);
    std::filesystem::resize_file(
        file, static_cast<std::uintmax_t>(share * double(std::filesystem::file_size(file))));
    for (const ImageFormat format : {ImageFormat::exr, ImageFormat::png}) {
      const auto served = tested.service.image(id, {format, {}, {}, {}});
      ASSERT_FALSE(served);
      EXPECT_EQ(served.problem().code, ProblemCode::gone);
    }
    const std::string again = tested.submit(small_request(16)).id;
    EXPECT_EQ(tested.wait(again).state, JobState::succeeded);
    EXPECT_EQ(tested.exr(again), whole);
    EXPECT_EQ(tested.exr(id), whole) << "the first render has its image again, too";
  }
}

TEST(DurabilityTest, WhatCannotBeReadIsMadeAgainToo) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.submit(small_request(16)).id;
  EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
  const std::string whole = tested.exr(id);
  const StoredResult result = *tested.store.find_result(tested.content(id));
  write_file(tested.artifacts.path(result.content, result.image), std::string(whole.size(), 'x'));
  const auto served = tested.service.image(id, {ImageFormat::png, {}, {}, {}});
  ASSERT_FALSE(served);
  EXPECT_EQ(served.problem().code, ProblemCode::gone);
  EXPECT_EQ(tested.wait(tested.submit(small_request(16)).id).state, JobState::succeeded);
  EXPECT_EQ(tested.exr(id), whole);
}

TEST(DurabilityTest, AClockThatJumpsByHoursChangesNothingButTheTimesThatAreTold) {
  const TempFolder folder;
  std::atomic<std::int64_t> ahead = 0;
  SlowRenderer renderer;
  ServiceOptions options;
  options.workers = 2;
  options.store.clock = [&] { return system_clock_ms() + ahead; };
  TestService tested(folder.path(), renderer.engine(), options);
  std::vector<std::string> ids;
  constexpr std::int64_t hour = 3'600'000;
  for (const std::int64_t jump : {0L, 5 * hour, -7 * hour, 26 * hour, -30 * hour}) {
    ahead = jump;
    ids.push_back(tested.submit(small_request(200, int(ids.size()) + 1)).id);
    const int before = renderer.passes;
    ASSERT_TRUE(eventually([&] { return renderer.passes > before + 2; }));
  }
  EXPECT_TRUE(std::ranges::is_sorted(ids)) << "ids rise, whatever the clock says";
  for (std::size_t i = 0; i < ids.size(); ++i) {
    EXPECT_EQ(tested.wait(ids[i]).state, JobState::succeeded);
    EXPECT_EQ(tested.exr(ids[i]), undisturbed(small_request(200, int(i) + 1)));
  }
}

TEST(DurabilityTest, LeasesWhoseClockJumpsAreTakenOverAndNothingCountsTwice) {
  const TempFolder folder;
  std::atomic<std::int64_t> ahead = 0;
  SlowRenderer renderer;
  ServiceOptions options;
  options.workers = 2;
  // Far enough from zero to go back by hours on a machine that has just started.
  constexpr std::int64_t days = 100 * 86'400'000LL;
  options.store.lease_clock = [&] { return monotonic_clock_ms() + days + ahead; };
  TestService tested(folder.path(), renderer.engine(), options);
  const std::string id = tested.submit(long_request).id;
  for (int i = 1; i <= 8; ++i) {
    const int before = renderer.passes;
    ASSERT_TRUE(eventually([&] { return renderer.passes > before; }));
    ahead = (i % 2 == 0 ? -1 : 1) * i * 3'600'000L;
    tested.submit(small_request(4, i));  // wakes the other worker
  }
  EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
  EXPECT_EQ(tested.exr(id), undisturbed(long_request));
}

}  // namespace
}  // namespace translucube::server::test

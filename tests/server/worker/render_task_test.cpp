// Jobs from submission to image over the fake renderer: order, restarts, failures, deadlines.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <new>
#include <nlohmann/json.hpp>

#include "picture/image_io.h"
#include "tests/server/fixture.h"

namespace translucube::server::test {
namespace {

using api::JobState;
using testing::HasSubstr;
using testing::IsEmpty;

/// The picture of a request whose work nothing disturbs.
std::string undisturbed(FakeRenderer& renderer, const std::string& request) {
  const TempFolder folder;
  TestService tested(folder.path(), renderer.engine());
  std::string bytes = tested.exr(tested.wait(tested.submit(request).id).id);
  renderer.passes = renderer.most_tracing = 0;
  return bytes;
}

TEST(RenderTaskTest, AJobRunsThroughItsPassesToAnImage) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.submit(small_request(16)).id;
  const api::RenderStatus status = tested.wait(id);
  EXPECT_EQ(status.state, JobState::succeeded);
  EXPECT_EQ(status.progress.samples, 16u);
  EXPECT_EQ(renderer.passes, 4);
  EXPECT_EQ(renderer.builds, 1) << "the scene is kept between the tasks of a job";
  EXPECT_EQ(nlohmann::json::parse(*status.stats)["samples"], 16);
  EXPECT_FALSE(tested.exr(id).empty());
  EXPECT_TRUE(eventually([&] { return tested.artifacts.names(id).empty(); }))
      << "checkpoints are gone";
  EXPECT_EQ(tested.artifacts.names(tested.content(id)).size(), 1u);
}

TEST(RenderTaskTest, TheImageCarriesItsCanonicalRequest) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const api::RenderStatus status = tested.wait(tested.submit(small_request(4)).id);
  write_file(folder / "copy.exr", tested.exr(status.id));
  const ImageMetadata metadata = read_metadata(folder / "copy.exr");
  EXPECT_EQ(metadata.request, status.request);
  EXPECT_EQ(metadata.colorspace, "lin_rec709");
}

TEST(RenderTaskTest, ARestartBetweenTasksGoesOnAndGivesTheSameBits) {
  const TempFolder restarted;
  FakeRenderer renderer;
  const std::string expected = undisturbed(renderer, small_request(64));
  std::string id;
  int before = 0;
  {
    renderer.milliseconds_per_pass = 20;
    TestService tested(restarted.path(), renderer.engine());
    id = tested.submit(small_request(64)).id;
    ASSERT_TRUE(eventually([&] { return renderer.passes >= 3; }));
    tested.service.shut_down();
    before = renderer.passes;
    EXPECT_FALSE(api::is_end(tested.state(id)));
  }
  {
    renderer.milliseconds_per_pass = 0;
    TestService tested(restarted.path(), renderer.engine());
    const api::RenderStatus status = tested.wait(id);
    EXPECT_EQ(status.state, JobState::succeeded);
    EXPECT_EQ(tested.exr(id), expected);
    EXPECT_GT(status.progress.seconds, 0.04) << "time before the restart counts";
  }
  EXPECT_GE(before, 3);
  const int planned = [] {
    int passes = 0;
    while (plan_pass(static_cast<std::uint32_t>(passes), 64, 64)) ++passes;
    return passes;
  }();
  EXPECT_EQ(renderer.passes, planned) << "no finished pass was traced again";
}

TEST(RenderTaskTest, ALostCheckpointIsTracedAgainToTheSameBits) {
  const TempFolder damaged;
  FakeRenderer renderer;
  const std::string expected = undisturbed(renderer, small_request(32));
  std::string id;
  {
    renderer.milliseconds_per_pass = 20;
    TestService tested(damaged.path(), renderer.engine());
    id = tested.submit(small_request(32)).id;
    ASSERT_TRUE(eventually([&] { return renderer.passes >= 3; }));
  }
  std::filesystem::resize_file(damaged.path() / "artifacts" / id / "pass-1.film", 10);
  TestService tested(damaged.path(), renderer.engine());
  EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
  EXPECT_EQ(tested.exr(id), expected);
}

TEST(RenderTaskTest, SamplesThatAreNotFiniteFailTheRenderAndNotTheWorker) {
  const TempFolder folder;
  FakeRenderer renderer;
  renderer.after_pass = [](PassFilm& film) {
    film.counters.nan_samples = film.pass.index == 1 ? 3 : 0;
  };
  TestService tested(folder.path(), renderer.engine());
  const api::RenderStatus failed = tested.wait(tested.submit(small_request(16)).id);
  EXPECT_EQ(failed.state, JobState::failed);
  EXPECT_THAT(*failed.error, HasSubstr("3 samples that are not finite"));
  EXPECT_THAT(tested.artifacts.names(failed.id), IsEmpty());
  EXPECT_EQ(tested.wait(tested.submit(small_request(4)).id).state, JobState::succeeded);
}

struct Failure {
  std::function<void()> thrown;
  std::string said;
};

TEST(RenderTaskTest, WhateverTheRendererThrowsFailsTheRenderAndNotTheWorker) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::vector<Failure> failures{
      {[] { throw SceneError(SceneError::Part::camera, "it is behind the backdrop"); },
       R"("pointer":"/scene/camera")"},
      {[] { throw std::bad_alloc(); }, "not enough memory"},
      {[] { throw std::runtime_error("a secret path"); }, "The renderer failed"}};
  for (const Failure& failure : failures) {
    renderer.before_pass = [&](const Pass&) { failure.thrown(); };
    const api::RenderStatus status = tested.wait(tested.submit(small_request(8)).id);
    EXPECT_EQ(status.state, JobState::failed);
    EXPECT_THAT(*status.error, HasSubstr(failure.said));
    EXPECT_EQ(status.error->find("secret"), std::string::npos);
  }
  renderer.before_pass = [](const Pass&) {};
  EXPECT_EQ(tested.wait(tested.submit(small_request(8)).id).state, JobState::succeeded);
}

TEST(RenderTaskTest, ADiskThatRefusesForAWhileDelaysTheRenderOnly) {
  const TempFolder folder;
  FakeRenderer renderer;
  renderer.milliseconds_per_pass = 5;
  TestService tested(folder.path(), renderer.engine());
  std::atomic<bool> blocked = true;
  std::string id;
  std::mutex mutex;
  renderer.before_pass = [&](const Pass& pass) {
    // A plain file in the place of the job's folder: nothing can be written there.
    const std::lock_guard lock(mutex);
    if (pass.index == 0 && blocked) write_file(folder.path() / "artifacts" / id, "in the way");
  };
  {
    const std::lock_guard lock(mutex);
    id = tested.submit(small_request(8)).id;
  }
  ASSERT_TRUE(eventually([&] { return renderer.passes >= 1; }));
  ASSERT_TRUE(eventually([&] { return tested.state(id) == JobState::queued; }));
  blocked = false;
  std::filesystem::remove(folder.path() / "artifacts" / id);
  EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
}

TEST(RenderTaskTest, ATimeTargetEndsInTimeWithThePassesThatWereWhole) {
  const TempFolder folder;
  FakeRenderer renderer;
  renderer.milliseconds_per_pass = 150;
  TestService tested(folder.path(), renderer.engine());
  std::string request = small_request(4);
  request.replace(request.find(R"("samples":4)"), 11, R"("seconds":0.5)");
  const auto start = std::chrono::steady_clock::now();
  const api::RenderStatus status = tested.wait(tested.submit(request).id);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_EQ(status.state, JobState::succeeded);
  EXPECT_GE(status.progress.samples, 4u);
  EXPECT_LE(status.progress.samples, 12u);
  EXPECT_GE(took.count(), 0.45);
  EXPECT_LT(took.count(), 3);
  EXPECT_FALSE(tested.exr(status.id).empty());
}

TEST(RenderTaskTest, TheFirstPassOfATimeTargetAlwaysEnds) {
  const TempFolder folder;
  FakeRenderer renderer;
  renderer.milliseconds_per_pass = 300;
  TestService tested(folder.path(), renderer.engine());
  std::string request = small_request(4);
  request.replace(request.find(R"("samples":4)"), 11, R"("seconds":0.01)");
  const api::RenderStatus status = tested.wait(tested.submit(request).id);
  EXPECT_EQ(status.state, JobState::succeeded);
  EXPECT_EQ(status.progress.samples, 4u);
}

TEST(RenderTaskTest, AnErrorTargetStopsWhereTheEstimateMeetsIt) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  std::string request = small_request(4);
  request.replace(request.find(R"("samples":4)"), 11, R"("relative_error":0.05)");
  const api::RenderStatus status = tested.wait(tested.submit(request).id);
  EXPECT_EQ(status.state, JobState::succeeded);
  EXPECT_LE(status.progress.relative_error, 0.05);
  // The same request with the samples that it took gives the same bits.
  const api::RenderStatus same =
      tested.wait(tested.submit(small_request(static_cast<int>(status.progress.samples))).id);
  const auto pixels = [&](const std::string& id) {
    write_file(folder / "copy.exr", tested.exr(id));
    return read_image(folder / "copy.exr").pixels;
  };
  EXPECT_EQ(pixels(status.id), pixels(same.id));
}

TEST(RenderTaskTest, APassThatTwoWorkersTraceCountsOnce) {
  const TempFolder contended;
  FakeRenderer renderer;
  const std::string expected = undisturbed(renderer, small_request(24));
  // In the middle of a pass the clock of the leases jumps an hour ahead: this one has run out, and
  // another worker takes the task while the first one goes on with it.
  std::atomic<std::int64_t> jump = 0;
  std::atomic<bool> jumped = false;
  renderer.before_pass = [&](const Pass& pass) {
    if (pass.index != 2 || jumped.exchange(true)) return;
    jump = 3'600'000;
    EXPECT_TRUE(eventually([&] { return renderer.most_tracing == 2; }));
  };
  TestService tested(contended.path(), renderer.engine(),
                     {2, {.lease_clock = [&] { return monotonic_clock_ms() + jump; }}});
  const std::string id = tested.submit(small_request(24)).id;
  const api::RenderStatus status = tested.wait(id);
  EXPECT_EQ(status.state, JobState::succeeded);
  EXPECT_EQ(renderer.most_tracing, 2);
  EXPECT_EQ(status.progress.samples, 24u);
  EXPECT_EQ(tested.exr(id), expected);
}

TEST(RenderTaskTest, ARenderThatEndedTheProcessTwiceIsNotTracedAgain) {
  const TempFolder folder;
  std::string id;
  {
    FakeRenderer renderer;
    TestService tested(folder.path(), renderer.engine(), {0, {}});
    id = tested.submit(small_request(4)).id;
    tested.artifacts.write(id, "pass-0.film", "of it");
  }
  for (int i = 0; i < 2; ++i) {
    const auto store = open_job_store(folder / "jobs.sqlite");
    ASSERT_TRUE(store->claim(Priority::interactive));  // and the process dies with it
  }
  FakeRenderer renderer;
  ServiceOptions options;
  options.store.last_crashed = true;
  TestService tested(folder.path(), renderer.engine(), options);
  EXPECT_EQ(tested.wait(id).state, JobState::failed);
  EXPECT_EQ(renderer.passes, 0);
  EXPECT_THAT(tested.artifacts.names(id), IsEmpty());
}

}  // namespace
}  // namespace translucube::server::test

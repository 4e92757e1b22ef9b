// What every job store must do, whatever it stores in: sweeps, results, events and gauges.

#include <gmock/gmock.h>

#include "server/store/job_store.h"
#include "tests/server/store/job_store_under_test.h"
#include "tests/server/store/stored.h"

namespace translucube::server {
namespace {

using api::JobState;
using test::a_completion;
using test::a_job;
using test::a_sweep;
using test::JobStoreTest;
using test::submit;
using test::unknown_id;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::MatchesRegex;
using testing::SizeIs;

TEST_P(JobStoreTest, ASweepIsBatchWorkAndEndsWithItsLastImage) {
  const NewSweep asked = a_sweep({2, 1, 1}, "key");
  const auto submitted = *store.submit(asked);
  const std::string id = submitted.stored.id;
  EXPECT_EQ(submitted.stored.points, 4u);
  EXPECT_EQ(submitted.stored.images, 3u);
  EXPECT_EQ(store.submit(asked)->stored.id, id);
  EXPECT_FALSE(store.claim(Priority::interactive));
  EXPECT_TRUE(store.finish(*store.claim(Priority::batch), a_completion(), "{}", {}));
  EXPECT_EQ(store.find_sweep(id)->state, JobState::running);
  EXPECT_TRUE(store.release(*store.claim(Priority::batch)));
  EXPECT_TRUE(store.fail(*store.claim(Priority::batch), R"({"title":"no"})"));
  EXPECT_EQ(store.find_sweep(id)->state, JobState::running);
  EXPECT_FALSE(store.find_sweep(id)->finished_ms);
  EXPECT_TRUE(store.finish(*store.claim(Priority::batch), a_completion(), "{}", {}));
  EXPECT_EQ(store.find_sweep(id)->state, JobState::succeeded);
  EXPECT_TRUE(store.find_sweep(id)->finished_ms);
  const auto images = store.sweep_images(id);
  ASSERT_THAT(images, SizeIs(3));
  EXPECT_THAT(images[0].points, ElementsAre(0, 1));
  EXPECT_EQ(images[1].state, JobState::failed);
  EXPECT_EQ(images[1].error, R"({"title":"no"})");
  EXPECT_EQ(store.picture_of_point(id, 2)->state, JobState::failed);
  EXPECT_EQ(store.picture_of_point(id, 3)->content, asked.images[2][0].content);
  EXPECT_FALSE(store.picture_of_point(id, 4));
  EXPECT_THAT(store.list({}), IsEmpty()) << "its images are no renders";
  EXPECT_EQ(store.list_sweeps({JobState::succeeded, {}, 50}).at(0).id, id);
  EXPECT_THAT(store.list_sweeps({JobState::queued, {}, 50}), IsEmpty());
}

TEST_P(JobStoreTest, ASweepWithoutAnySuccessHasFailedUnlessAllWasCanceled) {
  const auto sweep = [&](std::vector<int> lanes) {
    return store.submit(a_sweep(lanes))->stored.id;
  };
  const std::string failed = sweep({1, 1});
  store.fail(*store.claim(Priority::batch), "{}");
  store.cancel(store.claim(Priority::batch)->job_id);
  EXPECT_EQ(store.find_sweep(failed)->state, JobState::failed);
  const std::string canceled = sweep({1, 1});
  for (int i = 0; i < 2; ++i) store.cancel(store.claim(Priority::batch)->job_id);
  EXPECT_EQ(store.find_sweep(canceled)->state, JobState::canceled);
}

TEST_P(JobStoreTest, ACanceledSweepKeepsWhatHasEndedAndHasNoMoreTasks) {
  const std::string id = store.submit(a_sweep({1, 1, 1}))->stored.id;
  store.finish(*store.claim(Priority::batch), a_completion(), "{}", {});
  const Task running = *store.claim(Priority::batch);
  store.cancel(id);
  EXPECT_EQ(store.find_sweep(id)->state, JobState::canceled);
  EXPECT_FALSE(store.finish(running, a_completion(), "{}", {}));
  EXPECT_FALSE(store.claim(Priority::batch));
  std::vector<JobState> states;
  for (const SweepImageState& image : store.sweep_images(id)) states.push_back(image.state);
  EXPECT_THAT(states, ElementsAre(JobState::succeeded, JobState::canceled, JobState::canceled));
}

TEST_P(JobStoreTest, RemovalTellsTheResultsThatNothingElseRefersTo) {
  const NewSweep sweep = a_sweep({2});
  const std::string id = store.submit(sweep)->stored.id;
  std::vector<StoredResult> results;
  for (const Picture& lane : sweep.images[0])
    results.push_back({lane.content, "a.exr", 10, 12, R"({"made":1})"});
  EXPECT_TRUE(store.finish(*store.claim(Priority::batch), a_completion(), "{}", results));
  NewJob render = a_job();
  render.content = results[1].content;
  const auto known = *store.submit(render);
  EXPECT_TRUE(known.stored.cached);
  EXPECT_EQ(known.stored.stats, R"({"made":1})");

  const auto unused = store.remove(id);
  ASSERT_TRUE(unused);
  ASSERT_THAT(*unused, SizeIs(1));
  EXPECT_EQ(unused->at(0).content, results[0].content);
  EXPECT_FALSE(store.find_sweep(id));
  EXPECT_THAT(store.sweep_images(id), IsEmpty());
  EXPECT_THAT(store.events_after(id, 0), IsEmpty());
  EXPECT_FALSE(store.find_result(results[0].content));
  EXPECT_TRUE(store.find_result(results[1].content));
  EXPECT_THAT(store.remove(known.stored.id).value(), SizeIs(1));
  EXPECT_EQ(store.result_bytes(), 0u);
}

TEST_P(JobStoreTest, OfResultsOfOneContentTheFirstStays) {
  const NewJob asked = a_job();
  NewJob same = a_job();
  same.content = asked.content;
  const std::string first = submit(store, asked), second = submit(store, same);
  const Task late = *store.claim(Priority::interactive, second);
  const Task early = *store.claim(Priority::interactive);
  EXPECT_FALSE(store.finish_from_results(late));
  const StoredResult result{asked.content, "early.exr", {}, 12, "{}"};
  EXPECT_TRUE(store.finish(early, a_completion(), "{}", {result}));
  EXPECT_TRUE(store.finish_from_results(late));
  EXPECT_TRUE(store.find(second)->cached);
  EXPECT_EQ(store.find_result(asked.content)->image, "early.exr");
  EXPECT_FALSE(store.find_result(asked.content)->image_bytes);
  EXPECT_FALSE(store.remove_result({asked.content, "late.exr", {}, 0, ""}));
  EXPECT_TRUE(store.remove_result(result));
  EXPECT_FALSE(store.remove_result(result));
}

TEST_P(JobStoreTest, ResultsAreToldByTheirLastUse) {
  std::vector<std::string> contents;
  for (int i = 0; i < 3; ++i) {
    now += 100'000;
    const NewJob job = a_job();
    contents.push_back(job.content);
    submit(store, job);
    store.finish(*store.claim(Priority::interactive), a_completion(), "{}",
                 {{job.content, "a.exr", 10, 10, "{}"}});
  }
  now += 100'000;
  store.touch_result(contents[0]);
  store.resize_result(contents[1], 15);
  EXPECT_EQ(store.result_bytes(), 35u);
  const auto oldest = [&](std::uint64_t bytes) {
    std::vector<std::string> told;
    for (const StoredResult& result : store.least_recently_used(bytes))
      told.push_back(result.content);
    return told;
  };
  EXPECT_THAT(oldest(0), IsEmpty());
  EXPECT_THAT(oldest(15), ElementsAre(contents[1]));
  EXPECT_THAT(oldest(16), ElementsAre(contents[1], contents[2]));
  EXPECT_THAT(oldest(1000), ElementsAre(contents[1], contents[2], contents[0]));
}

TEST_P(JobStoreTest, EventsTellTheLifeOfARenderInOrder) {
  const std::string id = submit(store);
  store.complete(*store.claim(Priority::interactive), a_completion(), {1, 4, 4});
  store.finish(*store.claim(Priority::interactive), a_completion(), "{}", {});
  std::vector<std::string> types;
  std::uint64_t number = 0;
  for (const Event& event : store.events_after(id, 0)) {
    EXPECT_EQ(event.number, ++number);
    types.push_back(event.type);
  }
  EXPECT_THAT(types, ElementsAre("state", "state", "progress", "state"));
  EXPECT_THAT(store.events_after(id, 3), SizeIs(1));
  EXPECT_THAT(store.events_after(id, ~std::uint64_t{0}), IsEmpty());
  EXPECT_THAT(store.events_after(unknown_id, 0), IsEmpty());
}

TEST_P(JobStoreTest, EventsOfASweepTellItsPoints) {
  const NewSweep sweep = a_sweep({2, 1});
  const std::string id = store.submit(sweep)->stored.id;
  store.claim(Priority::batch);
  store.cancel(id);
  const std::vector<Event> events = store.events_after(id, 0);
  const auto told = [&](std::size_t event) { return events.at(event).type + events[event].data; };
  ASSERT_THAT(events, SizeIs(4));
  EXPECT_THAT(told(0), MatchesRegex(R"(state\{.*"state":"queued"\})"));
  EXPECT_THAT(told(1), MatchesRegex(R"(points\{.*"points":\[0,1\],"state":"running"\})"));
  EXPECT_THAT(told(2), MatchesRegex(R"(state\{.*"state":"running"\})"));
  EXPECT_THAT(told(3), MatchesRegex(R"(state\{.*"state":"canceled"\})"));
}

TEST_P(JobStoreTest, GaugesCountWhatItHolds) {
  const std::string render = submit(store);
  submit(store);
  EXPECT_TRUE(store.submit(a_sweep({1, 1, 1})));
  store.finish(*store.claim(Priority::interactive), a_completion(), "{}",
               {{a_job().content, "a.exr", 10, 12, "{}"}});
  now += 2000;
  const QueueGauges gauges = store.gauges();
  EXPECT_EQ(gauges.jobs[static_cast<std::size_t>(JobState::queued)], 4u);
  EXPECT_EQ(gauges.jobs[static_cast<std::size_t>(JobState::succeeded)], 1u);
  EXPECT_EQ(gauges.sweeps[static_cast<std::size_t>(JobState::queued)], 1u);
  EXPECT_THAT(gauges.waiting_tasks, ElementsAre(1, 3));
  EXPECT_EQ(gauges.oldest_waiting_s, 2);
  EXPECT_EQ(gauges.results, 1u);
  EXPECT_EQ(gauges.result_bytes, 12u);
  EXPECT_NO_THROW(store.check_writable());
}

}  // namespace
}  // namespace translucube::server

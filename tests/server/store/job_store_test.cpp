// What every job store must do, whatever it stores in: renders and tasks. The sweeps, results and
// events are in job_store_sweeps_test.cpp.

#include "server/store/job_store.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <mutex>
#include <set>
#include <thread>

#include "tests/server/store/job_store_under_test.h"
#include "tests/server/store/stored.h"

namespace translucube::server {
namespace {

using api::JobState;
using test::a_completion;
using test::a_job;
using test::a_sweep;
using test::DurableJobStoreTest;
using test::JobStoreTest;
using test::StoreKind;
using test::submit;
using test::TempFolder;
using test::unknown_id;
using testing::ElementsAre;

// A new store adds its line.
const std::vector<StoreKind> stores{
    {"SqliteInMemory", false,
     [](const TempFolder&, const StoreOptions& options) {
       return open_job_store(":memory:", options);
     }},
    {"SqliteFile", true,
     [](const TempFolder& folder, const StoreOptions& options) {
       return open_job_store(folder / "jobs.sqlite", options);
     }},
};

std::string name_of(const testing::TestParamInfo<StoreKind>& kind) { return kind.param.name; }

std::vector<StoreKind> durable_stores() {
  std::vector<StoreKind> durable;
  std::ranges::copy_if(stores, std::back_inserter(durable), &StoreKind::durable);
  return durable;
}

INSTANTIATE_TEST_SUITE_P(Every, JobStoreTest, testing::ValuesIn(stores), name_of);
INSTANTIATE_TEST_SUITE_P(Every, DurableJobStoreTest, testing::ValuesIn(durable_stores()), name_of);

TEST_P(JobStoreTest, ASubmittedJobIsQueuedUntilItsTaskIsClaimed) {
  const std::string id = submit(store);
  EXPECT_EQ(store.find(id)->state, JobState::queued);
  EXPECT_FALSE(store.find(id)->started_ms);
  const std::optional<Task> task = store.claim(Priority::interactive);
  ASSERT_TRUE(task);
  EXPECT_EQ(task->job_id, id);
  EXPECT_EQ(task->pass, (Pass{0, 0, 4}));
  EXPECT_EQ(store.find(id)->state, JobState::running);
  EXPECT_TRUE(store.find(id)->started_ms);
}

TEST_P(JobStoreTest, TheOldestJobIsClaimedFirstUnlessAnotherIsPreferred) {
  const std::string first = submit(store), second = submit(store), third = submit(store);
  EXPECT_EQ(store.claim(Priority::interactive, third)->job_id, third);
  EXPECT_EQ(store.claim(Priority::interactive, third)->job_id, first);
  EXPECT_EQ(store.claim(Priority::interactive)->job_id, second);
  EXPECT_FALSE(store.claim(Priority::interactive));
}

TEST_P(JobStoreTest, ALeaseThatRanOutIsClaimedAgainAndItsFirstHolderIsRefused) {
  const std::string id = submit(store);
  const Task first = *store.claim(Priority::interactive);
  now += 999;
  EXPECT_FALSE(store.claim(Priority::interactive));
  now += 2;
  const Task second = *store.claim(Priority::interactive);
  EXPECT_EQ(second.pass, first.pass);
  EXPECT_GT(second.fencing_token, first.fencing_token);
  EXPECT_EQ(second.attempts, 2);

  EXPECT_FALSE(store.renew(first));
  EXPECT_FALSE(store.complete(first, a_completion(), {1, 4, 4}));
  EXPECT_FALSE(store.finish(first, a_completion(), "{}", {}));
  EXPECT_FALSE(store.fail(first, "{}"));
  EXPECT_FALSE(store.release(first));
  EXPECT_EQ(store.find(id)->progress.samples, 0u);
  EXPECT_TRUE(store.complete(second, a_completion(), {1, 4, 4}));
  EXPECT_EQ(store.find(id)->progress.samples, 4u);
}

TEST_P(JobStoreTest, ARenewedLeaseDoesNotRunOut) {
  submit(store);
  const Task task = *store.claim(Priority::interactive);
  for (int i = 0; i < 5; ++i) {
    now += 900;
    EXPECT_TRUE(store.renew(task));
    EXPECT_FALSE(store.claim(Priority::interactive));
  }
}

TEST_P(JobStoreTest, AClockSetBackNeitherLosesNorDoublesTasks) {
  const std::string first = submit(store);
  now -= 500'000;
  const std::string second = submit(store);
  EXPECT_LT(first, second);
  EXPECT_EQ(store.claim(Priority::interactive)->job_id, first);
  EXPECT_EQ(store.claim(Priority::interactive)->job_id, second);
  EXPECT_FALSE(store.claim(Priority::interactive));
}

TEST_P(JobStoreTest, CompletionStoresProgressAndPlansTheNextTask) {
  const std::string id = submit(store);
  EXPECT_TRUE(store.complete(*store.claim(Priority::interactive), a_completion(1.5), {1, 4, 8}));
  EXPECT_EQ(store.find(id)->state, JobState::running);
  EXPECT_EQ(store.find(id)->progress.relative_error, 0.5);
  EXPECT_EQ(store.find(id)->progress.eta_seconds, 3);
  const Task next = *store.claim(Priority::interactive);
  EXPECT_EQ(next.pass, (Pass{1, 4, 8}));
  EXPECT_TRUE(store.complete(next, a_completion(2), {2, 12, 8}));
  EXPECT_EQ(store.find(id)->progress.seconds, 2);
}

TEST_P(JobStoreTest, AResultThatComesTwiceCountsOnce) {
  const std::string id = submit(store);
  const Task task = *store.claim(Priority::interactive);
  EXPECT_TRUE(store.complete(task, a_completion(), {1, 4, 4}));
  EXPECT_FALSE(store.complete(task, a_completion(), {1, 4, 4}));
  EXPECT_TRUE(store.claim(Priority::interactive));
  EXPECT_FALSE(store.claim(Priority::interactive));
}

TEST_P(JobStoreTest, AFinishedJobHasItsStatsAndNoMoreTasks) {
  const std::string id = submit(store);
  EXPECT_TRUE(
      store.finish(*store.claim(Priority::interactive), a_completion(), R"({"samples":4})", {}));
  const Job job = *store.find(id);
  EXPECT_EQ(job.state, JobState::succeeded);
  EXPECT_EQ(job.stats, R"({"samples":4})");
  EXPECT_TRUE(job.finished_ms);
  EXPECT_FALSE(job.progress.eta_seconds);
  EXPECT_FALSE(store.claim(Priority::interactive));
}

TEST_P(JobStoreTest, ACanceledJobRefusesTheResultOfItsTask) {
  const std::string id = submit(store);
  const Task task = *store.claim(Priority::interactive);
  store.cancel(id);
  EXPECT_EQ(store.find(id)->state, JobState::canceled);
  EXPECT_FALSE(store.renew(task));
  EXPECT_FALSE(store.finish(task, a_completion(), "{}", {}));
  EXPECT_EQ(store.find(id)->state, JobState::canceled);
  EXPECT_FALSE(store.claim(Priority::interactive));
}

TEST_P(JobStoreTest, AnEndedJobStaysAsItEnded) {
  const std::string good = submit(store);
  store.finish(*store.claim(Priority::interactive), a_completion(), "{}", {});
  store.cancel(good);
  EXPECT_EQ(store.find(good)->state, JobState::succeeded);
  const std::string bad = submit(store);
  store.fail(*store.claim(Priority::interactive), R"({"title":"no"})");
  store.cancel(bad);
  EXPECT_EQ(store.find(bad)->state, JobState::failed);
  EXPECT_EQ(store.find(bad)->error, R"({"title":"no"})");
  store.cancel(unknown_id);
  EXPECT_FALSE(store.find(unknown_id));
}

TEST_P(JobStoreTest, AReleasedTaskWaitsForItsDelayAndCountsAsAnAttemptOnlyIfToldSo) {
  const std::string id = submit(store);
  EXPECT_TRUE(store.release(*store.claim(Priority::interactive)));
  EXPECT_EQ(store.find(id)->state, JobState::queued);
  const Task again = *store.claim(Priority::interactive);
  EXPECT_EQ(again.attempts, 1);
  EXPECT_TRUE(store.release(again, 200, true));
  EXPECT_FALSE(store.claim(Priority::interactive));
  now += 200;
  EXPECT_EQ(store.claim(Priority::interactive)->attempts, 2);
}

TEST_P(JobStoreTest, TheSameKeyAndRequestIsTheSameJobAndAnotherRequestIsRefused) {
  const auto first = *store.submit(a_job(R"({"a":1})", "key"));
  const auto again = *store.submit(a_job(R"({"a":1})", "key"));
  EXPECT_TRUE(first.created);
  EXPECT_FALSE(again.created);
  EXPECT_EQ(first.stored.id, again.stored.id);
  EXPECT_EQ(store.submit(a_job(R"({"a":2})", "key")).problem().code,
            api::ProblemCode::idempotency_mismatch);
  EXPECT_NE(submit(store, a_job(R"({"a":1})", "other")), first.stored.id);
  EXPECT_NE(submit(store, a_job(R"({"a":1})")), first.stored.id);
  EXPECT_EQ(store.list({}).size(), 3u);
}

TEST_P(JobStoreTest, ARemovedJobIsGoneWithItsTasksAndItsKey) {
  const std::string id = submit(store, a_job("{}", "key"));
  EXPECT_TRUE(store.remove(id));
  EXPECT_FALSE(store.remove(id));
  EXPECT_FALSE(store.find(id));
  EXPECT_FALSE(store.claim(Priority::interactive));
  EXPECT_TRUE(store.submit(a_job(R"({"other":1})", "key"))->created);
}

TEST_P(JobStoreTest, ListsNewestFirstByPageAndByState) {
  const std::string a = submit(store), b = submit(store), c = submit(store), d = submit(store);
  store.cancel(b);
  const auto ids = [&](const JobFilter& filter) {
    std::vector<std::string> result;
    for (const Job& job : store.list(filter)) result.push_back(job.id);
    return result;
  };
  EXPECT_THAT(ids({}), ElementsAre(d, c, b, a));
  EXPECT_THAT(ids({{}, {}, 2}), ElementsAre(d, c));
  EXPECT_THAT(ids({{}, c, 2}), ElementsAre(b, a));
  EXPECT_THAT(ids({JobState::queued, d, 50}), ElementsAre(c, a));
  EXPECT_THAT(ids({JobState::canceled, {}, 50}), ElementsAre(b));
}

TEST_P(JobStoreTest, AQueueThatIsFullTakesWhatIsThereAlreadyOnly) {
  for (int i = 0; i < 59; ++i) submit(store);
  const NewJob last = a_job();
  EXPECT_EQ(store.submit(a_sweep({1, 1})).problem().code, api::ProblemCode::queue_full);
  submit(store, last);
  EXPECT_EQ(store.submit(a_job()).problem().code, api::ProblemCode::queue_full);
  const Task task = *store.claim(Priority::interactive);
  const std::string content = store.pictures(task.job_id).at(0).content;
  EXPECT_TRUE(store.finish(task, a_completion(), "{}", {{content, "a.exr", 10, 12, "{}"}}));
  submit(store);
  NewJob again = a_job();
  EXPECT_EQ(store.submit(again).problem().code, api::ProblemCode::queue_full);
  again.content = content;
  const auto known = *store.submit(again);
  EXPECT_EQ(known.stored.state, JobState::succeeded);
  EXPECT_TRUE(known.stored.cached);
}

TEST_P(JobStoreTest, WhatWasMadeBeforeIsAsFarAsItsStatsSay) {
  submit(store);
  const Task task = *store.claim(Priority::interactive);
  const std::string content = store.pictures(task.job_id).at(0).content,
                    stats = R"({"samples":8,"relative_error":0.25,"seconds":1})";
  EXPECT_TRUE(store.finish(task, a_completion(), stats, {{content, "a.exr", 10, 12, stats}}));
  NewJob again = a_job();
  again.content = content;
  const auto known = *store.submit(again);
  EXPECT_TRUE(known.stored.cached);
  EXPECT_EQ(known.stored.progress.samples, 8u);
  EXPECT_EQ(known.stored.progress.relative_error, 0.25);
}

TEST_P(JobStoreTest, ARenderThatTakesLongBecomesBatchWork) {
  submit(store);
  EXPECT_TRUE(store.complete(*store.claim(Priority::interactive), a_completion(9), {1, 4, 4}));
  EXPECT_FALSE(store.claim(Priority::batch));
  EXPECT_TRUE(store.complete(*store.claim(Priority::interactive), a_completion(11), {2, 8, 4}));
  EXPECT_FALSE(store.claim(Priority::interactive));
  EXPECT_TRUE(store.claim(Priority::batch));
}

TEST_P(JobStoreTest, ATaskWhoseTimeIsOverFinishesItsJobWithoutItsPass) {
  const std::string id = submit(store);
  Completion completion = a_completion(7);
  completion.pass_seconds.reset();
  EXPECT_TRUE(store.finish(*store.claim(Priority::interactive), completion, "{}", {}));
  EXPECT_EQ(store.find(id)->state, JobState::succeeded);
  EXPECT_EQ(store.find(id)->progress.seconds, 7);
}

TEST_P(JobStoreTest, ManyThreadsClaimEachTaskOnce) {
  constexpr int jobs = 60;
  for (int i = 0; i < jobs; ++i) submit(store);
  std::mutex mutex;
  std::multiset<std::string> claimed;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i)
      threads.emplace_back([&] {
        while (const std::optional<Task> task = store.claim(Priority::interactive)) {
          EXPECT_TRUE(store.finish(*task, a_completion(), "{}", {}));
          const std::lock_guard lock(mutex);
          claimed.insert(task->job_id);
        }
      });
    threads.emplace_back([&] {
      for (int i = 0; i < 200; ++i) store.list({});
    });
  }
  EXPECT_EQ(claimed.size(), std::size_t(jobs));
  EXPECT_EQ(std::set(claimed.begin(), claimed.end()).size(), std::size_t(jobs));
}

TEST_P(DurableJobStoreTest, WhatWasAcceptedSurvivesAKill) {
  close();
  const pid_t child = fork();
  if (child == 0) {
    const auto dying = open();
    for (int i = 0; i < 20; ++i) submit(*dying);
    dying->finish(*dying->claim(Priority::interactive), a_completion(), "{}", {});
    dying->claim(Priority::interactive);
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  now += 1001;  // what it had claimed is free by now
  const auto reopened = open();
  EXPECT_EQ(reopened->list({JobState::succeeded, {}, 100}).size(), 1u);
  int claimable = 0;
  while (const auto task = reopened->claim(Priority::interactive)) {
    EXPECT_TRUE(reopened->finish(*task, a_completion(), "{}", {}));
    ++claimable;
  }
  EXPECT_EQ(claimable, 19);
}

TEST_P(DurableJobStoreTest, IdsKeepRisingWhenItIsOpenedAgain) {
  const std::string first = submit(store);
  close();
  now -= 1000;
  EXPECT_LT(first, submit(*open()));
}

}  // namespace
}  // namespace translucube::server

#include "server/store/job_store.h"

#include <gmock/gmock.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <set>
#include <thread>

#include "tests/server/fixture.h"

namespace translucube::server {
namespace {

using api::JobState;
using test::TempFolder;
using testing::ElementsAre;

NewJob a_job(const std::string& request = "{}", std::optional<std::string> key = {}) {
  static std::atomic<int> contents = 0;
  return {request, "{}",          std::move(key),
          64,      Pass{0, 0, 4}, "content-" + std::to_string(++contents)};
}

std::string submit(JobStore& store, const NewJob& job = a_job()) {
  return store.submit(job)->job.id;
}

TaskResult a_result(double seconds = 1) {
  TaskResult result{seconds, {}};
  result.progress.passes = 1;
  result.progress.samples = 4;
  result.progress.relative_error = 0.5;
  result.progress.seconds = seconds;
  result.progress.eta_seconds = 3;
  return result;
}

/// A store whose clock stands still until it is set.
struct Timed {
  std::int64_t now = 1'000'000;
  JobStore store{
      ":memory:",
      {.lease_ms = 1000, .clock = [this] { return now; }, .lease_clock = [this] { return now; }}};
};

TEST(JobStoreTest, ASubmittedJobIsQueuedUntilItsTaskIsClaimed) {
  JobStore store(":memory:");
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

TEST(JobStoreTest, TheOldestJobIsClaimedFirstUnlessAnotherIsPreferred) {
  JobStore store(":memory:");
  const std::string first = submit(store), second = submit(store), third = submit(store);
  EXPECT_EQ(store.claim(Priority::interactive, third)->job_id, third);
  EXPECT_EQ(store.claim(Priority::interactive, third)->job_id, first);
  EXPECT_EQ(store.claim(Priority::interactive)->job_id, second);
  EXPECT_FALSE(store.claim(Priority::interactive));
}

TEST(JobStoreTest, ALeaseThatRanOutIsClaimedAgainAndItsFirstHolderIsRefused) {
  Timed timed;
  const std::string id = submit(timed.store);
  const Task first = *timed.store.claim(Priority::interactive);
  timed.now += 999;
  EXPECT_FALSE(timed.store.claim(Priority::interactive));
  timed.now += 2;
  const Task second = *timed.store.claim(Priority::interactive);
  EXPECT_EQ(second.pass, first.pass);
  EXPECT_GT(second.fencing_token, first.fencing_token);
  EXPECT_EQ(second.attempts, 2);

  EXPECT_FALSE(timed.store.renew(first));
  EXPECT_FALSE(timed.store.complete(first, a_result(), {1, 4, 4}));
  EXPECT_FALSE(timed.store.finish(first, a_result(), true, "{}", {}));
  EXPECT_FALSE(timed.store.fail(first, "{}"));
  EXPECT_FALSE(timed.store.release(first));
  EXPECT_EQ(timed.store.find(id)->progress.samples, 0u);
  EXPECT_TRUE(timed.store.complete(second, a_result(), {1, 4, 4}));
  EXPECT_EQ(timed.store.find(id)->progress.samples, 4u);
}

TEST(JobStoreTest, ARenewedLeaseDoesNotRunOut) {
  Timed timed;
  submit(timed.store);
  const Task task = *timed.store.claim(Priority::interactive);
  for (int i = 0; i < 5; ++i) {
    timed.now += 900;
    EXPECT_TRUE(timed.store.renew(task));
    EXPECT_FALSE(timed.store.claim(Priority::interactive));
  }
}

TEST(JobStoreTest, AClockSetBackNeitherLosesNorDoublesTasks) {
  Timed timed;
  const std::string first = submit(timed.store);
  timed.now -= 500'000;
  const std::string second = submit(timed.store);
  EXPECT_LT(first, second);
  EXPECT_EQ(timed.store.claim(Priority::interactive)->job_id, first);
  EXPECT_EQ(timed.store.claim(Priority::interactive)->job_id, second);
  EXPECT_FALSE(timed.store.claim(Priority::interactive));
}

TEST(JobStoreTest, CompletionStoresProgressAndPlansTheNextTask) {
  JobStore store(":memory:");
  const std::string id = submit(store);
  EXPECT_TRUE(store.complete(*store.claim(Priority::interactive), a_result(1.5), {1, 4, 8}));
  EXPECT_EQ(store.find(id)->state, JobState::running);
  EXPECT_EQ(store.find(id)->progress.relative_error, 0.5);
  EXPECT_EQ(store.find(id)->progress.eta_seconds, 3);
  const Task next = *store.claim(Priority::interactive);
  EXPECT_EQ(next.pass, (Pass{1, 4, 8}));
  EXPECT_TRUE(store.complete(next, a_result(2), {2, 12, 8}));
  EXPECT_DOUBLE_EQ(store.traced_seconds(id), 3.5);
}

TEST(JobStoreTest, AResultThatComesTwiceCountsOnce) {
  JobStore store(":memory:");
  const std::string id = submit(store);
  const Task task = *store.claim(Priority::interactive);
  EXPECT_TRUE(store.complete(task, a_result(), {1, 4, 4}));
  EXPECT_FALSE(store.complete(task, a_result(), {1, 4, 4}));
  EXPECT_DOUBLE_EQ(store.traced_seconds(id), 1);
  EXPECT_TRUE(store.claim(Priority::interactive));
  EXPECT_FALSE(store.claim(Priority::interactive));
}

TEST(JobStoreTest, AFinishedJobHasItsStatsAndNoMoreTasks) {
  JobStore store(":memory:");
  const std::string id = submit(store);
  EXPECT_TRUE(
      store.finish(*store.claim(Priority::interactive), a_result(), true, R"({"samples":4})", {}));
  const Job job = *store.find(id);
  EXPECT_EQ(job.state, JobState::succeeded);
  EXPECT_EQ(job.stats, R"({"samples":4})");
  EXPECT_TRUE(job.finished_ms);
  EXPECT_FALSE(job.progress.eta_seconds);
  EXPECT_FALSE(store.claim(Priority::interactive));
}

TEST(JobStoreTest, ACanceledJobRefusesTheResultOfItsTask) {
  JobStore store(":memory:");
  const std::string id = submit(store);
  const Task task = *store.claim(Priority::interactive);
  EXPECT_EQ(store.cancel(id)->state, JobState::canceled);
  EXPECT_FALSE(store.renew(task));
  EXPECT_FALSE(store.finish(task, a_result(), true, "{}", {}));
  EXPECT_EQ(store.find(id)->state, JobState::canceled);
  EXPECT_FALSE(store.claim(Priority::interactive));
}

TEST(JobStoreTest, AnEndedJobStaysAsItEnded) {
  JobStore store(":memory:");
  const std::string good = submit(store);
  store.finish(*store.claim(Priority::interactive), a_result(), true, "{}", {});
  EXPECT_EQ(store.cancel(good)->state, JobState::succeeded);
  const std::string bad = submit(store);
  store.fail(*store.claim(Priority::interactive), R"({"title":"no"})");
  EXPECT_EQ(store.cancel(bad)->state, JobState::failed);
  EXPECT_EQ(store.find(bad)->error, R"({"title":"no"})");
  EXPECT_FALSE(store.cancel("01ARZ3NDEKTSV4RRFFQ69G5FAV"));
}

TEST(JobStoreTest, AReleasedTaskWaitsForItsDelayAndCountsAsAnAttemptOnlyIfToldSo) {
  Timed timed;
  const std::string id = submit(timed.store);
  EXPECT_TRUE(timed.store.release(*timed.store.claim(Priority::interactive)));
  EXPECT_EQ(timed.store.find(id)->state, JobState::queued);
  const Task again = *timed.store.claim(Priority::interactive);
  EXPECT_EQ(again.attempts, 1);
  EXPECT_TRUE(timed.store.release(again, 200, true));
  EXPECT_FALSE(timed.store.claim(Priority::interactive));
  timed.now += 200;
  EXPECT_EQ(timed.store.claim(Priority::interactive)->attempts, 2);
}

TEST(JobStoreTest, TheSameKeyAndRequestIsTheSameJobAndAnotherRequestIsRefused) {
  JobStore store(":memory:");
  const auto first = *store.submit(a_job(R"({"a":1})", "key"));
  const auto again = *store.submit(a_job(R"({"a":1})", "key"));
  EXPECT_TRUE(first.created);
  EXPECT_FALSE(again.created);
  EXPECT_EQ(first.job.id, again.job.id);
  EXPECT_EQ(store.submit(a_job(R"({"a":2})", "key")).problem().code,
            api::ProblemCode::idempotency_mismatch);
  EXPECT_NE(submit(store, a_job(R"({"a":1})", "other")), first.job.id);
  EXPECT_NE(submit(store, a_job(R"({"a":1})")), first.job.id);
  EXPECT_EQ(store.list({}).size(), 3u);
}

TEST(JobStoreTest, ARemovedJobIsGoneWithItsTasksAndItsKey) {
  JobStore store(":memory:");
  const std::string id = submit(store, a_job("{}", "key"));
  EXPECT_TRUE(store.remove(id));
  EXPECT_FALSE(store.remove(id));
  EXPECT_FALSE(store.find(id));
  EXPECT_FALSE(store.claim(Priority::interactive));
  EXPECT_TRUE(store.submit(a_job(R"({"other":1})", "key"))->created);
}

TEST(JobStoreTest, ListsNewestFirstByPageAndByState) {
  JobStore store(":memory:");
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

TEST(JobStoreTest, AReopenedStoreFreesTheTasksThatTheDeadProcessHeld) {
  const TempFolder folder;
  std::string id;
  std::optional<Task> task;
  {
    JobStore store(folder / "jobs.sqlite");
    id = submit(store);
    store.complete(*store.claim(Priority::interactive), a_result(), {1, 4, 4});
    task = store.claim(Priority::interactive);
  }
  JobStore store(folder / "jobs.sqlite");
  EXPECT_EQ(store.find(id)->state, JobState::queued);
  EXPECT_EQ(store.find(id)->progress.samples, 4u);
  EXPECT_DOUBLE_EQ(store.traced_seconds(id), 1);
  EXPECT_FALSE(store.complete(*task, a_result(), {2, 8, 4})) << "nobody holds it now";
  const Task again = *store.claim(Priority::interactive);
  EXPECT_EQ(again.pass, task->pass);
  EXPECT_EQ(again.attempts, 2);
  EXPECT_LT(id, submit(store)) << "ids keep rising over a restart";
}

TEST(JobStoreTest, WhatWasAcceptedSurvivesAKill) {
  const TempFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    JobStore store(folder / "jobs.sqlite");
    for (int i = 0; i < 20; ++i) submit(store);
    store.finish(*store.claim(Priority::interactive), a_result(), true, "{}", {});
    store.claim(Priority::interactive);
    ::kill(::getpid(), SIGKILL);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFSIGNALED(status));
  JobStore store(folder / "jobs.sqlite");
  EXPECT_EQ(store.list({JobState::queued, {}, 100}).size(), 19u);
  EXPECT_EQ(store.list({JobState::succeeded, {}, 100}).size(), 1u);
  int claimable = 0;
  while (store.claim(Priority::interactive)) ++claimable;
  EXPECT_EQ(claimable, 19);
}

std::optional<StoreError::Kind> open_failure(const std::filesystem::path& file) {
  try {
    const JobStore store(file);
  } catch (const StoreError& error) {
    EXPECT_NE(std::string(error.what()).find("job store"), std::string::npos) << error.what();
    return error.kind;
  }
  return std::nullopt;
}

TEST(JobStoreTest, AFileThatIsNoStoreIsRefused) {
  const TempFolder folder;
  test::write_file(folder / "jobs.sqlite", std::string(10'000, 'x'));
  EXPECT_EQ(open_failure(folder / "jobs.sqlite"), StoreError::Kind::corrupt);
}

TEST(JobStoreTest, AStoreCutShortIsRefused) {
  const TempFolder folder;
  {
    JobStore store(folder / "jobs.sqlite");
    for (int i = 0; i < 200; ++i) submit(store, a_job("{\"a\":\"" + std::string(500, 'a') + "\"}"));
  }
  std::filesystem::resize_file(folder / "jobs.sqlite",
                               std::filesystem::file_size(folder / "jobs.sqlite") / 2);
  EXPECT_EQ(open_failure(folder / "jobs.sqlite"), StoreError::Kind::corrupt);
}

TEST(JobStoreTest, AStoreOfANewerServiceIsRefused) {
  const TempFolder folder;
  { const JobStore store(folder / "jobs.sqlite"); }
  // Bytes 60 to 63 of the file are its user version (SQLite file format, 1.3).
  std::fstream file(folder / "jobs.sqlite", std::ios::in | std::ios::out | std::ios::binary);
  file.seekp(63).put(99);
  file.close();
  EXPECT_EQ(open_failure(folder / "jobs.sqlite"), StoreError::Kind::unavailable);
}

TEST(JobStoreTest, AStoreWhoseFolderIsNotThereIsRefused) {
  EXPECT_EQ(open_failure("/nowhere/jobs.sqlite"), StoreError::Kind::unavailable);
}

TEST(JobStoreTest, ADiskThatRefusesIsAnErrorAndLeavesTheStoreAsItWas) {
  const TempFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    JobStore store(folder / "jobs.sqlite");
    for (int i = 0; i < 10; ++i) submit(store);
    ::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{400'000, 400'000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    const NewJob large = a_job("{\"a\":\"" + std::string(50'000, 'a') + "\"}");
    int accepted = 10;
    try {
      for (; accepted < 100; ++accepted) submit(store, large);
      ::_exit(1);  // the limit was not felt
    } catch (const StoreError&) {
    }
    ::_exit(std::ssize(store.list({{}, {}, 1000})) == accepted ? 0 : 2);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  EXPECT_FALSE(open_failure(folder / "jobs.sqlite"));
}

TEST(JobStoreTest, ManyThreadsClaimEachTaskOnce) {
  const TempFolder folder;
  JobStore store(folder / "jobs.sqlite");
  constexpr int jobs = 60;
  for (int i = 0; i < jobs; ++i) submit(store);
  std::mutex mutex;
  std::multiset<std::string> claimed;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i)
      threads.emplace_back([&] {
        while (const std::optional<Task> task = store.claim(Priority::interactive)) {
          EXPECT_TRUE(store.finish(*task, a_result(), true, "{}", {}));
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

TEST(DataFolderTest, ServesOneServiceAtATime) {
  const TempFolder folder;
  const auto first = std::make_unique<DataFolder>(folder / "data");
  EXPECT_THROW(DataFolder(folder / "data"), StoreError);
}

TEST(DataFolderTest, IsFreeAgainWhenItsServiceEnds) {
  const TempFolder folder;
  { const DataFolder first(folder / "data"); }
  EXPECT_NO_THROW(DataFolder(folder / "data"));
}

TEST(DataFolderTest, ThatCannotBeMadeIsAnError) {
  EXPECT_THROW(DataFolder("/dev/null/x"), StoreError);
}

TEST(IdTest, SortByCreationWithinAMillisecondAndWhenTheClockIsSetBack) {
  IdSource ids;
  std::string last;
  for (int i = 0; i < 1000; ++i) {
    const std::string id = ids.next(i < 500 ? 5'000'000 : 4'000'000);
    EXPECT_TRUE(is_id(id)) << id;
    EXPECT_LT(last, id);
    last = id;
  }
  EXPECT_LT(last, IdSource(last).next(0));
}

TEST(IdTest, NothingElseIsAnId) {
  for (const char* text :
       {"", "..", "../../etc/passwd", "01ARZ3NDEKTSV4RRFFQ69G5FA", "01arz3ndektsv4rrffq69g5fav",
        "81ARZ3NDEKTSV4RRFFQ69G5FAV", "01ARZ3NDEKTSV4RRFFQ69G5F/V", "01ARZ3NDEKTSV4RRFFQ69G5FAVX"})
    EXPECT_FALSE(is_id(text)) << text;
  EXPECT_TRUE(is_id("01ARZ3NDEKTSV4RRFFQ69G5FAV"));
}

}  // namespace
}  // namespace translucube::server

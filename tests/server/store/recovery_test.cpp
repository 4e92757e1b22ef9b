// What a durable store makes of the death of a process that had tasks in hand.

#include <gmock/gmock.h>

#include "server/store/refusals.h"
#include "tests/server/store/stored.h"
#include "tests/server/temp_folder.h"

namespace translucube::server {
namespace {

using api::JobState;
using test::a_completion;
using test::a_job;
using test::a_sweep;
using test::submit;
using test::TempFolder;
using testing::HasSubstr;

/// A store of processes that end one after the other.
class RecoveryTest : public testing::Test {
 protected:
  RecoveryTest() { start(); }
  void start(bool after_a_crash = true) {
    store.reset();  // the file is closed as the kernel closes it
    StoreOptions options;
    options.lease_ms = 1000;
    options.lease_clock = [this] { return now; };
    options.last_crashed = after_a_crash;
    store = open_job_store(folder_ / "jobs.sqlite", options);
  }
  void end_as_told() {
    store->announce_end();
    start();
  }
  std::optional<Task> claim(Priority priority = Priority::interactive) const {
    return store->claim(priority);
  }
  JobState state(const std::string& id) const { return store->find(id)->state; }

  std::int64_t now = 1'000'000;
  std::unique_ptr<JobStore> store;

 private:
  TempFolder folder_;
};

TEST_F(RecoveryTest, AJobThatWasAloneAtTwoDeathsHasFailedAndSaysSo) {
  const std::string poison = submit(*store);
  ASSERT_EQ(claim()->job_id, poison);
  start();
  EXPECT_EQ(state(poison), JobState::queued) << "one death may be anything's";
  ASSERT_EQ(claim()->job_id, poison);
  start();
  EXPECT_EQ(state(poison), JobState::failed);
  EXPECT_THAT(store->find(poison)->error.value(), HasSubstr(ended_the_process().detail));
  EXPECT_FALSE(claim());
  const auto events = store->events_after(poison, 0);
  EXPECT_THAT(events.back().data, HasSubstr("failed"));
}

TEST_F(RecoveryTest, AKillFromOutsideIsNoCrashUnlessTheTaskTookItsTime) {
  const std::string early = submit(*store);
  for (int kill = 1; kill <= 8; ++kill) {
    EXPECT_EQ(state(early), JobState::queued) << kill;
    ASSERT_EQ(claim()->job_id, early);
    start(false);
  }
  EXPECT_EQ(state(early), JobState::failed);
  const std::string late = submit(*store);
  for (int kill = 1; kill <= 2; ++kill) {
    EXPECT_EQ(state(late), JobState::queued) << kill;
    ASSERT_TRUE(store->renew(*claim()));
    start(false);
  }
  EXPECT_EQ(state(late), JobState::failed);
}

TEST_F(RecoveryTest, AnImageOfASweepFailsAloneAndItsSweepGoesOn) {
  const std::string sweep = store->submit(a_sweep({1, 2}))->stored.id;
  std::string poison;
  for (int death = 0; death < 2; ++death) {
    poison = claim(Priority::batch)->job_id;
    start();
  }
  EXPECT_EQ(state(poison), JobState::failed);
  EXPECT_EQ(store->find_sweep(sweep)->state, JobState::running);
  EXPECT_NE(claim(Priority::batch)->job_id, poison);
}

TEST_F(RecoveryTest, OfThoseThatWereInHandAtADeathEachIsTriedAloneAndOnlyTheGuiltyOneFails) {
  const std::string innocent = submit(*store), poison = submit(*store), later = submit(*store);
  ASSERT_EQ(claim()->job_id, innocent);
  ASSERT_EQ(claim()->job_id, poison);
  start();

  const Task first = *claim();
  EXPECT_EQ(first.job_id, innocent);
  EXPECT_FALSE(claim()) << "nothing beside a suspect";
  EXPECT_FALSE(claim(Priority::batch));
  EXPECT_TRUE(store->complete(first, a_completion(), {1, 4, 4}));
  const Task second = *claim();
  EXPECT_EQ(second.job_id, poison) << "the other suspect before all that is not suspect";
  EXPECT_FALSE(claim());
  start();
  EXPECT_EQ(claim()->job_id, poison);
  start();

  EXPECT_EQ(state(poison), JobState::failed);
  EXPECT_EQ(state(innocent), JobState::queued);
  EXPECT_EQ(claim()->job_id, innocent);
  EXPECT_EQ(claim()->job_id, later) << "no suspects are left";
}

TEST_F(RecoveryTest, ASuspectWaitsUntilNothingElseIsInHand) {
  const std::string suspect = submit(*store), other = submit(*store);
  ASSERT_EQ(claim()->job_id, suspect);
  start();
  const Task task = *claim();
  ASSERT_EQ(task.job_id, suspect);
  ASSERT_TRUE(store->release(task, 500, true)) << "the world refuses it for a while";
  const Task beside = *claim();
  EXPECT_EQ(beside.job_id, other) << "which delays nobody else";
  now += 600;
  EXPECT_FALSE(claim()) << "due, but not alone";
  EXPECT_TRUE(store->complete(beside, a_completion(), {1, 4, 4}));
  EXPECT_EQ(claim()->job_id, suspect);
}

TEST_F(RecoveryTest, ARenderThatComesOnBetweenDeathsNeverFails) {
  const std::string id = submit(*store);
  for (std::uint32_t pass = 0; pass < 10; ++pass) {
    const Task task = *claim();
    ASSERT_EQ(task.pass.index, pass);
    ASSERT_TRUE(store->complete(task, a_completion(), {pass + 1, 4 * (pass + 1), 4}));
    ASSERT_TRUE(claim());
    start();
    ASSERT_EQ(state(id), JobState::queued);
  }
}

TEST_F(RecoveryTest, AProcessThatEndsAsItWasToldBlamesNobody) {
  const std::string first = submit(*store), second = submit(*store);
  for (int end = 0; end < 5; ++end) {
    ASSERT_TRUE(claim());
    ASSERT_TRUE(claim()) << "no suspects";
    end_as_told();
    EXPECT_EQ(state(first), JobState::queued);
  }
  ASSERT_TRUE(claim());
  ASSERT_TRUE(claim());
  start();
  ASSERT_TRUE(claim());
  EXPECT_FALSE(claim()) << "the announcement was for that process only";
}

TEST_F(RecoveryTest, TheDeathOfAnIdleProcessBlamesNobody) {
  const std::string id = submit(*store);
  for (int death = 0; death < 5; ++death) start();
  EXPECT_EQ(state(id), JobState::queued);
  ASSERT_TRUE(claim());
  store->cancel(id);
  for (int death = 0; death < 5; ++death) start();
  EXPECT_EQ(state(id), JobState::canceled);
}

}  // namespace
}  // namespace translucube::server

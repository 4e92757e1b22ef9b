#include "api/answer/event.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "api/base/problem.h"

namespace translucube::api {
namespace {

using nlohmann::json;

Progress half_way() {
  Progress progress;
  progress.passes = 2;
  progress.samples = 8;
  progress.total_samples = 16;
  progress.relative_error = 0.25;
  progress.seconds = 1.5;
  progress.eta_seconds = 1.5;
  return progress;
}
const json half_way_json{{"samples", 8},
                         {"total_samples", 16},
                         {"relative_error", 0.25},
                         {"seconds", 1.5},
                         {"eta_seconds", 1.5}};

TEST(Event, ProgressIsThatOfAStatus) {
  EXPECT_EQ(json::parse(progress_event(half_way())), half_way_json);
}

TEST(Event, WhatIsNotKnownIsNull) {
  const json at_first = json::parse(progress_event({}));
  for (const char* key : {"total_samples", "relative_error", "eta_seconds"})
    EXPECT_TRUE(at_first[key].is_null()) << key;
  EXPECT_EQ(at_first["samples"], 0);
  Progress first_pass = half_way();
  first_pass.relative_error = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(json::parse(progress_event(first_pass))["relative_error"].is_null());
}

TEST(Event, AStateComesWithTheProgressAndTheError) {
  EXPECT_EQ(json::parse(state_event(JobState::running, half_way(), {})),
            (json{{"state", "running"}, {"progress", half_way_json}, {"error", nullptr}}));
  const std::string error = to_json(Problem{ProblemCode::internal, "It broke.", {}});
  const json failed = json::parse(state_event(JobState::failed, half_way(), error));
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_EQ(failed["error"], json::parse(error));
}

TEST(Event, IsOneLineAsAStreamNeedsIt) {
  const std::string error = to_json(Problem{ProblemCode::internal, "two\nlines\r\n", {}});
  const std::string event = state_event(JobState::failed, half_way(), error);
  EXPECT_EQ(event.find_first_of("\r\n"), event.npos);
}

TEST(Event, ASweepTellsItsCounts) {
  StateCounts counts{};
  for (std::size_t i = 0; i < counts.size(); ++i) counts[i] = i + 1;
  const json expected{
      {"queued", 1}, {"running", 2}, {"succeeded", 3}, {"failed", 4}, {"canceled", 5}};
  EXPECT_EQ(json::parse(sweep_event(JobState::running, counts)),
            (json{{"state", "running"}, {"counts", expected}}));
  EXPECT_EQ(json::parse(points_event({4, 2}, JobState::succeeded, counts)),
            (json{{"points", {4, 2}}, {"state", "succeeded"}, {"counts", expected}}));
}

TEST(Event, AnErrorThatIsNoJsonIsNotPassedOn) {
  EXPECT_THROW(state_event(JobState::failed, {}, "{"), std::invalid_argument);
}

}  // namespace
}  // namespace translucube::api

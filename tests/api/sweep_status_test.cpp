#include "api/answer/sweep_status.h"

#include <limits>
#include <nlohmann/json.hpp>

#include "api/answer/render_status.h"
#include "tests/api/fixture.h"

namespace translucube::api {
namespace {

using nlohmann::json;

/// Two absorptions and two absorbers of two roughnesses: the images are of 0 1 4 5 and of 2 3 6 7.
SweepStatus status() {
  SweepStatus status;
  status.id = "X";
  status.state = JobState::running;
  status.created_at = "2026-01-31T12:00:00.000Z";
  status.started_at = "2026-01-31T12:00:01.000Z";
  status.sweep = {accepted(request_with(R"("seed":3)")),
                  {0, 0.5},
                  {0.2, 0.4},
                  {0.1},
                  {"amber", RgbAbsorber{{0, 1, 1}}}};
  status.images.resize(2);
  status.images[0].points = {0, 4, 1, 5};
  status.images[1].points = {2, 6, 3, 7};
  return status;
}

std::string stats(double seconds, std::uint64_t nan_samples = 0) {
  RenderStats stats;
  stats.samples = 64;
  stats.seconds = seconds;
  stats.cpu_seconds = 2 * seconds;
  stats.relative_error = 0.125;
  stats.nan_samples = nan_samples;
  return stats_json(stats);
}

TEST(SweepStatus, TellsWhatItIsAndHowFar) {
  const json answer = json::parse(to_json(status()));
  EXPECT_EQ(answer["id"], "X");
  EXPECT_EQ(answer["state"], "running");
  EXPECT_EQ(answer["created_at"], "2026-01-31T12:00:00.000Z");
  EXPECT_EQ(answer["started_at"], "2026-01-31T12:00:01.000Z");
  EXPECT_TRUE(answer["finished_at"].is_null());
  EXPECT_EQ(answer["points"], 8);
  EXPECT_EQ(answer["traced_images"], 2);
  EXPECT_EQ(answer["request"], json::parse(canonical_json(status().sweep)));
  EXPECT_EQ(answer["links"], (json{{"self", "/v1/sweeps/X"},
                                   {"events", "/v1/sweeps/X/events"},
                                   {"cancel", "/v1/sweeps/X/cancel"},
                                   {"sheet", "/v1/sweeps/X/sheet"}}));
}

TEST(SweepStatus, CountsPointsAndSumsWhatWasTraced) {
  SweepStatus sweep = status();
  sweep.images[0].state = JobState::succeeded;
  sweep.images[0].stats = stats(1.5, 3);
  const json answer = json::parse(to_json(sweep));
  EXPECT_EQ(
      answer["counts"],
      (json{{"queued", 4}, {"running", 0}, {"succeeded", 4}, {"failed", 0}, {"canceled", 0}}));
  EXPECT_EQ(answer["stats"], (json{{"traced_images", 1},
                                   {"cached_images", 0},
                                   {"seconds", 1.5},
                                   {"cpu_seconds", 3.0},
                                   {"nan_samples", 3}}));
}

TEST(SweepStatus, WhatWasThereAlreadyCostsNothing) {
  SweepStatus sweep = status();
  for (SweepImageStatus& image : sweep.images) {
    image.state = JobState::succeeded;
    image.stats = stats(1.5);
  }
  sweep.images[1].cached = true;
  const json answer = json::parse(to_json(sweep))["stats"];
  EXPECT_EQ(answer["traced_images"], 1);
  EXPECT_EQ(answer["cached_images"], 1);
  EXPECT_EQ(answer["seconds"], 1.5);
}

TEST(SweepStatus, ResultsStandInTheOrderOfThePoints) {
  SweepStatus sweep = status();
  sweep.images[0].state = JobState::succeeded;
  sweep.images[0].stats = stats(1);
  const std::string error = to_json(Problem{ProblemCode::internal, "It broke.", {}});
  sweep.images[1].state = JobState::failed;
  sweep.images[1].error = error;
  const json results = json::parse(to_json(sweep))["results"];
  ASSERT_EQ(results.size(), 8u);
  for (std::size_t point = 0; point < 8; ++point) EXPECT_EQ(results[point]["point"], point);
  EXPECT_EQ(results[5], (json{{"point", 5},
                              {"absorption", 0.5},
                              {"roughness", 0.2},
                              {"scattering", 0.1},
                              {"absorber", "absorber 2"},
                              {"seed", point_request(sweep.sweep, 5).seed},
                              {"state", "succeeded"},
                              {"samples", 64},
                              {"relative_error", 0.125},
                              {"error", nullptr},
                              {"image", "/v1/sweeps/X/points/5/image"}}));
  EXPECT_EQ(results[2]["absorber"], "amber");
  EXPECT_EQ(results[2]["state"], "failed");
  EXPECT_EQ(results[2]["error"], json::parse(error));
  for (const char* key : {"samples", "relative_error", "image"})
    EXPECT_TRUE(results[2][key].is_null()) << key;
}

TEST(SweepStatus, AStoreThatIsNoJsonIsNotPassedOn) {
  SweepStatus sweep = status();
  sweep.images[0].stats = "{";
  EXPECT_THROW(to_json(sweep), std::invalid_argument);
}

TEST(SweepList, HoldsNoResults) {
  const SweepSummary summary{"X", JobState::queued, "2026-01-31T12:00:00.000Z", {}, {}, 8, 2};
  EXPECT_EQ(json::parse(sweep_list_json({summary}, "more")),
            (json{{"sweeps",
                   {{{"id", "X"},
                     {"state", "queued"},
                     {"created_at", "2026-01-31T12:00:00.000Z"},
                     {"started_at", nullptr},
                     {"finished_at", nullptr},
                     {"points", 8},
                     {"traced_images", 2},
                     {"links", {{"self", "/v1/sweeps/X"}}}}}},
                  {"next_cursor", "more"}}));
  EXPECT_EQ(json::parse(sweep_list_json({}, {})),
            (json{{"sweeps", json::array()}, {"next_cursor", nullptr}}));
}

}  // namespace
}  // namespace translucube::api

#include "api/answer/render_status.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <utility>

#include "api/answer/listings.h"

namespace translucube::api {
namespace {

using nlohmann::json;

RenderStatus queued_status() {
  RenderStatus status;
  status.id = "r1";
  status.created_at = "2026-01-31T12:00:00.000Z";
  status.request = R"({"seed":1})";
  status.material = R"({"albedo":0.5})";
  return status;
}

TEST(JobStates, HaveNamesThatReadBack) {
  std::set<std::string_view> names;
  for (const JobState state : all_job_states) {
    names.insert(name(state));
    EXPECT_EQ(job_state(name(state)), state);
  }
  EXPECT_EQ(names.size(), 5u);
  EXPECT_FALSE(job_state("done"));
  EXPECT_FALSE(job_state(""));
}

TEST(JobStates, FollowEachOtherInTheLegalWaysOnly) {
  using enum JobState;
  const std::set<std::pair<JobState, JobState>> legal{{queued, running}, {queued, canceled},
                                                      {running, queued}, {running, succeeded},
                                                      {running, failed}, {running, canceled}};
  for (const JobState from : all_job_states)
    for (const JobState to : all_job_states)
      EXPECT_EQ(may_follow(from, to), legal.contains({from, to})) << name(from) << name(to);
}

TEST(JobStates, NothingFollowsAnEnd) {
  for (const JobState from : all_job_states) {
    bool followed = false;
    for (const JobState to : all_job_states) followed = followed || may_follow(from, to);
    EXPECT_EQ(followed, !is_end(from));
  }
}

TEST(RenderStatus, OfAQueuedRenderHasNulls) {
  EXPECT_EQ(json::parse(to_json(queued_status())), json::parse(R"({
    "id":"r1","state":"queued","created_at":"2026-01-31T12:00:00.000Z",
    "started_at":null,"finished_at":null,
    "progress":{"samples":0,"total_samples":null,"relative_error":null,"seconds":0.0,
                "eta_seconds":null},
    "request":{"seed":1},"material":{"albedo":0.5},"stats":null,"error":null,
    "cached":false,
    "links":{"self":"/v1/renders/r1","image":"/v1/renders/r1/image",
             "events":"/v1/renders/r1/events","cancel":"/v1/renders/r1/cancel"}})"));
}

TEST(RenderStatus, OfARenderUnderWayHasItsProgress) {
  RenderStatus status = queued_status();
  status.state = JobState::running;
  status.started_at = "2026-01-31T12:00:01.000Z";
  status.progress = {2, 8, 64, 0.25, 1.5, 10.0};
  EXPECT_EQ(json::parse(to_json(status))["progress"],
            json::parse(R"({"samples":8,"total_samples":64,"relative_error":0.25,"seconds":1.5,
                            "eta_seconds":10.0})"));
  status.progress.relative_error = std::numeric_limits<double>::quiet_NaN();
  status.progress.eta_seconds = std::numeric_limits<double>::infinity();
  const json progress = json::parse(to_json(status))["progress"];
  EXPECT_TRUE(progress["relative_error"].is_null());
  EXPECT_TRUE(progress["eta_seconds"].is_null());
}

TEST(RenderStatus, HoldsStatsAndErrorAsObjects) {
  RenderStatus status = queued_status();
  status.state = JobState::failed;
  status.stats = stats_json({});
  status.error = to_json(Problem{ProblemCode::internal, "it broke", {}});
  const json document = json::parse(to_json(status));
  EXPECT_EQ(document["stats"]["traced_images"], 1);
  EXPECT_EQ(document["error"]["status"], 500);
}

TEST(RenderStatus, RefusesTextThatIsNotJson) {
  RenderStatus status = queued_status();
  status.request = "{";
  EXPECT_THROW(to_json(status), std::invalid_argument);
}

TEST(RenderStatus, ListHasACursorWhereThereIsMore) {
  EXPECT_EQ(json::parse(render_list_json({}, std::nullopt)),
            json::parse(R"({"renders":[],"next_cursor":null})"));
  const json list = json::parse(render_list_json({queued_status(), queued_status()}, "abc"));
  EXPECT_EQ(list["renders"].size(), 2u);
  EXPECT_EQ(list["renders"][0]["id"], "r1");
  EXPECT_EQ(list["next_cursor"], "abc");
}

TEST(Stats, HaveNullForWhatIsNotFinite) {
  RenderStats stats;
  stats.samples = 64;
  stats.seconds = 1.25;
  stats.cpu_seconds = std::numeric_limits<double>::infinity();
  stats.threads = 2;
  stats.relative_error = std::numeric_limits<double>::quiet_NaN();
  stats.transport = "walk";
  stats.nan_samples = std::uint64_t{1} << 60;
  stats.truncated_energy = 1e-9;
  EXPECT_EQ(json::parse(stats_json(stats)), json::parse(R"({
    "samples":64,"seconds":1.25,"cpu_seconds":null,"threads":2,"relative_error":null,
    "transport":"walk","traced_images":1,"nan_samples":1152921504606846976,
    "truncated_energy":1e-9,"camera_inside":false,"mesh":null})"));
  stats.mesh = MeshReport{8, 12, 28, 3, 1};
  EXPECT_EQ(json::parse(stats_json(stats))["mesh"], json::parse(R"({"vertices":8,
    "triangles":12,"welded_vertices":28,"dropped_triangles":3,"parts":1,
    "smooth":null})"));
  stats.refinement = Refinement{12, 768, 0.001, true};
  EXPECT_EQ(json::parse(stats_json(stats))["mesh"]["smooth"],
            json::parse(R"({"triangles":768,"chord_error":0.001,"limited":true})"));
}

TEST(Listings, TellWhatARequestMayName) {
  Catalog catalog;
  catalog.absorbers["ink"] = {"Ink", {{400, 700}, {1, 0.5}}};
  catalog.environments["sky"] = "/secret/place/sky.exr";
  EXPECT_EQ(json::parse(absorbers_json(catalog)),
            json::parse(R"({"absorbers":[{"name":"ink","description":"Ink",
                            "wavelengths_nm":[400.0,700.0],"values":[1.0,0.5]}]})"));
  EXPECT_EQ(json::parse(environments_json(catalog, {{"00ff", 684, "2026-11-29T12:00:00.000Z"}})),
            json::parse(R"({"environments":[{"name":"sky"}],"uploads":[{"sha256":"00ff","bytes":684,
                            "uploaded_at":"2026-11-29T12:00:00.000Z"}]})"));
  EXPECT_EQ(json::parse(displays_json({{"sRGB", {"plain", "raw"}}})),
            json::parse(R"({"displays":[{"name":"sRGB","views":["plain","raw"]}]})"));
}

}  // namespace
}  // namespace translucube::api

// Sweeps through the service: what is traced, what is developed, what is already there.

#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "api/request/canonical.h"
#include "api/request/sweep.h"
#include "tests/server/fixture.h"

namespace translucube::server::test {
namespace {

using api::JobState;
using nlohmann::json;

std::string sweep_request(int samples, const std::string& axes, int size = 8) {
  return R"({"base":)" + small_request(samples, 1, size) + R"(,"axes":)" + axes + "}";
}
const std::string some_axes = R"({"absorption":[0,0.5,1],"roughness":[0,0.5],"scattering":[0.4]})";

struct SweepsUnderTest {
  explicit SweepsUnderTest(Engine engine, ServiceOptions options = {})
      : service(folder.path(), std::move(engine), options) {}

  api::SweepStatus submit(const std::string& document, std::optional<std::string> key = {}) {
    auto result = service.service.submit_sweep(document, key);
    if (!result) {
      ADD_FAILURE() << to_text(result.problem());
      return {};
    }
    return result->status;
  }
  api::SweepStatus get(const std::string& id) { return *service.service.get_sweep(id); }
  api::SweepStatus wait(const std::string& id) {
    service.service.changes().watch(std::chrono::seconds(120),
                                    [&] { return is_end(get(id).state); });
    return get(id);
  }
  std::string exr(const std::string& id, std::size_t point) {
    auto result =
        service.service.point_image(id, std::to_string(point), {ImageFormat::exr, {}, {}, {}});
    if (!result) {
      ADD_FAILURE() << to_text(result.problem());
      return {};
    }
    return result->file->read_all();
  }

  TempFolder folder;
  TestService service;
};

TEST(SweepServiceTest, TracesEachPairOfRoughnessAndScatteringOnce) {
  FakeRenderer renderer;
  SweepsUnderTest tested(renderer.engine());
  const api::SweepStatus accepted = tested.submit(sweep_request(4, some_axes));
  EXPECT_EQ(accepted.images.size(), 2u);
  const api::SweepStatus sweep = tested.wait(accepted.id);
  EXPECT_EQ(sweep.state, JobState::succeeded);
  EXPECT_EQ(renderer.builds, 2);
  const json answer = json::parse(to_json(sweep));
  EXPECT_EQ(answer["points"], 6);
  EXPECT_EQ(answer["counts"]["succeeded"], 6);
  EXPECT_EQ(answer["stats"]["traced_images"], 2);
  for (std::size_t point = 0; point < 6; ++point) EXPECT_FALSE(tested.exr(sweep.id, point).empty());
}

TEST(SweepServiceTest, ToTellASweepIsWorkOnlyAfterAChange) {
  FakeRenderer renderer;
  SweepsUnderTest tested(renderer.engine(), {0, {}});
  JobService& service = tested.service.service;
  const std::string id = tested.submit(sweep_request(4, some_axes)).id;
  const ToldText first = *service.tell_sweep(id);
  const Moment before = *service.moment_of_sweep(id);
  EXPECT_EQ(*service.tell_sweep(id), first);  // the same object
  EXPECT_EQ(first->json, to_json(tested.get(id)));
  ASSERT_TRUE(service.cancel_sweep(id));
  EXPECT_NE(service.moment_of_sweep(id)->version, before.version);
  const ToldText second = *service.tell_sweep(id);
  EXPECT_EQ(second->state, JobState::canceled);
  EXPECT_EQ(second->json, to_json(tested.get(id)));
  EXPECT_FALSE(service.remove_sweep(id));
  EXPECT_FALSE(service.tell_sweep(id));
  EXPECT_FALSE(service.moment_of_sweep(id));
}

TEST(SweepServiceTest, EachStepOfASweepIsANewVersion) {
  FakeRenderer renderer;
  SweepsUnderTest tested(renderer.engine());
  JobService& service = tested.service.service;
  renderer.milliseconds_per_pass = 20;
  const std::string id = tested.submit(sweep_request(4, some_axes)).id;
  std::map<std::string, std::string> told;  // by version
  service.changes().watch(std::chrono::seconds(120), [&] {
    const Moment moment = *service.moment_of_sweep(id);
    const std::string now = to_json(tested.get(id));
    // Where nothing came in between, a version is one text.
    if (service.moment_of_sweep(id)->version == moment.version) {
      EXPECT_EQ(told.try_emplace(moment.version, now).first->second, now);
    }
    return is_end(moment.state);
  });
  EXPECT_EQ((*service.tell_sweep(id))->json, to_json(tested.get(id)));
  EXPECT_EQ((*service.tell_sweep(id))->state, JobState::succeeded);
}

// The promise of design.md, with the real renderer: each lane, the infinite one among them, is the
// render of its own.
TEST(SweepServiceTest, APointHasTheBitsOfTheSameRequestAlone) {
  SweepsUnderTest sweeps(renderer_engine()), alone(renderer_engine());
  const std::string axes = R"({"absorption":[1,0,0.6],"roughness":[0,0.6],"scattering":[0,0.5,1]})";
  const std::string document = sweep_request(5, axes, 20);
  const api::SweepStatus sweep = sweeps.wait(sweeps.submit(document).id);
  ASSERT_EQ(sweep.state, JobState::succeeded);
  for (std::size_t point = 0; point < sweep.sweep.point_count(); ++point) {
    const std::string request = canonical_json(api::point_request(sweep.sweep, point));
    const api::RenderStatus render = alone.service.wait(alone.service.submit(request).id);
    ASSERT_EQ(render.state, JobState::succeeded);
    EXPECT_EQ(sweeps.exr(sweep.id, point), alone.service.exr(render.id)) << request;
  }
}

TEST(SweepServiceTest, WhatIsThereIsNotRenderedAgain) {
  FakeRenderer renderer;
  SweepsUnderTest tested(renderer.engine());
  const api::SweepStatus first = tested.wait(tested.submit(sweep_request(4, some_axes)).id);
  const int passes = renderer.passes;
  const api::SweepStatus again = tested.submit(sweep_request(4, some_axes));
  EXPECT_EQ(again.state, JobState::succeeded) << "at once";
  EXPECT_TRUE(again.finished_at);
  EXPECT_TRUE(std::ranges::all_of(again.images, &api::SweepImageStatus::cached));
  const api::RenderStatus point =
      tested.service.submit(canonical_json(api::point_request(first.sweep, 3)));
  EXPECT_EQ(point.state, JobState::succeeded) << "at once";
  EXPECT_TRUE(point.cached);
  EXPECT_EQ(tested.service.exr(point.id), tested.exr(first.id, 3));
  EXPECT_EQ(renderer.passes, passes);
}

TEST(SweepServiceTest, OfWhatIsPartlyThereTheRestIsRendered) {
  FakeRenderer renderer;
  SweepsUnderTest tested(renderer.engine());
  tested.wait(tested.submit(sweep_request(4, some_axes)).id);
  const int builds = renderer.builds;
  const api::SweepStatus more = tested.submit(
      sweep_request(4, R"({"absorption":[0,0.5,1],"roughness":[0,0.5,0.9],"scattering":[0.4]})"));
  EXPECT_EQ(more.state, JobState::running) << "some points are there";
  const api::SweepStatus ended = tested.wait(more.id);
  EXPECT_EQ(ended.state, JobState::succeeded);
  EXPECT_EQ(renderer.builds, builds + 1);
  EXPECT_EQ(std::ranges::count_if(ended.images, &api::SweepImageStatus::cached), 2);
  const auto told = *tested.service.service.events_of_sweep(more.id, 0);
  EXPECT_EQ(told.events.at(0).type, "state");
  EXPECT_EQ(told.events.at(1).type, "points");
  EXPECT_EQ(json::parse(told.events.at(1).data)["points"].size(), 6u);
  EXPECT_EQ(json::parse(told.events.back().data)["state"], "succeeded");
}

TEST(SweepServiceTest, WhatIsThereNeedsNoRoomInTheQueue) {
  const TempFolder folder;
  FakeRenderer renderer;
  ServiceOptions options;
  options.store.most_queued = 2;
  TestService service(folder.path(), renderer.engine(), options);
  const auto submit = [&](const std::string& document) {
    return service.service.submit_sweep(document, std::nullopt);
  };
  const auto first = submit(sweep_request(4, some_axes))->status.id;
  service.service.changes().watch(std::chrono::seconds(120),
                                  [&] { return is_end(service.service.get_sweep(first)->state); });
  renderer.milliseconds_per_pass = 60'000;
  service.submit(small_request(4, 2));
  service.submit(small_request(4, 3));
  EXPECT_FALSE(submit(sweep_request(8, some_axes)));
  const auto again = submit(sweep_request(4, some_axes));
  ASSERT_TRUE(again);
  EXPECT_EQ(again->status.state, JobState::succeeded);
}

TEST(SweepServiceTest, APointWhoseSamplesAnotherDecidedIsNotTakenForARenderAlone) {
  FakeRenderer renderer;
  SweepsUnderTest tested(renderer.engine());
  const std::string document =
      R"({"base":{"material":{"cube":{"absorption":0,"roughness":0,"scattering":0}},)"
      R"("image":{"width":8,"height":8},"quality":{"relative_error":0.9}},)"
      R"("axes":{"absorption":[0,0.9]}})";
  const api::SweepStatus sweep = tested.wait(tested.submit(document).id);
  const auto submit = [&](std::size_t point) {
    return tested.service.submit(canonical_json(api::point_request(sweep.sweep, point)));
  };
  EXPECT_TRUE(submit(0).cached) << "it decided for itself";
  EXPECT_FALSE(submit(1).cached);
}

TEST(SweepServiceTest, AFailedImageDoesNotSinkTheRest) {
  FakeRenderer renderer;
  renderer.before_build = [](const SceneSpec& spec) {
    if (spec.material.coefficients.alpha > 0) throw std::runtime_error("no");
  };
  SweepsUnderTest tested(renderer.engine());
  const api::SweepStatus sweep = tested.wait(tested.submit(sweep_request(4, some_axes)).id);
  EXPECT_EQ(sweep.state, JobState::succeeded);
  const json answer = json::parse(to_json(sweep));
  EXPECT_EQ(answer["counts"]["succeeded"], 3);
  EXPECT_EQ(answer["counts"]["failed"], 3);
  for (const json& result : answer["results"]) {
    EXPECT_EQ(result["image"].is_null(), result["roughness"] != 0);
    EXPECT_EQ(result["error"].is_null(), result["roughness"] == 0);
  }
}

TEST(SweepServiceTest, ACanceledSweepKeepsWhatIsFinished) {
  FakeRenderer renderer;
  renderer.before_pass = [&](const Pass&) {
    if (renderer.builds == 2) renderer.milliseconds_per_pass = 60'000;
  };
  SweepsUnderTest tested(renderer.engine());
  const std::string id = tested.submit(sweep_request(4, some_axes)).id;
  ASSERT_TRUE(eventually([&] { return renderer.milliseconds_per_pass > 0; }));
  EXPECT_EQ(tested.service.service.cancel_sweep(id)->state, JobState::canceled);
  ASSERT_TRUE(eventually([&] { return renderer.tracing == 0; }));
  const json answer = json::parse(to_json(tested.get(id)));
  EXPECT_EQ(answer["counts"]["succeeded"], 3);
  EXPECT_EQ(answer["counts"]["canceled"], 3);
  EXPECT_EQ(tested.service.service.cancel_sweep(id)->state, JobState::canceled);
  EXPECT_FALSE(tested.exr(id, 0).empty());
}

TEST(SweepServiceTest, RemovalTakesTheDataThatNothingElseRefersTo) {
  FakeRenderer renderer;
  SweepsUnderTest tested(renderer.engine());
  const api::SweepStatus sweep = tested.wait(tested.submit(sweep_request(4, some_axes)).id);
  const api::RenderStatus kept =
      tested.service.submit(canonical_json(api::point_request(sweep.sweep, 2)));
  EXPECT_FALSE(tested.service.service.remove_sweep(sweep.id));
  EXPECT_EQ(tested.service.artifacts.ids(),
            std::vector<std::string>{tested.service.content(kept.id)});
  EXPECT_FALSE(tested.service.exr(kept.id).empty());
  EXPECT_EQ(tested.service.service.get_sweep(sweep.id).problem().code, api::ProblemCode::not_found);
  EXPECT_FALSE(tested.service.service.remove(kept.id));
  EXPECT_TRUE(tested.service.artifacts.ids().empty());
}

TEST(SweepServiceTest, ASheetShowsWhatIsThereAndChangesWithIt) {
  FakeRenderer renderer;
  SweepsUnderTest tested(renderer.engine(), {0, {}});
  const std::string id = tested.submit(sweep_request(4, some_axes, 64)).id;
  const ImageQuery png{ImageFormat::png, {}, {}, {}};
  const auto empty = *tested.service.service.sheet(id, png);
  EXPECT_EQ(tested.service.service.sheet(id, png)->etag, empty.etag);
  JobStore& store = tested.service.store;
  const Task task = *store.claim(Priority::batch);
  const std::string content = store.pictures(task.job_id).at(0).content;
  EXPECT_TRUE(store.fail(task, R"({"type":"x"})"));
  const auto of_failed = *tested.service.service.sheet(id, png);
  EXPECT_NE(of_failed.etag, empty.etag);
  EXPECT_EQ(tested.service.artifacts.names(id).size(), 1u) << "the older one is gone";
  EXPECT_TRUE(tested.service.service.sheet(id, {ImageFormat::exr, {}, {}, "ACEScg"}));
}

TEST(SweepServiceTest, AShortRenderOvertakesASweep) {
  FakeRenderer renderer;
  renderer.milliseconds_per_pass = 30;
  SweepsUnderTest tested(renderer.engine());
  const std::string sweep =
      tested.submit(sweep_request(4, R"({"roughness":{"from":0,"to":1,"count":20}})")).id;
  const std::string render = tested.service.submit(small_request(4, 7)).id;
  EXPECT_EQ(tested.service.wait(render).state, JobState::succeeded);
  const json answer = json::parse(to_json(tested.get(sweep)));
  EXPECT_GT(answer["counts"]["queued"], 10);
}

TEST(SweepServiceTest, OfSeveralWorkersOneIsKeptFreeOfSweeps) {
  FakeRenderer renderer;
  renderer.milliseconds_per_pass = 60'000;
  SweepsUnderTest tested(renderer.engine(), {2, {}});
  tested.submit(sweep_request(4, R"({"roughness":[0,0.5,1]})"));
  ASSERT_TRUE(eventually([&] { return renderer.tracing == 1; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_EQ(renderer.tracing, 1);
  const std::string render = tested.service.submit(small_request(4)).id;
  EXPECT_TRUE(eventually([&] { return renderer.tracing == 2; }));
  EXPECT_EQ(tested.service.state(render), JobState::running);
  tested.service.service.shut_down();
}

TEST(SweepServiceTest, ARestartGoesOnWithTheSweep) {
  const TempFolder folder;
  FakeRenderer renderer;
  std::string id;
  {
    TestService tested(folder.path(), renderer.engine(), {0, {}});
    id = tested.service.submit_sweep(sweep_request(4, some_axes), {})->status.id;
  }
  TestService tested(folder.path(), renderer.engine());
  tested.service.changes().watch(std::chrono::seconds(120),
                                 [&] { return is_end(tested.service.get_sweep(id)->state); });
  EXPECT_EQ(tested.service.get_sweep(id)->state, JobState::succeeded);
}

TEST(SweepServiceTest, WhatWasAcceptedIsToldWhateverTheLimitsAreNow) {
  FakeRenderer renderer;
  SweepsUnderTest tested(renderer.engine(), {0, {}});
  const api::SweepStatus accepted = tested.submit(sweep_request(4, some_axes));
  tested.service.catalog.limits = {10, 1, 1, 1, 1, 1};
  EXPECT_EQ(to_json(tested.get(accepted.id)), to_json(accepted));
}

TEST(SweepServiceTest, WhatWasAcceptedIsTracedWhateverTheLimitsAreNow) {
  FakeRenderer renderer;
  SweepsUnderTest tested(renderer.engine(), {0, {}});
  JobStore& store = tested.service.store;
  const api::RenderStatus render = tested.service.submit(small_request(40));
  const api::SweepStatus sweep = tested.submit(sweep_request(4, some_axes));
  api::Catalog narrow = tested.service.catalog;
  narrow.limits = {10, 1, 1, 1, 1, 1};
  const auto traced = traced_job(*store.find(render.id), store, narrow);
  ASSERT_TRUE(traced);
  EXPECT_EQ(traced->requests.at(0).width, 8);
  const auto image =
      traced_job(*store.find(store.sweep_images(sweep.id).at(0).job_id), store, narrow);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->requests.size(), 3u);
}

TEST(SweepServiceTest, TheLeastRecentlyUsedPicturesMakeRoom) {
  FakeRenderer renderer;
  SweepsUnderTest tested(renderer.engine());
  std::vector<std::string> ids;
  for (int seed = 1; seed <= 6; ++seed)
    ids.push_back(tested.service.wait(tested.service.submit(small_request(4, seed)).id).id);
  const std::uint64_t all = tested.service.store.result_bytes();
  tested.service.config.artifact_bytes = all;
  ids.push_back(tested.service.wait(tested.service.submit(small_request(4, 7)).id).id);
  ASSERT_TRUE(eventually([&] { return tested.service.store.result_bytes() <= all; }));
  const auto first = tested.service.service.image(ids.front(), {});
  ASSERT_FALSE(first);
  EXPECT_EQ(first.problem().code, api::ProblemCode::gone);
  EXPECT_FALSE(tested.service.exr(ids.back()).empty());
  const api::RenderStatus again = tested.service.submit(small_request(4, 1));
  EXPECT_FALSE(again.cached);
  EXPECT_EQ(tested.service.wait(again.id).state, JobState::succeeded);
  EXPECT_FALSE(tested.service.exr(ids.front()).empty()) << "made again for both";
}

}  // namespace
}  // namespace translucube::server::test

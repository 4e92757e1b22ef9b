// The two halves of a worker, each without the other.

#include <gmock/gmock.h>

#include "api/request/parse.h"
#include "server/worker/accept.h"
#include "tests/server/fixture.h"

namespace translucube::server::test {
namespace {

using api::JobState;

TracedScene a_scene(FakeRenderer& renderer) {
  SceneSpec spec;
  spec.width = spec.height = 8;
  spec.seed = 1;
  return renderer.engine()(spec);
}

TEST(TraceTest, APassThatWasStoppedIsToldFromOneWhoseTimeIsOver) {
  FakeRenderer renderer;
  const TracedScene scene = a_scene(renderer);
  const Pass first{0, 0, 4}, second{1, 4, 4};
  EXPECT_TRUE(std::holds_alternative<TracedPass>(trace(scene, SampleTarget{8}, second, 0, 1, {})));
  std::stop_source stopped;
  stopped.request_stop();
  EXPECT_TRUE(std::holds_alternative<Stopped>(trace(scene, SampleTarget{8}, first, 0, 1, stopped)));
  renderer.milliseconds_per_pass = 50;
  EXPECT_TRUE(std::holds_alternative<TracedPass>(trace(scene, TimeTarget{0.01}, first, 0, 1, {})))
      << "the first pass always ends";
  renderer.milliseconds_per_pass = 60'000;
  const auto late = trace(scene, TimeTarget{5}, second, 4.99, 1, {});
  ASSERT_TRUE(std::holds_alternative<OutOfTime>(late)) << "the passes before it count";
  EXPECT_GE(std::get<OutOfTime>(late).seconds, 0.01);
}

/// A job that is claimed and in hand, and a renderer elsewhere that traces its passes.
struct AcceptTest : testing::Test {
  AcceptTest() {
    const auto request = api::parse_render_request(small_request(8), catalog);
    id = store->submit(new_job(*request, catalog, {}))->stored.id;
    task = *store->claim(Priority::interactive);
    hand.id = id;
    hand.job = *traced_job(*store->find(id), *store, catalog);
    hand.scene = a_scene(here);
    EXPECT_TRUE(catch_up(workshop, hand, task.pass, 0, {}));
  }
  TracedPass traced_elsewhere(const Pass& pass) {
    return std::get<TracedPass>(trace(a_scene(elsewhere), hand.job.quality(), pass, 0, 1, {}));
  }

  TempFolder folder;
  api::Catalog catalog = api::load_catalog(config_path);
  std::unique_ptr<JobStore> store = open_job_store(":memory:");
  ArtifactStore artifacts{folder.path()};
  Metrics metrics;
  LiveFilms live_films;
  ExplorableCache explorables{0};
  FakeRenderer here, elsewhere;
  Setbacks setbacks;
  MemoryBudget memory{std::uint64_t{1} << 40};
  Workshop workshop{catalog,     *store,   artifacts, metrics,       live_films,
                    explorables, setbacks, memory,    here.engine(), 1};
  std::string id;
  Task task;
  Hand hand;
};

TEST_F(AcceptTest, FilmsThatWereTracedElsewhereMakeThePicture) {
  EXPECT_TRUE(accept(workshop, hand, task, traced_elsewhere(task.pass)));
  EXPECT_EQ(store->find(id)->progress.samples, 4u);
  EXPECT_EQ(live_films.samples(id), 4u);
  const Task next = *store->claim(Priority::interactive);
  EXPECT_EQ(next.pass, (Pass{1, 4, 4}));
  EXPECT_FALSE(accept(workshop, hand, next, traced_elsewhere(next.pass))) << "the job has ended";
  EXPECT_EQ(store->find(id)->state, JobState::succeeded);
  const auto result = store->find_result(store->pictures(id).at(0).content);
  ASSERT_TRUE(result);
  EXPECT_TRUE(artifacts.open(result->content, result->image));
  EXPECT_EQ(here.passes, 0);
}

TEST_F(AcceptTest, WhoLostItsClaimLeavesNothing) {
  TracedPass pass = traced_elsewhere(task.pass);
  store->cancel(id);
  EXPECT_FALSE(accept(workshop, hand, task, std::move(pass)));
  EXPECT_EQ(store->find(id)->progress.samples, 0u);
  tidy(workshop, id);
  EXPECT_THAT(artifacts.ids(), testing::IsEmpty());
}

TEST_F(AcceptTest, AJobWhoseTimeIsOverEndsWithThePassesBefore) {
  EXPECT_TRUE(accept(workshop, hand, task, traced_elsewhere(task.pass)));
  end_without(workshop, hand, *store->claim(Priority::interactive), {2});
  EXPECT_EQ(store->find(id)->state, JobState::succeeded);
  EXPECT_EQ(store->find(id)->progress.samples, 4u);
}

}  // namespace
}  // namespace translucube::server::test

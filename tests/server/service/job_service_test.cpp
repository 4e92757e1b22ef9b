#include "server/service/job_service.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "tests/server/fixture.h"

namespace translucube::server::test {
namespace {

using api::JobState;
using api::ProblemCode;
using api::Result;
using testing::IsEmpty;

template <typename T>
ProblemCode code_of(const Result<T>& result) {
  EXPECT_FALSE(result) << "there was no problem";
  return result ? ProblemCode::internal : result.problem().code;
}

constexpr const char* unknown_id = "01ARZ3NDEKTSV4RRFFQ69G5FAV";

TEST(JobServiceTest, RefusesABadRequestAndKeepsNothingOfIt) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  EXPECT_EQ(code_of(tested.service.submit(R"({"material":{}})", {})), ProblemCode::invalid_request);
  EXPECT_EQ(code_of(tested.service.submit("{", {})), ProblemCode::malformed_json);
  EXPECT_THAT(tested.store.list({}), IsEmpty());
}

TEST(JobServiceTest, TheSameKeyIsTheSameRenderHoweverItsRequestIsWritten) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine(), {0, {}});
  const std::string request = small_request(4);
  const std::string id = tested.submit(request, "key").id;
  EXPECT_EQ(tested.submit("\n " + request, "key").id, id);
  EXPECT_EQ(code_of(tested.service.submit(small_request(8), "key")),
            ProblemCode::idempotency_mismatch);
}

TEST(JobServiceTest, AQueuedRenderIsCanceledAtOnce) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine(), {0, {}});
  const std::string id = tested.submit(small_request(4)).id;
  EXPECT_EQ(tested.service.cancel(id)->state, JobState::canceled);
  EXPECT_EQ(tested.service.cancel(id)->state, JobState::canceled);
  EXPECT_EQ(code_of(tested.service.image(id, {})), ProblemCode::conflict);
  EXPECT_EQ(code_of(tested.service.cancel(unknown_id)), ProblemCode::not_found);
}

TEST(JobServiceTest, ARunningRenderStopsSoonAfterItsCancelAndLeavesNoFiles) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.submit(small_request(1000)).id;
  ASSERT_TRUE(eventually([&] { return renderer.passes >= 2; }));
  renderer.milliseconds_per_pass = 60'000;
  ASSERT_TRUE(eventually([&] { return renderer.tracing == 1; }));
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(tested.service.cancel(id)->state, JobState::canceled);
  EXPECT_TRUE(eventually([&] { return renderer.tracing == 0; }));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(2));
  renderer.milliseconds_per_pass = 0;
  EXPECT_EQ(tested.wait(tested.submit(small_request(4)).id).state, JobState::succeeded);
  EXPECT_EQ(tested.state(id), JobState::canceled);
  EXPECT_THAT(tested.artifacts.names(id), IsEmpty());
}

TEST(JobServiceTest, AFinishedRenderIsNotChangedByACancel) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.wait(tested.submit(small_request(4)).id).id;
  EXPECT_EQ(tested.service.cancel(id)->state, JobState::succeeded);
  EXPECT_FALSE(tested.exr(id).empty());
}

TEST(JobServiceTest, ARemovedRenderIsGoneWhateverItWasDoing) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string done = tested.wait(tested.submit(small_request(4)).id).id;
  renderer.milliseconds_per_pass = 60'000;
  const std::string running = tested.submit(small_request(8)).id;
  ASSERT_TRUE(eventually([&] { return renderer.tracing == 1; }));
  for (const std::string& id : {done, running}) {
    EXPECT_FALSE(tested.service.remove(id));
    EXPECT_EQ(code_of(tested.service.get(id)), ProblemCode::not_found);
    EXPECT_EQ(code_of(tested.service.image(id, {})), ProblemCode::not_found);
    EXPECT_EQ(tested.service.remove(id)->code, ProblemCode::not_found);
  }
  EXPECT_TRUE(eventually([&] { return renderer.tracing == 0; }));
  EXPECT_TRUE(eventually([&] { return tested.artifacts.ids().empty(); }));
}

TEST(JobServiceTest, WaitingEndsWithTheRenderWithTheTimeOrWithTheService) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  renderer.milliseconds_per_pass = 200;
  const std::string soon = tested.submit(small_request(4)).id;
  EXPECT_EQ(tested.wait(soon).state, JobState::succeeded);
  renderer.milliseconds_per_pass = 60'000;
  const std::string late = tested.submit(small_request(4, 2)).id;
  const auto start = std::chrono::steady_clock::now();
  tested.service.changes().watch(std::chrono::milliseconds(100), [] { return false; });
  EXPECT_FALSE(is_end(tested.state(late)));
  EXPECT_GE(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(100));
  std::jthread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    tested.service.shut_down();
  });
  EXPECT_FALSE(is_end(tested.wait(late, 600).state));
  EXPECT_EQ(code_of(tested.service.submit(small_request(4), {})), ProblemCode::overloaded);
  EXPECT_TRUE(tested.service.unready_reason());
}

TEST(JobServiceTest, WhatIsRememberedOfARenderGoesWithIt) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.wait(tested.submit(small_request(4)).id).id;
  const auto told = [&] { return (*tested.service.tell(id))->json; };
  EXPECT_EQ(told(), to_json(*tested.service.get(id)));
  EXPECT_EQ(told(), told());
  EXPECT_EQ(tested.exr(id), tested.exr(id));
  EXPECT_EQ(tested.service.remove(id), std::nullopt);
  EXPECT_EQ(code_of(tested.service.tell(id)), ProblemCode::not_found);
  EXPECT_EQ(code_of(tested.service.image(id, {})), ProblemCode::not_found);
}

TEST(JobServiceTest, WhatIsToldOfARenderThatGoesOnIsNotRemembered) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  renderer.milliseconds_per_pass = 50;
  const std::string id = tested.submit(small_request(40)).id;
  const auto now = [&] { return *tested.service.tell(id); };
  const std::string first = now()->etag;
  EXPECT_TRUE(eventually([&] { return now()->state == JobState::succeeded; }));
  EXPECT_NE(now()->etag, first);
}

TEST(JobServiceTest, AStoppedServiceGivesItsTasksBack) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  renderer.milliseconds_per_pass = 60'000;
  const std::string id = tested.submit(small_request(4)).id;
  ASSERT_TRUE(eventually([&] { return renderer.tracing == 1; }));
  const auto start = std::chrono::steady_clock::now();
  tested.service.shut_down();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  EXPECT_EQ(tested.state(id), JobState::queued);
  const std::optional<Task> task = tested.store.claim(Priority::interactive);
  ASSERT_TRUE(task);
  EXPECT_EQ(task->attempts, 1) << "a task that was given back was not attempted";
}

TEST(JobServiceTest, AServiceThatDrainsIsNotReadyAndKeepsThePassUnderWay) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  renderer.milliseconds_per_pass = 300;
  const std::string id = tested.submit(small_request(1000)).id;
  ASSERT_TRUE(eventually([&] { return renderer.tracing == 1; }));
  std::jthread stopper([&] { tested.service.shut_down(std::chrono::seconds(60)); });
  ASSERT_TRUE(eventually([&] { return tested.service.changes().ended(); }));
  EXPECT_TRUE(tested.service.unready_reason());
  EXPECT_EQ(renderer.passes, 0) << "it is not ready while the pass goes on";
  const auto start = std::chrono::steady_clock::now();
  stopper.join();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
  EXPECT_EQ(renderer.passes, 1) << "no pass was begun";
  EXPECT_EQ(tested.store.find(id)->progress.passes, 1u);
}

TEST(JobServiceTest, WorkersTraceDifferentRendersAtOnceAndOneRendersPassesInOrder) {
  const TempFolder folder;
  FakeRenderer renderer;
  std::mutex mutex;
  std::map<std::uint32_t, int> seen;
  renderer.before_pass = [&](const Pass& pass) {
    const std::lock_guard lock(mutex);
    ++seen[pass.index];
  };
  renderer.milliseconds_per_pass = 30;
  TestService tested(folder.path(), renderer.engine(), {2, {}});
  std::vector<std::string> ids;
  for (int seed = 1; seed <= 4; ++seed) ids.push_back(tested.submit(small_request(12, seed)).id);
  for (const std::string& id : ids) EXPECT_EQ(tested.wait(id).state, JobState::succeeded);
  EXPECT_EQ(renderer.most_tracing, 2);
  EXPECT_EQ(seen, (std::map<std::uint32_t, int>{{0, 4}, {1, 4}, {2, 4}}));
}

TEST(JobServiceTest, PagesListEveryRenderOnce) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine(), {0, {}});
  std::vector<std::string> submitted, listed;
  for (int i = 0; i < 7; ++i) submitted.push_back(tested.submit(small_request(4)).id);
  ListQuery query{{}, {}, 3};
  do {
    const auto page = *tested.service.list(query);
    EXPECT_LE(page.renders.size(), 3u);
    for (const api::RenderStatus& status : page.renders) listed.push_back(status.id);
    query.cursor = page.next_cursor;
  } while (query.cursor);
  std::ranges::reverse(listed);
  EXPECT_EQ(listed, submitted);
  query.cursor = "before-../../etc";
  EXPECT_EQ(code_of(tested.service.list(query)), ProblemCode::invalid_request);
}

TEST(JobServiceTest, PicturesAreMadeForEveryFormatDisplayAndColorspace) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.wait(tested.submit(small_request(4)).id).id;
  std::set<std::string> etags, bytes;
  int forms = 0;
  const auto ask = [&](const ImageQuery& query) {
    auto result = tested.service.image(id, query);
    ASSERT_TRUE(result);
    const auto& image = *result;
    const std::string first = image.file->read_all();
    const auto again = *tested.service.image(id, query);
    EXPECT_EQ(again.etag, image.etag);
    EXPECT_EQ(again.file->read_all(), first);
    etags.insert(image.etag);
    bytes.insert(first);
    ++forms;
  };
  for (const Display& display : tested.colors.displays())
    for (const std::string& view : display.views) ask({ImageFormat::png, display.name, view, {}});
  ask({ImageFormat::tiff, {}, {}, {}});
  ask({ImageFormat::jpeg, {}, {}, {}});
  for (const char* colorspace : {"lin_rec709", "ACEScg", "XYZ"})
    ask({ImageFormat::exr, {}, {}, colorspace});
  EXPECT_EQ(std::ssize(etags), forms);
  EXPECT_EQ(std::ssize(bytes), forms) << "the request's metadata name the display and view";
}

TEST(JobServiceTest, ImageQueriesThatFitNothingAreRefusedWithEveryFault) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine());
  const std::string id = tested.wait(tested.submit(small_request(4)).id).id;
  const auto faults = [&](const ImageQuery& query) {
    std::string pointers;
    const auto result = tested.service.image(id, query);
    for (const api::Fault& fault : result.problem().faults) pointers += fault.pointer + ' ';
    return pointers;
  };
  EXPECT_EQ(faults({ImageFormat::png, "nowhere", {}, "XYZ"}), "?colorspace ?display ");
  EXPECT_EQ(faults({ImageFormat::png, {}, "nothing", {}}), "?view ");
  EXPECT_EQ(faults({ImageFormat::exr, "sRGB", "plain", "sRGB"}), "?colorspace ?display ?view ");
}

TEST(JobServiceTest, WhatCanBeMadeAnewIsRemovedAtTheStart) {
  const TempFolder folder;
  FakeRenderer renderer;
  std::string id;
  {
    TestService tested(folder.path(), renderer.engine());
    id = tested.wait(tested.submit(small_request(4)).id).id;
    EXPECT_TRUE(tested.service.image(id, {}));
    // What a crash between the end of the job and the removal of its checkpoints leaves.
    tested.artifacts.write(id, "film-4.bin", "left over");
    EXPECT_EQ(tested.artifacts.names(tested.content(id)).size(), 2u);
  }
  TestService tested(folder.path(), renderer.engine());
  EXPECT_EQ(tested.artifacts.names(id).size(), 0u);
  EXPECT_EQ(tested.artifacts.names(tested.content(id)).size(), 1u);
  EXPECT_TRUE(tested.service.image(id, {}));
}

TEST(JobServiceTest, FilesOfWhatWasRemovedAreRemovedAtTheStart) {
  const TempFolder folder;
  FakeRenderer renderer;
  std::string removed, content;
  {
    TestService tested(folder.path(), renderer.engine());
    removed = tested.wait(tested.submit(small_request(4)).id).id;
    content = tested.content(removed);
    // What a crash between the removal and that of the files leaves.
    ASSERT_TRUE(tested.store.remove(removed));
    tested.artifacts.write(removed, "film-4.bin", "left over");
  }
  const TestService tested(folder.path(), renderer.engine());
  EXPECT_THAT(tested.artifacts.ids(), IsEmpty());
  EXPECT_THAT(tested.store.leftovers(), IsEmpty());
}

TEST(JobServiceTest, FilesThatTheStoreDoesNotKnowStayAndAreTold) {
  const TempFolder folder;
  FakeRenderer renderer;
  const std::string content(64, 'a');
  {
    TestService tested(folder.path(), renderer.engine());
    tested.artifacts.write(unknown_id, "film-4.bin", "of a newer store");
    tested.artifacts.write(content, "image.exr", "of a newer store");
  }
  const TestService tested(folder.path(), renderer.engine());
  EXPECT_THAT(tested.artifacts.ids(), testing::UnorderedElementsAre(unknown_id, content));
  EXPECT_EQ(tested.artifacts.figures().unknown, 2u);
  EXPECT_EQ(tested.artifacts.figures().unknown_bytes, 32u);
  EXPECT_EQ(tested.artifacts.figures().bytes, 0u) << "and nothing known gives way to them";
}

TEST(JobServiceTest, ManyClientsAtOnceLoseNothing) {
  const TempFolder folder;
  FakeRenderer renderer;
  TestService tested(folder.path(), renderer.engine(), {2, {}});
  constexpr int clients = 4, each = 6;
  std::atomic<int> succeeded = 0, canceled = 0, removed = 0;
  {
    std::vector<std::jthread> threads;
    for (int c = 0; c < clients; ++c)
      threads.emplace_back([&, c] {
        for (int i = 0; i < each; ++i) {
          const std::string id = tested.submit(small_request(8, 1 + c * each + i)).id;
          EXPECT_TRUE(tested.service.list({}));
          if (i % 3 == 1) {
            EXPECT_TRUE(tested.service.cancel(id));
          }
          if (i % 3 == 2) {
            EXPECT_FALSE(tested.service.remove(id));
            ++removed;
            continue;
          }
          const JobState state = tested.wait(id).state;
          (state == JobState::succeeded ? succeeded : canceled) += 1;
          if (state == JobState::succeeded) {
            EXPECT_TRUE(tested.service.image(id, {}));
          }
        }
      });
  }
  EXPECT_EQ(succeeded + canceled + removed, clients * each);
  EXPECT_GE(succeeded.load(), clients * each / 3);
  EXPECT_EQ(std::ssize(tested.store.list({{}, {}, 1000})), clients * each - removed);
}

}  // namespace
}  // namespace translucube::server::test

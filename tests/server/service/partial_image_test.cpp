// Pictures of renders that are still being traced, and of explorable ones from memory.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "picture/image_io.h"
#include "tests/server/calls/calls_under_test.h"

namespace translucube::server::test {
namespace {

using nlohmann::json;

/// A renderer whose passes wait until they are let through.
struct Gate {
  std::atomic<int> open = 0;
  void wait_for(const Pass& pass) const {
    EXPECT_TRUE(eventually([&] { return open > static_cast<int>(pass.index); }));
  }
};

using TraceOnce = std::function<std::optional<PassFilm>()>;

/// The real renderer with something done around each pass.
Engine around_passes(std::function<std::optional<PassFilm>(const Pass&, const TraceOnce&)> around) {
  return [around = std::move(around), real = renderer_engine()](const SceneSpec& spec) {
    TracedScene scene = real(spec);
    scene.trace = [around, trace = scene.trace](const Pass& pass, int threads,
                                                const Patience& patience) {
      return around(pass, [&] { return trace(pass, threads, patience); });
    };
    return scene;
  };
}

struct PartialUnderTest : CallsUnderTest {
  using CallsUnderTest::CallsUnderTest;

  std::string exr(const std::string& id, Query query = {}) {
    query.emplace_back("format", "exr");
    const HttpResponse response = get_image(id, std::move(query));
    EXPECT_EQ(response.status, 200);
    return std::get<FileSlice>(response.body).file->read_all();
  }
  Image image(const std::string& bytes) {
    write_file(folder / "picture.exr", bytes);
    return read_image(folder / "picture.exr");
  }
};

TEST(PartialImageTest, ARenderIsSeenFromItsFirstPassOn) {
  Gate gate;
  FakeRenderer renderer;
  renderer.before_pass = [&](const Pass& pass) { gate.wait_for(pass); };
  PartialUnderTest tested(renderer.engine());
  const std::string id = tested.service.submit(small_request(16)).id;
  ASSERT_TRUE(eventually([&] { return renderer.builds == 1; }));
  EXPECT_EQ(tested.get_image(id, {{"partial", "true"}}).status, 409) << "nothing is there yet";
  EXPECT_EQ(tested.service.service.samples_to_see(id), 0u);

  gate.open = 1;
  ASSERT_TRUE(eventually([&] { return tested.service.service.samples_to_see(id) == 4; }));
  EXPECT_EQ(tested.get_image(id, {}).status, 409) << "only who asks for it gets it";
  EXPECT_EQ(tested.get_image(id, {{"partial", "false"}}).status, 409);
  EXPECT_EQ(tested.get_image(id, {{"partial", "perhaps"}}).status, 422);
  EXPECT_EQ(tested.get_image(id, {{"partial", "true"}, {"display", "none"}}).status, 422);
  const std::string early = tested.exr(id, {{"partial", "true"}});
  write_file(tested.folder / "early.exr", early);
  EXPECT_EQ(json::parse(read_metadata(tested.folder / "early.exr").request)["quality"],
            (json{{"samples", 4}}));
  EXPECT_EQ(tested.get_image(id, {{"partial", "true"}, {"absorption", "0.5"}}).status, 409)
      << "it is not explorable";

  gate.open = 100;
  tested.service.wait(id);
  const std::string whole = tested.exr(id);
  EXPECT_EQ(tested.exr(id, {{"partial", "true"}}), whole);
  EXPECT_NE(early, whole);
  EXPECT_EQ(tested.service.service.samples_to_see(id), 0u) << "no worker has it in hand";
  // With so many samples, the partial picture is the whole one of its own request.
  const std::string alone = tested.service.submit(small_request(4)).id;
  tested.service.wait(alone);
  EXPECT_EQ(tested.image(early).pixels, tested.image(tested.exr(alone)).pixels);
}

TEST(PartialImageTest, SamplesThatAreNotFiniteAreNotShown) {
  Gate gate;
  FakeRenderer renderer;
  renderer.before_pass = [&](const Pass& pass) { gate.wait_for(pass); };
  renderer.after_pass = [](PassFilm& film) { film.counters.nan_samples = 1; };
  PartialUnderTest tested(renderer.engine());
  const std::string id = tested.service.submit(small_request(16)).id;
  gate.open = 1;
  EXPECT_EQ(tested.service.wait(id).state, api::JobState::failed);
  EXPECT_EQ(tested.get_image(id, {{"partial", "true"}}).status, 409);
}

TEST(PartialImageTest, TheEventStreamSaysThatThereIsMoreToSee) {
  Gate gate;
  FakeRenderer renderer;
  renderer.before_pass = [&](const Pass& pass) { gate.wait_for(pass); };
  PartialUnderTest tested(renderer.engine());
  const std::string id = tested.service.submit(small_request(8)).id;
  const HttpResponse response = tested.listen(id);
  const EventStream& stream = std::get<EventStream>(response.body);
  std::string text;
  gate.open = 1;
  ASSERT_TRUE(eventually([&] {
    if (auto part = stream.next()) text += *part;
    return text.find("event: progress") != text.npos;
  }));
  const auto preview = text.find("event: preview\ndata: {\"samples\":4}\n\n");
  ASSERT_NE(preview, text.npos) << text;
  EXPECT_LT(preview, text.find("event: progress"));
  gate.open = 100;
}

std::string explorable_request(int samples) {
  return json{
      {"material", {{"cube", {{"absorption", 0}, {"roughness", 0.3}, {"scattering", 0.5}}}}},
      {"scene", {{"environment", {{"constant", {1, 1, 1}}}}}},
      {"image", {{"width", 12}, {"height", 12}}},
      {"quality", {{"samples", samples}}},
      {"explorable", true}}
      .dump();
}

TEST(PartialImageTest, AnExplorableRenderIsSeenThroughAnyAbsorberWhileItIsTraced) {
  Gate gate;
  PartialUnderTest tested(around_passes([&](const Pass& pass, const auto& trace) {
    gate.wait_for(pass);
    return trace();
  }));
  const std::string id = tested.service.submit(explorable_request(16)).id;
  gate.open = 1;
  ASSERT_TRUE(eventually([&] { return tested.service.service.samples_to_see(id) == 4; }));
  const std::string through = R"({"rgb":[0.1,1,0.5]})";
  const CallsUnderTest::Query query{{"absorption", "0.7"}, {"absorber", through}};
  CallsUnderTest::Query partial = query;
  partial.emplace_back("partial", "true");
  const Image early = tested.image(tested.exr(id, partial));
  EXPECT_EQ(tested.get_image(id, {{"partial", "true"}, {"absorber", "none"}}).status, 422);

  const std::string alone = tested.service.submit(explorable_request(4)).id;
  gate.open = 100;
  tested.service.wait(id);
  tested.service.wait(alone);
  const Image whole = tested.image(tested.exr(alone, query));
  for (std::size_t i = 0; i < whole.pixels.size(); ++i)
    ASSERT_NEAR(early.pixels[i], whole.pixels[i], 1e-3 * whole.pixels[i] + 1e-5) << i;
}

TEST(PartialImageTest, RedevelopmentComesFromMemoryAndFromTheDiskToTheSameBits) {
  const TempFolder folder;
  const ImageQuery query{ImageFormat::exr, {}, {}, {}, {0.7, "amber"}};
  std::string id, first;
  const auto developed = [&](TestService& service) {
    return service.service.image(id, query)->file->read_all();
  };
  {
    TestService service(folder.path(), renderer_engine());
    id = service.submit(explorable_request(4)).id;
    service.wait(id);
    const std::size_t files = service.artifacts.names(service.content(id)).size();
    first = developed(service);
    EXPECT_EQ(service.artifacts.names(service.content(id)).size(), files) << "it is not kept";
  }
  TestService restarted(folder.path(), renderer_engine());
  EXPECT_EQ(developed(restarted), first);
  std::filesystem::remove_all(folder.path() / "artifacts" / restarted.content(id));
  EXPECT_FALSE(restarted.service.image(id, query))
      << "what is gone from the disk is not served from memory";
}

TEST(PartialImageTest, AnExplorableFilmIsOnTheDiskWhenItIsPutDown) {
  const TempFolder undisturbed, restarted;
  std::atomic<int> passes = 0;
  const Engine counting = around_passes([&](const Pass&, const auto& trace) {
    auto film = trace();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    ++passes;
    return film;
  });
  std::string expected, id;
  int planned = 0;
  {
    TestService service(undisturbed.path(), counting);
    expected = service.exr(service.wait(service.submit(explorable_request(64)).id).id);
    planned = passes.exchange(0);
  }
  {
    TestService service(restarted.path(), counting);
    id = service.submit(explorable_request(64)).id;
    ASSERT_TRUE(eventually([&] { return passes >= 3; }));
    service.service.shut_down();
    ASSERT_FALSE(api::is_end(service.state(id)));
  }
  TestService service(restarted.path(), counting);
  EXPECT_EQ(service.wait(id).state, api::JobState::succeeded);
  EXPECT_EQ(service.exr(id), expected);
  EXPECT_LE(passes, planned + 1) << "but for the pass that was stopped, none was traced again";
}

TEST(ExplorableCacheTest, KeepsTheLatestWithinItsBytesAndOneAtAnySize) {
  int read = 0;
  const auto film = [&] {
    ++read;
    ExplorableFilm made;
    made.halves.resize(50);
    return made;
  };
  ExplorableCache cache(250);  // two of 100 bytes
  for (const char* name : {"a", "b", "a", "c", "a"}) cache.get(name, film);
  EXPECT_EQ(read, 3);
  cache.get("b", film);
  EXPECT_EQ(read, 4) << "the one that was not used for longest made room";
  ExplorableCache none(0);
  none.get("a", film);
  none.get("a", film);
  EXPECT_EQ(read, 5);
}

}  // namespace
}  // namespace translucube::server::test

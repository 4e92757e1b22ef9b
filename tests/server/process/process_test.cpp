// The binary itself: the service through a kill -9, and the command line's verbs.

#include "tests/server/process/process.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "picture/image_io.h"
#include "tests/server/fixture.h"
#include "tests/server/service.h"
#include "tests/support/sanitized.h"

namespace translucube::server::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

std::vector<float> pixels(const std::filesystem::path& file) { return read_image(file).pixels; }

/// Takes a few seconds, in some fifteen passes.
constexpr int steady_samples = 600;
std::string steady_request() { return small_request(steady_samples, 7, sanitized ? 16 : 48); }

std::string state_of(const Service& service, const std::string& location) {
  const json status = service.get(location);
  return status.is_object() ? std::string(status["state"]) : "";
}

TEST(ProcessTest, ARenderKilledInTheMiddleEndsWithTheBitsOfAnUndisturbedOne) {
  const TempFolder folder;
  write_file(folder / "request.json", steady_request());
  for (const char* threads : {"1", "2"}) {
    const Ran ran = run_translucube({"render", (folder / "request.json").string(), "-o",
                                     (folder / (std::string("alone") + threads + ".exr")).string(),
                                     "--threads", threads});
    ASSERT_EQ(ran.status, 0) << ran.errors;
  }
  EXPECT_EQ(pixels(folder / "alone1.exr"), pixels(folder / "alone2.exr"));

  std::string location;
  double samples_before = 0;
  {
    Service service(folder / "data");
    const auto posted = service.client().Post("/v1/renders", steady_request(), "application/json");
    ASSERT_TRUE(posted);
    ASSERT_EQ(posted->status, 202) << posted->body;
    location = posted->get_header_value("Location");
    ASSERT_TRUE(eventually([&] {
      samples_before = service.get(location)["progress"]["samples"];
      return samples_before >= 40;
    }));
    service.process().kill(SIGKILL);
    EXPECT_EQ(service.process().wait(), -SIGKILL);
  }
  ASSERT_LT(samples_before, steady_samples) << "the kill came too late to mean anything";

  Service service(folder / "data");
  EXPECT_GE(double(service.get(location)["progress"]["samples"]), samples_before);
  ASSERT_TRUE(eventually([&] { return state_of(service, location) == "succeeded"; }))
      << service.get(location).dump();
  const auto exr = service.client().Get(location + "/image?format=exr");
  ASSERT_EQ(exr->status, 200);
  write_file(folder / "killed.exr", exr->body);
  EXPECT_EQ(pixels(folder / "killed.exr"), pixels(folder / "alone1.exr"));
}

TEST(ProcessTest, SeveralKillsAtAnyMomentLoseNothingThatWasAccepted) {
  const TempFolder folder;
  std::vector<std::string> locations;
  for (int round = 0; round < 5; ++round) {
    Service service(folder / "data");
    for (int i = 0; i < 2; ++i) {
      const auto posted = service.client().Post(
          "/v1/renders", small_request(64, 10 * round + i, sanitized ? 8 : 24), "application/json");
      ASSERT_TRUE(posted);
      locations.push_back(posted->get_header_value("Location"));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(37 * round));
    service.process().kill(SIGKILL);
    service.process().wait();
  }
  Service service(folder / "data");
  for (const std::string& location : locations)
    EXPECT_TRUE(eventually([&] { return state_of(service, location) == "succeeded"; })) << location;
  const auto image = [&](const std::string& location) {
    return service.client().Get(location + "/image?format=exr")->body;
  };
  const json first = service.get(locations[0]);
  write_file(folder / "request.json", first["request"].dump());
  ASSERT_EQ(run_translucube({"render", (folder / "request.json").string(), "-o",
                             (folder / "alone.exr").string()})
                .status,
            0);
  write_file(folder / "served.exr", image(locations[0]));
  EXPECT_EQ(pixels(folder / "served.exr"), pixels(folder / "alone.exr"));
}

TEST(ProcessTest, ATerminatedServiceDrainsAndItsRenderGoesOnAfterwards) {
  const TempFolder folder;
  std::string location;
  {
    Service service(folder / "data");
    const auto posted =
        service.client().Post("/v1/renders", small_request(100'000, 3, 64), "application/json");
    location = posted->get_header_value("Location");
    ASSERT_TRUE(eventually([&] { return service.get(location)["progress"]["samples"] > 0; }));
    const auto start = std::chrono::steady_clock::now();
    service.process().kill(SIGTERM);
    EXPECT_EQ(service.process().wait(), 0);
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
    EXPECT_THAT(service.process().output(), IsEmpty()) << "one line on standard output, no more";
  }
  Service service(folder / "data");
  const double before = service.get(location)["progress"]["samples"];
  EXPECT_GT(before, 0);
  EXPECT_TRUE(eventually([&] { return service.get(location)["progress"]["samples"] > before; }));
  EXPECT_EQ(service.client().Post(location + "/cancel", "", "")->status, 200);
}

/// The states that a probe sees, one after the other, until the service is gone.
std::vector<int> probes_until_gone(int port) {
  std::vector<int> seen;
  httplib::Client client("127.0.0.1", port);
  client.set_keep_alive(true);
  while (const auto ready = client.Get("/readyz"))
    if (seen.empty() || seen.back() != ready->status) seen.push_back(ready->status);
  return seen;
}

TEST(ProcessTest, ATerminationEndsStreamsAndTheRenderHasTheBitsOfAnUndisturbedOne) {
  const TempFolder folder;
  write_file(folder / "request.json", steady_request());
  ASSERT_EQ(run_translucube({"render", (folder / "request.json").string(), "-o",
                             (folder / "alone.exr").string()})
                .status,
            0);
  std::string location;
  {
    Service service(folder / "data");
    const auto posted = service.client().Post("/v1/renders", steady_request(), "application/json");
    location = posted->get_header_value("Location");
    std::atomic<bool> streaming = false;
    const std::jthread stream([&] {
      service.client().Get(location + "/events",
                           [&](const char*, std::size_t) { return streaming = true; });
    });
    std::vector<int> seen;
    std::jthread probe([&] { seen = probes_until_gone(service.port()); });
    ASSERT_TRUE(eventually(
        [&] { return streaming && service.get(location)["progress"]["samples"] >= 40; }));
    const auto start = std::chrono::steady_clock::now();
    service.process().kill(SIGTERM);
    EXPECT_EQ(service.process().wait(), 0) << service.process().errors();
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
    probe.join();
    EXPECT_THAT(seen, testing::AnyOf(testing::ElementsAre(200), testing::ElementsAre(200, 503)))
        << "once it is not ready, it stays so";
  }
  Service service(folder / "data");
  EXPECT_LT(double(service.get(location)["progress"]["samples"]), steady_samples);
  ASSERT_TRUE(eventually([&] { return state_of(service, location) == "succeeded"; }));
  write_file(folder / "served.exr", service.client().Get(location + "/image?format=exr")->body);
  EXPECT_EQ(pixels(folder / "served.exr"), pixels(folder / "alone.exr"));
}

TEST(ProcessTest, AServiceThatDrainsIsNotReadyAndStillAnswers) {
  const TempFolder folder;
  Service service(folder / "data");
  constexpr int size = sanitized ? 128 : 512;  // a pass takes about a second
  const auto posted =
      service.client().Post("/v1/renders", small_request(100'000, 1, size), "application/json");
  const std::string location = posted->get_header_value("Location");
  ASSERT_TRUE(eventually([&] { return service.get(location)["progress"]["samples"] > 0; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // amid the next
  const auto start = std::chrono::steady_clock::now();
  service.process().kill(SIGTERM);
  ASSERT_TRUE(eventually([&] {
    const auto ready = service.client().Get("/readyz");
    return !ready || ready->status == 503;
  }));
  ASSERT_TRUE(service.client().Get("/livez"));
  EXPECT_EQ(service.get(location)["state"], "running");
  const auto refused = service.client().Post("/v1/renders", small_request(4), "application/json");
  ASSERT_TRUE(refused);
  EXPECT_EQ(refused->status, 503);
  EXPECT_FALSE(refused->get_header_value("Retry-After").empty());
  EXPECT_EQ(service.process().wait(), 0);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
}

TEST(ProcessTest, AServiceThatCannotStartSaysWhyAndEnds) {
  const TempFolder folder;
  Service service(folder / "data");
  const Ran port = run_translucube(
      {"serve", "--port", std::to_string(service.port()), "--data", (folder / "other").string()});
  EXPECT_EQ(port.status, 1);
  EXPECT_THAT(port.errors, HasSubstr("cannot listen"));
  const Ran data = run_translucube({"serve", "--port", "0", "--data", (folder / "data").string()});
  EXPECT_EQ(data.status, 1);
  EXPECT_THAT(data.errors, HasSubstr("another translucube"));
  write_file(folder / "file", "");
  const Ran place = run_translucube({"serve", "--port", "0", "--data", (folder / "file").string()});
  EXPECT_EQ(place.status, 1);
  EXPECT_THAT(place.errors, HasSubstr("data folder"));
  std::filesystem::create_directories(folder / "broken");
  write_file(folder.path() / "broken/jobs.sqlite", std::string(5000, 'x'));
  const Ran store =
      run_translucube({"serve", "--port", "0", "--data", (folder / "broken").string()});
  EXPECT_EQ(store.status, 1);
  EXPECT_THAT(store.errors, HasSubstr("job store"));
  const Ran config = run_translucube({"serve", "--config", "/nowhere.json"});
  EXPECT_EQ(config.status, 1);
  EXPECT_THAT(config.errors, HasSubstr("nowhere.json"));
}

TEST(CommandLineTest, RendersToEveryFormatAndReportsItsStats) {
  const TempFolder folder;
  const Ran ran = run_translucube(
      {"render", "-", "-o", (folder / "a.exr").string(), "-o", (folder / "a.png").string(), "-o",
       (folder / "a.tiff").string(), "-o", (folder / "a.jpg").string(), "--stats",
       (folder / "stats.json").string(), "--threads", "2", "--display", "sRGB"},
      small_request(16));
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_THAT(ran.errors, IsEmpty()) << "a pipe sees no progress";
  EXPECT_THAT(ran.output, IsEmpty());
  for (const char* name : {"a.exr", "a.png", "a.tiff", "a.jpg"}) {
    const Image image = read_image(folder / name);
    EXPECT_EQ(image.width, 8) << name;
    EXPECT_EQ(image.height, 8) << name;
    EXPECT_THAT(read_metadata(folder / name).request, HasSubstr("\"samples\":16")) << name;
  }
  const json stats = json::parse(read_file(folder / "stats.json"));
  EXPECT_EQ(stats["samples"], 16);
  EXPECT_EQ(stats["threads"], 2);
  for (const char* key : {"seconds", "cpu_seconds", "relative_error", "transport", "traced_images",
                          "nan_samples", "truncated_energy", "material"})
    EXPECT_TRUE(stats.contains(key)) << key;
}

TEST(CommandLineTest, BadRequestsNameEveryFaultAndEndWithTwo) {
  const TempFolder folder;
  const Ran ran = run_translucube({"render", "-", "-o", (folder / "a.exr").string()},
                                  R"({"material":{},"image":{"width":0,"height":2.5}})");
  EXPECT_EQ(ran.status, 2);
  for (const char* pointer : {"/material", "/image/width", "/image/height"})
    EXPECT_THAT(ran.errors, HasSubstr(pointer));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.exr"));
  EXPECT_EQ(run_translucube({"render", "-", "-o", (folder / "a.exr").string()}, "{").status, 2);
  EXPECT_EQ(run_translucube({"render", "/nowhere.json", "-o", (folder / "a.exr").string()}).status,
            2);
}

TEST(CommandLineTest, BadOptionsAreToldBeforeTheWork) {
  const TempFolder folder;
  const std::string good = small_request(4), exr = (folder / "a.exr").string(),
                    png = (folder / "a.png").string();
  const auto status = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"render", "-"});
    return run_translucube(std::move(arguments), good).status;
  };
  EXPECT_EQ(status({}), 2);
  EXPECT_EQ(status({"-o", (folder / "a.bmp").string()}), 2);
  EXPECT_EQ(status({"-o", (folder / "a").string()}), 2);
  EXPECT_EQ(status({"-o", png, "--display", "nowhere"}), 2);
  EXPECT_EQ(status({"-o", exr, "--view", "plain"}), 2);
  EXPECT_EQ(status({"-o", exr, "--threads", "-1"}), 2);
  EXPECT_EQ(status({"-o", exr, "--bogus"}), 2);
  EXPECT_EQ(status({"-o", "/nowhere/a.exr"}), 1);
  std::filesystem::create_directories(folder / "b.exr");
  EXPECT_EQ(status({"-o", (folder / "b.exr").string()}), 1);
  EXPECT_EQ(run_translucube({"bogus"}).status, 2);
  EXPECT_EQ(run_translucube({"--help"}).status, 0);
  EXPECT_THAT(run_translucube({"--version"}).output, StartsWith("translucube "));
}

TEST(CommandLineTest, ExplainsOneSampleOfOnePixel) {
  const Ran ran =
      run_translucube({"render", "-", "--pixel", "4,4", "--sample", "3"}, small_request(16));
  EXPECT_EQ(ran.status, 0) << ran.errors;
  EXPECT_THAT(ran.output, HasSubstr("radiance"));
  EXPECT_EQ(run_translucube({"render", "-", "--pixel", "8,0"}, small_request(16)).status, 2);
  EXPECT_EQ(run_translucube({"render", "-", "--pixel", "x"}, small_request(16)).status, 2);
}

TEST(CommandLineTest, AFullDiskIsAnErrorInEveryFormatAndLeavesNothing) {
  for (const char* name : {"a.exr", "a.png", "a.tiff", "a.jpg"}) {
    const TempFolder folder;
    // Ten or twenty kilobytes (shells differ) are all that a file may have here.
    Process process(
        {"/bin/sh", "-c",
         std::string("ulimit -f 20; trap '' XFSZ; exec " TRANSLUCUBE_BINARY " render - -o ") +
             (folder / name).string()},
        R"({"material":{"cube":{"absorption":0.3,"roughness":0,"scattering":0}},)"
        R"("image":{"width":256,"height":256},"quality":{"samples":4}})");
    EXPECT_EQ(process.wait(), 1) << name;
    EXPECT_THAT(process.errors(), testing::Not(IsEmpty())) << name;
    EXPECT_TRUE(std::filesystem::is_empty(folder.path())) << name;
  }
}

TEST(CommandLineTest, AnInterruptEndsItAndLeavesNothing) {
  const TempFolder folder;
  Process process({TRANSLUCUBE_BINARY, "render", "-", "-o", (folder / "a.exr").string()},
                  small_request(1'000'000, 1, 128));
  ASSERT_TRUE(eventually([&] { return process.blocks(SIGINT); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const auto start = std::chrono::steady_clock::now();
  process.kill(SIGINT);
  EXPECT_EQ(process.wait(), 130);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(5));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace translucube::server::test

// A task that ends the process: it fails alone, and the service comes up.

#include <gmock/gmock.h>

#include "tests/server/fixture.h"
#include "tests/server/service.h"
#include "tests/support/sanitized.h"

namespace translucube::server::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Its first pass takes far longer than a test.
std::string endless(int seed) { return small_request(4, seed, sanitized ? 1024 : 4096); }

std::string post_render(const Service& service, const std::string& request) {
  const auto posted = service.client().Post("/v1/renders", request, "application/json");
  return posted ? posted->get_header_value("Location") : std::string();
}

std::string told_state(const Service& service, const std::string& location) {
  const json status = service.get(location);
  return status.is_object() ? std::string(status["state"]) : "";
}

void dies_while_it_runs(const Service& service, Process& process, const std::string& location,
                        int signal) {
  ASSERT_TRUE(eventually([&] { return told_state(service, location) == "running"; }));
  // A kill from outside says something of a task that takes its time.
  if (signal == SIGKILL) std::this_thread::sleep_for(std::chrono::milliseconds(1500));
  process.kill(signal);
  const int status = process.wait();
  // Sanitizers catch it first.
  ASSERT_TRUE(status == -signal || (sanitized && status > 0)) << status;
}

TEST(PoisonTest, ARenderThatEndsTheServiceTwiceHasFailedAndTheServiceComesUp) {
  for (const int signal : {SIGSEGV, SIGKILL}) {
    const TempFolder folder;
    std::string poison;
    for (int start = 0; start < 2; ++start) {
      Service service(folder / "data");
      if (start == 0) poison = post_render(service, endless(1));
      dies_while_it_runs(service, service.process(), poison, signal);
    }
    Service service(folder / "data");
    const json status = service.get(poison);
    EXPECT_EQ(status["state"], "failed") << status.dump();
    EXPECT_THAT(status["error"].dump(), HasSubstr("ended twice while it worked on this"));
    const std::string next = post_render(service, small_request(4));
    EXPECT_TRUE(eventually([&] { return told_state(service, next) == "succeeded"; }));
  }
}

TEST(PoisonTest, AServiceToldToEndIsNoDeathHoweverOftenAPassIsCutOff) {
  const TempFolder folder;
  std::string location;
  for (int start = 0; start < 3; ++start) {
    Service service(folder / "data");
    if (start == 0) location = post_render(service, endless(2));
    ASSERT_TRUE(eventually([&] { return told_state(service, location) == "running"; }));
    service.process().kill(SIGTERM);
    if (start == 1) service.process().kill(SIGTERM);  // at once
    service.process().wait();
  }
  Service service(folder / "data");
  EXPECT_TRUE(eventually([&] { return told_state(service, location) == "running"; }));
  service.client().Post(location + "/cancel", "", "");
}

}  // namespace
}  // namespace translucube::server::test

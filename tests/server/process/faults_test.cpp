// The real service where the system refuses it something: files that may not grow, a log that
// nobody reads, a port that is taken, signals at any moment.

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "tests/server/fixture.h"
#include "tests/server/service.h"

namespace translucube::server::test {
namespace {

using nlohmann::json;

/// The service by way of a shell that sets something up for it; its port.
struct Shell {
  Shell(const std::string& before, const std::filesystem::path& data, const std::string& after = {})
      : process({"/bin/sh", "-c",
                 before + "exec " TRANSLUCUBE_BINARY " serve --port 0 --threads 2 --data " +
                     data.string() + after}) {
    const std::string line = process.line();
    const std::size_t colon = line.rfind(':');
    port = colon == line.npos ? 0 : std::stoi(line.substr(colon + 1));
  }
  httplib::Client client() const {
    httplib::Client client("127.0.0.1", port);
    client.set_read_timeout(120);
    return client;
  }
  Process process;
  int port = 0;
};

TEST(FaultsTest, AFileThatMayNotGrowIsAFullDiskAndNoEnd) {
  const TempFolder folder;
  std::string location;
  {
    Shell shell("ulimit -f 400; ", folder / "data");  // 200 or 400 KiB: shells differ
    const auto posted =
        shell.client().Post("/v1/renders", small_request(4, 1, 256), "application/json");
    ASSERT_TRUE(posted);
    ASSERT_EQ(posted->status, 202) << posted->body;
    location = posted->get_header_value("Location");
    EXPECT_TRUE(eventually([&] { return shell.client().Get("/readyz")->status == 503; }));
    EXPECT_TRUE(eventually([&] {
      return shell.client().Post("/v1/renders", small_request(4), "application/json")->status ==
             507;
    }));
    EXPECT_EQ(shell.client().Get("/livez")->status, 200);
    shell.process.kill(SIGTERM);
    EXPECT_EQ(shell.process.wait(), 0);
  }
  Service service(folder / "data");
  EXPECT_TRUE(eventually([&] { return service.get(location)["state"] == "succeeded"; }));
}

TEST(FaultsTest, ALogThatNobodyReadsStopsNothing) {
  const TempFolder folder;
  const std::string pipe = folder / "log";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  const FileDescriptor unread(::open(pipe.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC));
  Shell shell("", folder / "data", " 2> " + pipe);
  httplib::Client client = shell.client();
  client.set_keep_alive(true);
  for (int i = 0; i < 2000; ++i) ASSERT_EQ(client.Get("/v1/nothing")->status, 404) << i;
  EXPECT_EQ(client.Get("/livez")->status, 200);
  shell.process.kill(SIGTERM);
  EXPECT_EQ(shell.process.wait(), 0);
}

TEST(FaultsTest, APortThatIsTakenIsToldWithoutAnAccident) {
  const TempFolder folder;
  const Service service(folder / "data");
  for (int i = 0; i < 20; ++i) {
    const Ran ran = run_translucube(
        {"serve", "--port", std::to_string(service.port()), "--data", (folder / "other").string()});
    ASSERT_EQ(ran.status, 1) << ran.errors;
  }
}

TEST(FaultsTest, ATerminationAtAnyMomentOfTheStartIsNoAccident) {
  const TempFolder folder;
  for (int i = 0; i < 25; ++i) {
    Process process({TRANSLUCUBE_BINARY, "serve", "--port", "0", "--data", folder / "data"});
    std::this_thread::sleep_for(std::chrono::milliseconds(8 * i));
    process.kill(SIGTERM);
    EXPECT_THAT(process.wait(), testing::AnyOf(0, -SIGTERM)) << 8 * i << " ms";
  }
}

TEST(FaultsTest, AClosedTerminalDrains) {
  const TempFolder folder;
  Service service(folder / "data");
  service.process().kill(SIGHUP);
  EXPECT_EQ(service.process().wait(), 0);
}

TEST(FaultsTest, FilesOfTheServiceAreItsUsersAlone) {
  const TempFolder folder;
  Service service(folder / "data");
  const auto posted = service.client().Post("/v1/renders", small_request(4), "application/json");
  const std::string location = posted->get_header_value("Location");
  ASSERT_TRUE(eventually([&] { return service.get(location)["state"] == "succeeded"; }));
  ASSERT_EQ(service.client().Get(location + "/image?format=png")->status, 200);
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder / "data")) {
    struct stat status {};
    if (::stat(entry.path().c_str(), &status) == 0) {
      EXPECT_EQ(status.st_mode & 077, 0u) << entry.path();
    }
  }
}

}  // namespace
}  // namespace translucube::server::test

// The section `server` of service.json.

#include "server/base/server_config.h"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "api/base/config_file.h"
#include "api/request/catalog.h"
#include "tests/server/process/process.h"
#include "tests/server/temp_folder.h"
#include "tests/support/repository.h"

namespace translucube::server::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::filesystem::path shipped = in_repository("config/service.json");

class ServerConfigTest : public testing::Test {
 protected:
  ServerConfig read(const json& section) {
    write_file(file, json{{"server", section}}.dump());
    return load(file);
  }
  static ServerConfig load(const std::filesystem::path& path) {
    api::ConfigFile read(path);
    ServerConfig config = read_server_config(read);
    read.refuse_faults();
    return config;
  }

  TempFolder folder;
  std::filesystem::path file = folder / "service.json";
};

TEST_F(ServerConfigTest, IsReadWhole) {
  const ServerConfig server = read({{"host", "::1"},
                                    {"port", 0},
                                    {"data_folder", "/tmp/x/../y"},
                                    {"workers", 3},
                                    {"threads_per_worker", 2},
                                    {"http_threads", 4},
                                    {"tokens_file", "t.json"},
                                    {"hosts", {"Cube.example"}},
                                    {"origins", {"https://Lab.example"}},
                                    {"waiting_requests", 5},
                                    {"event_streams", 6},
                                    {"transfers", 7},
                                    {"connections", 8},
                                    {"header_timeout_s", 9},
                                    {"idle_timeout_s", 10},
                                    {"transfer_timeout_s", 11},
                                    {"drain_s", 2},
                                    {"queue_length", 12},
                                    {"interactive_seconds", 1.5},
                                    {"artifact_bytes", 1 << 21},
                                    {"keep_days", 30},
                                    {"memory_bytes", 14},
                                    {"explorable_memory_bytes", 13},
                                    {"log_format", "json"}});
  EXPECT_EQ(server.host, "::1");
  EXPECT_EQ(server.port, 0);
  EXPECT_EQ(server.data_folder, "/tmp/y");
  EXPECT_EQ(server.workers, 3);
  EXPECT_EQ(server.threads_per_worker, 2);
  EXPECT_EQ(server.http_threads, 4);
  EXPECT_EQ(server.tokens_file, folder / "t.json");
  EXPECT_EQ(server.hosts, std::vector<std::string>{"cube.example"});
  EXPECT_EQ(server.origins, std::vector<std::string>{"https://lab.example"});
  EXPECT_EQ(server.waiting_requests, 5);
  EXPECT_EQ(server.event_streams, 6);
  EXPECT_EQ(server.transfers, 7);
  EXPECT_EQ(server.connections, 8);
  EXPECT_EQ(server.header_timeout_s, 9);
  EXPECT_EQ(server.idle_timeout_s, 10);
  EXPECT_EQ(server.transfer_timeout_s, 11);
  EXPECT_EQ(server.drain_s, 2);
  EXPECT_EQ(server.queue_length, 12u);
  EXPECT_EQ(server.interactive_seconds, 1.5);
  EXPECT_EQ(server.artifact_bytes, 1u << 21);
  EXPECT_EQ(server.keep_days, 30);
  EXPECT_EQ(server.memory_bytes, 14u);
  EXPECT_EQ(server.explorable_memory_bytes, 13u);
  EXPECT_EQ(server.log_format, LogFormat::json);
}

TEST_F(ServerConfigTest, ItsKeysAreChecked) {
  for (const auto& [key, value, fault] : std::vector<std::tuple<std::string, json, std::string>>{
           {"tokens_file", 7, "string"},
           {"hosts", "x", "must be an array"},
           {"hosts", {"http://x"}, "each must be host or host:port"},
           {"origins", {"x"}, "each must be http[s]://host[:port]"},
           {"origins", {"http://x/"}, "each must be http[s]://host[:port]"},
           {"event_streams", -1, "integer"},
           {"connections", 0, "integer"},
           {"log_format", "xml", "must be logfmt or json"},
           {"log", "json", "unknown key"}}) {
    try {
      read({{key, value}});
      ADD_FAILURE() << "accepted: " << key;
    } catch (const api::ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr("/server/" + key + ": ")) << key;
      EXPECT_THAT(error.what(), HasSubstr(fault)) << key;
    }
  }
}

TEST_F(ServerConfigTest, TheShippedSectionHoldsTheDefaults) {
  const ServerConfig given = load(shipped), defaults;
  EXPECT_EQ(given.data_folder, shipped.parent_path().parent_path() / "data");
  EXPECT_EQ(given.host, defaults.host);
  EXPECT_EQ(given.port, defaults.port);
  EXPECT_EQ(given.threads_per_worker, defaults.threads_per_worker);
  EXPECT_EQ(given.tokens_file, defaults.tokens_file);
  EXPECT_EQ(given.hosts, defaults.hosts);
  EXPECT_EQ(given.origins, defaults.origins);
  EXPECT_EQ(given.http_threads, defaults.http_threads);
  EXPECT_EQ(given.waiting_requests, defaults.waiting_requests);
  EXPECT_EQ(given.event_streams, defaults.event_streams);
  EXPECT_EQ(given.transfers, defaults.transfers);
  EXPECT_EQ(given.connections, defaults.connections);
  EXPECT_EQ(given.header_timeout_s, defaults.header_timeout_s);
  EXPECT_EQ(given.idle_timeout_s, defaults.idle_timeout_s);
  EXPECT_EQ(given.transfer_timeout_s, defaults.transfer_timeout_s);
  EXPECT_EQ(given.drain_s, defaults.drain_s);
  EXPECT_EQ(given.queue_length, defaults.queue_length);
  EXPECT_EQ(given.interactive_seconds, defaults.interactive_seconds);
  EXPECT_EQ(given.artifact_bytes, defaults.artifact_bytes);
  EXPECT_EQ(given.keep_days, defaults.keep_days);
  EXPECT_EQ(given.memory_bytes, defaults.memory_bytes);
  EXPECT_EQ(given.explorable_memory_bytes, defaults.explorable_memory_bytes);
  EXPECT_EQ(given.log_format, defaults.log_format);
}

TEST_F(ServerConfigTest, MayBeLeftOut) {
  write_file(file, "{}");
  const ServerConfig server = load(file);
  EXPECT_EQ(server.port, 8080);
  EXPECT_EQ(server.data_folder, folder.path().parent_path() / "data");
}

TEST_F(ServerConfigTest, ItsFaultsAreToldWithThoseOfTheOtherSectionsByEveryVerb) {
  json config = json::parse(std::ifstream(shipped));
  config["server"]["prt"] = 1;
  config["limits"]["pixels"] = 0;
  config["sever"] = json::object();
  write_file(file, config.dump());
  for (const char* verb : {"render", "sweep", "appearance"}) {
    const Ran ran = run_translucube({verb, "-", "-o", folder / "out.exr", "--config", file}, "{}");
    EXPECT_EQ(ran.status, 1) << verb;
    EXPECT_THAT(ran.errors, HasSubstr(file.string() + " is not a valid configuration\n")) << verb;
    EXPECT_THAT(ran.errors, HasSubstr("/server/prt: unknown key; known here: artifact_bytes, "));
    EXPECT_THAT(ran.errors, HasSubstr("/limits/pixels: must be an integer"));
    EXPECT_THAT(ran.errors,
                HasSubstr("/sever: unknown key; known here: absorbers, display_config, "
                          "environments, file_folders, limits, request_defaults, server\n"));
  }
}

}  // namespace
}  // namespace translucube::server::test

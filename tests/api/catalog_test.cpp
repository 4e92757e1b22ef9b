#include <nlohmann/json.hpp>

#include "api/answer/material_report.h"
#include "renderer/film/absorption.h"
#include "tests/api/fixture.h"
#include "tests/support/repository.h"

namespace translucube::api {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// A copy of the shipped configuration to break.
class Configuration : public testing::Test {
 protected:
  Configuration() {
    std::filesystem::copy(service_json().parent_path() / "absorbers", folder.path() / "absorbers");
    for (const char* name : {"forest", "sunrise"})
      folder.write("environments/" + std::string(name) + ".exr", "");
  }

  Catalog load() {
    folder.write("service.json", config.dump());
    return load_catalog(folder.path() / "service.json");
  }
  std::string error() {
    try {
      load();
    } catch (const ConfigError& e) {
      return e.what();
    }
    ADD_FAILURE() << "accepted";
    return {};
  }

  TemporaryFolder folder;
  json config = json::parse(std::ifstream(service_json()));
};

TEST(Catalog, ShippedConfigurationHasEightAbsorbersAndTwoEnvironments) {
  const Catalog& catalog = shipped_catalog();
  EXPECT_GE(catalog.absorbers.size(), 8u);
  EXPECT_TRUE(catalog.absorbers.contains("red-glass"));
  EXPECT_TRUE(catalog.environments.contains("forest"));
  EXPECT_TRUE(catalog.environments.contains("sunrise"));
  EXPECT_EQ(std::get<std::string>(catalog.defaults.material.absorber), "red-glass");
  EXPECT_TRUE(catalog.file_folders.empty());
  EXPECT_FALSE(catalog.any_file);
}

TEST(Catalog, PathsAreRelativeToTheConfiguration) {
  const auto config = service_json().parent_path();
  EXPECT_EQ(shipped_catalog().display_config, config / "display.ocio");
  EXPECT_EQ(shipped_catalog().server.data_folder, config.parent_path() / "data");
  EXPECT_EQ(shipped_catalog().environments.at("forest"), config / "environments/forest.exr");
}

TEST(Catalog, ShippedAbsorbersCoverTheVisibleSpectrumUpToTheirPeak) {
  for (const auto& [name, absorber] : shipped_catalog().absorbers) {
    const auto& [wavelengths, values] = absorber.spectrum;
    EXPECT_LE(wavelengths.front(), 380) << name;
    EXPECT_GE(wavelengths.back(), 780) << name;
    EXPECT_EQ(*std::max_element(values.begin(), values.end()), 1) << name;
    EXPECT_FALSE(absorber.description.empty()) << name;
  }
}

TEST(Catalog, RedGlassIsReddish) {
  const RenderRequest request =
      accepted(R"({"material":{"cube":{"absorption":0.9,"roughness":0,"scattering":0}}})");
  const json color =
      json::parse(material_report(request, shipped_catalog()))["color_through_reference"];
  EXPECT_GT(color[0].get<double>(), 3 * color[1].get<double>());
  EXPECT_GT(color[0].get<double>(), 2 * color[2].get<double>());
  EXPECT_GT(color[0].get<double>(), 0.5);
}

TEST_F(Configuration, IsReadWhole) {
  config["limits"] = {{"body_bytes", 2048}, {"pixels", 64}, {"samples", 5}, {"seconds", 1.5}};
  config["server"] = {{"host", "::1"},
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
                      {"log_format", "json"}};
  config["request_defaults"]["image"] = {{"width", 8}, {"height", 8}};
  config["request_defaults"]["quality"] = {{"samples", 4}};
  config["file_folders"] = {"."};
  const Catalog catalog = load();
  EXPECT_EQ(catalog.limits.body_bytes, 2048u);
  EXPECT_EQ(catalog.limits.pixels, 64u);
  EXPECT_EQ(catalog.limits.samples, 5u);
  EXPECT_EQ(catalog.limits.seconds, 1.5);
  EXPECT_EQ(catalog.server.host, "::1");
  EXPECT_EQ(catalog.server.port, 0);
  EXPECT_EQ(catalog.server.data_folder, "/tmp/y");
  EXPECT_EQ(catalog.server.workers, 3);
  EXPECT_EQ(catalog.server.threads_per_worker, 2);
  EXPECT_EQ(catalog.server.http_threads, 4);
  EXPECT_EQ(catalog.server.tokens_file, folder.path() / "t.json");
  EXPECT_EQ(catalog.server.hosts, std::vector<std::string>{"cube.example"});
  EXPECT_EQ(catalog.server.origins, std::vector<std::string>{"https://lab.example"});
  EXPECT_EQ(catalog.server.waiting_requests, 5);
  EXPECT_EQ(catalog.server.event_streams, 6);
  EXPECT_EQ(catalog.server.transfers, 7);
  EXPECT_EQ(catalog.server.connections, 8);
  EXPECT_EQ(catalog.server.header_timeout_s, 9);
  EXPECT_EQ(catalog.server.idle_timeout_s, 10);
  EXPECT_EQ(catalog.server.transfer_timeout_s, 11);
  EXPECT_EQ(catalog.server.drain_s, 2);
  EXPECT_EQ(catalog.server.log_format, LogFormat::json);
  EXPECT_EQ(catalog.defaults.width, 8);
  EXPECT_EQ(catalog.defaults.quality, Quality(SampleTarget{4}));
  EXPECT_EQ(catalog.file_folders, std::vector{folder.path()});
}

TEST_F(Configuration, TheServersKeysAreChecked) {
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
    config["server"] = {{key, value}};
    EXPECT_THAT(error(), HasSubstr("/server/" + key + ": ")) << key;
    EXPECT_THAT(error(), HasSubstr(fault)) << key;
  }
}

TEST_F(Configuration, TheShippedServerSectionHoldsTheDefaults) {
  const ServerConfig& shipped = shipped_catalog().server;
  const ServerConfig defaults;
  EXPECT_EQ(shipped.host, defaults.host);
  EXPECT_EQ(shipped.port, defaults.port);
  EXPECT_EQ(shipped.threads_per_worker, defaults.threads_per_worker);
  EXPECT_EQ(shipped.tokens_file, defaults.tokens_file);
  EXPECT_EQ(shipped.hosts, defaults.hosts);
  EXPECT_EQ(shipped.origins, defaults.origins);
  EXPECT_EQ(shipped.http_threads, defaults.http_threads);
  EXPECT_EQ(shipped.waiting_requests, defaults.waiting_requests);
  EXPECT_EQ(shipped.event_streams, defaults.event_streams);
  EXPECT_EQ(shipped.transfers, defaults.transfers);
  EXPECT_EQ(shipped.connections, defaults.connections);
  EXPECT_EQ(shipped.header_timeout_s, defaults.header_timeout_s);
  EXPECT_EQ(shipped.idle_timeout_s, defaults.idle_timeout_s);
  EXPECT_EQ(shipped.transfer_timeout_s, defaults.transfer_timeout_s);
  EXPECT_EQ(shipped.drain_s, defaults.drain_s);
  EXPECT_EQ(shipped.queue_length, defaults.queue_length);
  EXPECT_EQ(shipped.interactive_seconds, defaults.interactive_seconds);
  EXPECT_EQ(shipped.artifact_bytes, defaults.artifact_bytes);
  EXPECT_EQ(shipped.log_format, defaults.log_format);
}

void expect_documented(const json& value, const std::string& path, const std::string& document) {
  for (const auto& [key, member] : value.items()) {
    const std::string name = path.empty() ? key : path + '.' + key;
    // What a request may say, its defaults included, is described in api/openapi.json.
    if (member.is_object() && name != "request_defaults")
      expect_documented(member, name, document);
    else
      EXPECT_THAT(document, HasSubstr("\n| `" + name + "` |")) << name;
  }
}

TEST_F(Configuration, EveryKeyOfTheShippedFileIsDocumented) {
  std::ifstream file(in_repository("docs/configuration.md"));
  expect_documented(config, "", {std::istreambuf_iterator<char>(file), {}});
}

TEST_F(Configuration, ServerAndLimitsHaveDefaults) {
  config.erase("limits");
  config.erase("server");
  config.erase("file_folders");
  const Catalog catalog = load();
  EXPECT_EQ(catalog.server.port, 8080);
  EXPECT_EQ(catalog.limits.body_bytes, 1u << 20);
  EXPECT_EQ(catalog.server.data_folder, folder.path().parent_path() / "data");
}

TEST_F(Configuration, ErrorsNameFilePointerAndReason) {
  config["request_defaults"]["material"]["ior"] = 7;
  config["server"]["prt"] = 1;
  EXPECT_THAT(error(), HasSubstr((folder.path() / "service.json").string()));
  EXPECT_THAT(error(), HasSubstr("/server/prt: unknown key"));
  config["server"].erase("prt");
  EXPECT_THAT(error(), HasSubstr("/request_defaults/material/ior: must be a number in [1, 4]"));
}

TEST_F(Configuration, EveryRequestDefaultMustStandThere) {
  const json whole = config["request_defaults"];
  const json leaves = whole.flatten();
  for (const auto& [pointer, value] : leaves.items()) {
    if (pointer.find("_mm/") != pointer.npos || pointer.find("/up/") != pointer.npos) continue;
    const json::json_pointer where(pointer);
    config["request_defaults"] = whole;
    config["request_defaults"][where.parent_pointer()].erase(where.back());
    EXPECT_THAT(error(), HasSubstr("/request_defaults/")) << pointer;
  }
}

TEST_F(Configuration, DefaultsHaveNoPlaceInTheCube) {
  config["request_defaults"]["material"]["cube"] = json::parse(some_cube);
  EXPECT_THAT(error(), HasSubstr("/request_defaults/material/cube: unknown key"));
}

TEST_F(Configuration, DefaultsMustExistAndLieWithinTheLimits) {
  config["request_defaults"]["material"]["absorber"] = "unobtainium";
  config["request_defaults"]["scene"]["environment"]["image"] = "moon";
  config["limits"]["pixels"] = 100;
  const std::string message = error();
  EXPECT_THAT(message, HasSubstr("/request_defaults/material/absorber"));
  EXPECT_THAT(message, HasSubstr("/request_defaults/scene/environment/image"));
  EXPECT_THAT(message, HasSubstr("/request_defaults/image"));
}

TEST_F(Configuration, MissingSectionsAreNamed) {
  config = json::object();
  const std::string message = error();
  for (const char* key : {"absorbers", "environments", "display_config", "request_defaults"})
    EXPECT_THAT(message, HasSubstr("/" + std::string(key) + ": is required"));
}

TEST_F(Configuration, BadAbsorberFileIsNamed) {
  folder.write("absorbers/bad.json",
               R"({"description":"x","source":"y","wavelengths_nm":[500,400],"values":[1,1]})");
  EXPECT_THAT(error(), HasSubstr("bad.json"));
  EXPECT_THAT(error(), HasSubstr("/wavelengths_nm: must rise strictly"));
  folder.write("absorbers/bad.json", R"({"wavelengths_nm":[400,500],"values":[1,1]})");
  EXPECT_THAT(error(), HasSubstr("/source: is required"));
  folder.write("absorbers/bad.json", "{");
  EXPECT_THAT(error(), HasSubstr("bad.json"));
}

TEST_F(Configuration, NamesAreFitForRequests) {
  folder.write("environments/my sky.exr", "");
  EXPECT_THAT(error(), HasSubstr("my sky.exr"));
}

TEST_F(Configuration, TwoEnvironmentsOfOneNameAreRefused) {
  folder.write("environments/forest.hdr", "");
  EXPECT_THAT(error(), HasSubstr("another file of this name"));
}

TEST_F(Configuration, FoldersMustExist) {
  config["absorbers"] = "nowhere";
  EXPECT_THAT(error(), HasSubstr("nowhere"));
  config["absorbers"] = "absorbers";
  config["file_folders"] = {"nowhere"};
  EXPECT_THAT(error(), HasSubstr("/file_folders/0: there is no such folder"));
}

TEST_F(Configuration, FileThatCannotBeReadIsNamed) {
  const auto load_file = [](const std::filesystem::path& file) {
    EXPECT_THROW(load_catalog(file), ConfigError) << file;
  };
  load_file(folder.path() / "none.json");
  load_file(folder.path());
  load_file(folder.write("broken.json", "{\"limits\":"));
}

}  // namespace
}  // namespace translucube::api

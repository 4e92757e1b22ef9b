#include <nlohmann/json.hpp>

#include "api/answer/material_report.h"
#include "api/base/config_file.h"
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
  config["request_defaults"]["image"] = {{"width", 8}, {"height", 8}};
  config["request_defaults"]["quality"] = {{"samples", 4}};
  config["file_folders"] = {"."};
  const Catalog catalog = load();
  EXPECT_EQ(catalog.limits.body_bytes, 2048u);
  EXPECT_EQ(catalog.limits.pixels, 64u);
  EXPECT_EQ(catalog.limits.samples, 5u);
  EXPECT_EQ(catalog.limits.seconds, 1.5);
  EXPECT_EQ(catalog.defaults.width, 8);
  EXPECT_EQ(catalog.defaults.quality, Quality(SampleTarget{4}));
  EXPECT_EQ(catalog.file_folders, std::vector{folder.path()});
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

TEST_F(Configuration, LimitsHaveDefaultsAndOtherSectionsAreOptional) {
  config.erase("limits");
  config.erase("server");
  config.erase("file_folders");
  const Catalog catalog = load();
  EXPECT_EQ(catalog.limits.body_bytes, 1u << 20);
}

TEST_F(Configuration, ErrorsNameFilePointerAndReason) {
  config["request_defaults"]["material"]["ior"] = 7;
  config["limits"]["pxels"] = 1;
  config["sever"] = json::object();
  EXPECT_THAT(error(), HasSubstr((folder.path() / "service.json").string()));
  EXPECT_THAT(error(), HasSubstr("/limits/pxels: unknown key"));
  EXPECT_THAT(error(), HasSubstr("/sever: unknown key"));
  config["limits"].erase("pxels");
  config.erase("sever");
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

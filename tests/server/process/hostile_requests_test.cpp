// What ended the service once: numbers far outside of what anybody means, and files that are not
// what they say. The real service is sent them, and is found serving.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/server/fixture.h"
#include "tests/server/service.h"
#include "tests/server/temp_folder.h"
#include "tests/support/sanitized.h"

namespace translucube::server::test {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// A service whose requests may name the files of a folder.
class HostileRequestsTest : public testing::Test {
 protected:
  HostileRequestsTest() {
    fs::create_directory(files());
    fs::copy(in_repository("config"), folder_ / "config", fs::copy_options::recursive);
    std::ifstream in(in_repository("config/service.json"));
    json config = json::parse(in);
    config["file_folders"] = {files().string()};
    std::ofstream(folder_ / "config/service.json") << config;
  }

  fs::path files() const { return folder_ / "files"; }
  fs::path write(const std::string& name, const std::string& bytes) const {
    std::ofstream(files() / name, std::ios::binary) << bytes;
    return files() / name;
  }
  Service service() const {
    return Service(folder_ / "data", "2", folder_ / "config/service.json");
  }

  static json request() {
    return {{"material", {{"cube", {{"absorption", 0.3}, {"roughness", 0}, {"scattering", 0.2}}}}},
            {"image", {{"width", 8}, {"height", 8}}},
            {"quality", {{"samples", 4}}}};
  }

  static json ask(httplib::Client client, const json& body) {
    const auto answer =
        client.Post("/v1/renders", {{"Prefer", "wait=60"}}, body.dump(), "application/json");
    if (!answer) return {{"status", 0}};
    json result = json::parse(answer->body);
    result["status"] = answer->status;
    return result;
  }

  TempFolder folder_;
};

TEST_F(HostileRequestsTest, NumbersFarOutEndNothing) {
  Service running = service();
  for (const double degrees : {1e41, -1e41, 1e308, 1e-300}) {
    json asked = request();
    asked["scene"]["environment"] = {{"image", "forest"}, {"rotation_deg", degrees}};
    const json answer = ask(running.client(), asked);
    EXPECT_EQ(answer["state"], "succeeded") << degrees << answer;
  }
  json asked = request();
  asked["scene"]["camera"] = {{"position_mm", {0, 0, 90}}, {"up", {0, 1e300, 0}}};
  EXPECT_EQ(ask(running.client(), asked)["state"], "succeeded");
  EXPECT_EQ(running.client().Get("/livez")->status, 200);
}

TEST_F(HostileRequestsTest, MalformedFilesAreTheClientsFaultAndEndNothing) {
  const std::string ply =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
      "property float y\nproperty float z\nelement face 4\n"
      "property list uchar int vertex_indices\n";
  const std::string good = ply + "end_header\n" + std::string(48, '\0');
  ASSERT_EQ(::mkfifo((files() / "pipe.obj").c_str(), 0600), 0);
  const std::vector<fs::path> cases{
      write("trunc.ply", good),
      write("idx.ply", good + "\x03\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f\x7f"),
      write("list255.ply", good + "\xff\x01"),
      write("noend.ply", ply),
      write("huge.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999999\nend_header\n"),
      write("empty.obj", ""),
      files() / "pipe.obj"};
  Service running = service();
  for (const fs::path& file : cases) {
    json asked = request();
    asked["scene"]["object"] = {{"type", "mesh"}, {"file", file.string()}};
    const json answer = ask(running.client(), asked);
    EXPECT_EQ(answer["status"], 422) << file << answer;
    EXPECT_EQ(running.client().Get("/livez")->status, 200) << file;
  }
  EXPECT_EQ(ask(running.client(), request())["state"], "succeeded");
}

TEST_F(HostileRequestsTest, AMaterialLibraryIsNeverOpened) {
  const fs::path pipe = files() / "pipe.mtl";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  json asked = request();
  asked["scene"]["object"] = {
      {"type", "mesh"},
      {"file", write("tetrahedron.obj",
                     "mtllib pipe.mtl\nusemtl a\nv 0 0 0\nv 9 0 0\nv 0 9 0\n"
                     "v 0 0 9\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
                   .string()}};
  Service running = service();
  EXPECT_EQ(ask(running.client(), asked)["state"], "succeeded");
}

TEST_F(HostileRequestsTest, DamagedEnvironmentsEndNothing) {
  Service running = service();
  for (const std::string& bytes :
       {std::string("\x76\x2f\x31\x01\x02\0\0\0channels", 16), std::string("#?RADIANCE\n"),
        std::string("\x89PNG\r\n\x1a\n\0\0\0", 11), std::string("\xff\xd8\xff\xe1\xff\xff"),
        std::string("II*\0\xff\xff\xff\x7f", 8), std::string()}) {
    json asked = request();
    asked["scene"]["environment"] = {{"file", write("map", bytes).string()}};
    const json answer = ask(running.client(), asked);
    EXPECT_EQ(answer["status"], 422) << answer;
    EXPECT_EQ(running.client().Get("/livez")->status, 200);
  }
  EXPECT_EQ(ask(running.client(), request())["state"], "succeeded");
}

TEST_F(HostileRequestsTest, PassesOfHoursEndWhenTheyAreCanceled) {
  Service running = service();
  json hours = request();
  hours["material"] = {{"cube", {{"absorption", 0}, {"roughness", 0}, {"scattering", 0.9999}}},
                       {"anisotropy", 0.9}};
  hours["image"] = {{"width", 512}, {"height", 512}};
  std::vector<std::string> links;
  for (int seed = 1; seed <= 4; ++seed) {  // more than there are workers
    hours["seed"] = seed;
    const auto posted = running.client().Post("/v1/renders", hours.dump(), "application/json");
    ASSERT_EQ(posted->status, 202);
    links.push_back(posted->get_header_value("Location"));
  }
  ASSERT_TRUE(eventually([&] { return running.get(links[0])["state"] == "running"; }));
  const auto start = std::chrono::steady_clock::now();
  for (const std::string& link : links)
    EXPECT_EQ(running.client().Post(link + "/cancel", "", "")->status, 200);
  EXPECT_EQ(ask(running.client(), request())["state"], "succeeded");
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
  EXPECT_LT(took.count(), sanitized ? 20 : 2);
}

}  // namespace
}  // namespace translucube::server::test

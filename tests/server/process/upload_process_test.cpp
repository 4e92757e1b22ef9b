// Uploads to the service as it runs: through kills and restarts, in bounded memory, to a picture.

#include <gmock/gmock.h>

#include <charconv>

#include "server/base/ids.h"
#include "tests/server/fixture.h"
#include "tests/server/http/wire.h"
#include "tests/server/service.h"
#include "tests/server/tiny_uploads.h"
#include "tests/support/sanitized.h"

namespace translucube::server::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

std::string mesh_path(const std::string& bytes) { return "/v1/meshes/" + hex(sha256(bytes)); }

std::vector<std::string> half_written(const fs::path& data) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(data / "uploads"))
    if (!entry.is_directory()) names.push_back(entry.path().filename());
  return names;
}

std::string render_of(const std::string& mesh, const std::string& map) {
  json document = json::parse(small_request(4));
  document["scene"]["object"] = {{"type", "mesh"}, {"upload", hex(sha256(mesh))}};
  document["scene"]["environment"] = {{"upload", hex(sha256(map))}};
  document["scene"]["camera"] = {{"position_mm", {0.2, 0.2, 5}}, {"target_mm", {0.2, 0.2, 0}}};
  return document.dump();
}

std::string of_size(const std::string& size) {
  return "v 0 0 0\nv " + size + " 0 0\nv 0 " + size + " 0\nv 0 0 " + size +
         "\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
}

/// The most memory that a process had [KiB].
long peak_memory(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string text; std::getline(status, text);)
    if (text.starts_with("VmHWM:")) return std::stol(text.substr(6));
  return 0;
}

TEST(UploadProcessTest, WhatWasKeptOutlivesAKillAndWhatWasNotIsGone) {
  const TempFolder folder;
  const fs::path data = folder / "data";
  {
    Service service(data);
    EXPECT_EQ(service.client().Put(mesh_path(tetrahedron), tetrahedron, "model/obj")->status, 201);
    Wire half(service.port());
    half.send("PUT " + mesh_path(tetrahedron_of(1)) +
              " HTTP/1.1\r\nHost: localhost\r\nContent-Length: 5000\r\n\r\nv 0 0 0\n");
    ASSERT_TRUE(eventually([&] { return half_written(data).size() == 1; }));
    service.process().kill(SIGKILL);
    service.process().wait();
  }
  EXPECT_EQ(half_written(data).size(), 1u);
  Service service(data);
  EXPECT_THAT(half_written(data), IsEmpty());
  EXPECT_EQ(service.get("/v1/meshes")["meshes"].size(), 1u);
  const auto client = [&] { return service.client(); };
  EXPECT_EQ(client().Put(mesh_path(tetrahedron), tetrahedron, "model/obj")->status, 200);
  const std::string map_path = "/v1/environments/" + hex(sha256(tiny_map));
  EXPECT_EQ(client().Put(map_path, tiny_map, "image/vnd.radiance")->status, 201);
  const auto posted = client().Post("/v1/renders", {{"Prefer", "wait=60"}},
                                    render_of(tetrahedron, tiny_map), "application/json");
  ASSERT_EQ(posted->status, 200) << posted->body;
  const json status = json::parse(posted->body);
  EXPECT_EQ(status["state"], "succeeded") << status;
  EXPECT_EQ(status["stats"]["mesh"], (json{{"vertices", 4},
                                           {"triangles", 4},
                                           {"welded_vertices", 0},
                                           {"dropped_triangles", 0},
                                           {"parts", 1},
                                           {"smooth", nullptr}}));
  EXPECT_EQ((fs::status(data / "uploads").permissions() & fs::perms::others_all), fs::perms::none);
}

TEST(UploadProcessTest, ALargeFileTakesNoMemoryOfTheService) {
  if (sanitized) GTEST_SKIP() << "memory is looked at";
  const TempFolder folder;
  Service service(folder / "data");
  // What the first one needs once.
  EXPECT_EQ(service.client().Put(mesh_path(tetrahedron), tetrahedron, "model/obj")->status, 201);
  const long before = peak_memory(service.process().pid());
  std::string large = tetrahedron;
  while (large.size() < (64 << 20)) large += "# a line that says nothing of the surface\n";
  EXPECT_EQ(service.client().Put(mesh_path(large), large, "model/obj")->status, 201);
  EXPECT_LT(peak_memory(service.process().pid()) - before, 16 << 10);
}

TEST(UploadProcessTest, WhatLiesOfItsSizeIsRefusedAndTheServiceGoesOn) {
  const TempFolder folder;
  Service service(folder / "data");
  const auto put = [&](const std::string& bytes) {
    return service.client().Put(mesh_path(bytes), bytes, "application/octet-stream");
  };
  std::string stl(84, '\0');
  stl[83] = '\x06';
  const auto many = put(stl);
  EXPECT_EQ(many->status, 422);
  EXPECT_THAT(many->body, HasSubstr("100663296 triangles"));
  const std::string glb = std::string("glTF\2\0\0\0\xff\xff\xff\xff", 12);
  EXPECT_THAT(put(glb)->body, HasSubstr("announces 4294967295 bytes"));
  const json bomb{{"asset", {{"version", "2.0"}}},
                  {"scenes", {{{"nodes", {0}}}}},
                  {"nodes", {{{"mesh", 0}}}},
                  {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}},
                  {"accessors",
                   {{{"componentType", 5126},
                     {"count", 4294967295u},
                     {"type", "VEC3"},
                     {"sparse",
                      {{"count", 0},
                       {"indices", {{"bufferView", 0}, {"componentType", 5121}}},
                       {"values", {{"bufferView", 0}}}}}}}}};
  EXPECT_THAT(put(bomb.dump())->body, HasSubstr("more elements than the file has bytes"));
  EXPECT_THAT(put(of_size("1e-9"))->body, HasSubstr("1e-09 mm large"));
  EXPECT_THAT(put(of_size("2e9"))->body, HasSubstr("2e+09 mm large"));
  EXPECT_EQ(service.client().Get("/livez")->status, 200);
  EXPECT_EQ(service.get("/v1/meshes")["meshes"].size(), 0u);
}

}  // namespace
}  // namespace translucube::server::test

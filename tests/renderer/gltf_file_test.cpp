// glTF 2.0 means what its specification says, or is refused with the pointer and why.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <nlohmann/json.hpp>
#include <string>

#include "renderer/shape/file/gltf/data_uri.h"
#include "renderer/shape/file/mesh_format.h"
#include "tests/support/meshes.h"

namespace translucube::test {
namespace {

using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

template <class T>
void put(std::string& bytes, T value) {
  using Bits = std::conditional_t<sizeof(T) == 1, std::uint8_t,
                                  std::conditional_t<sizeof(T) == 2, std::uint16_t, std::uint32_t>>;
  const auto bits = std::bit_cast<Bits>(value);
  for (std::size_t i = 0; i < sizeof(T); ++i) bytes += static_cast<char>(bits >> 8 * i & 255);
}

/// A document and its one buffer, built view by view.
struct Asset {
  json document{{"asset", {{"version", "2.0"}}}, {"scene", 0},
                {"scenes", {{{"nodes", {0}}}}},  {"nodes", {{{"mesh", 0}}}},
                {"bufferViews", json::array()},  {"accessors", json::array()}};
  std::string bytes;

  template <class T>
  int view(const std::vector<T>& values) {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    const std::size_t offset = bytes.size();
    for (const T value : values) put(bytes, value);
    document["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", bytes.size() - offset}});
    return static_cast<int>(document["bufferViews"].size()) - 1;
  }
  int accessor(json members) {
    document["accessors"].push_back(std::move(members));
    return static_cast<int>(document["accessors"].size()) - 1;
  }
  int points(const std::vector<Vec3>& points) {
    std::vector<float> values;
    for (const Vec3& p : points)
      for (const double x : {p.x, p.y, p.z}) values.push_back(static_cast<float>(x));
    return accessor({{"bufferView", view(values)},
                     {"componentType", 5126},
                     {"count", points.size()},
                     {"type", "VEC3"}});
  }
  template <class T>
  int indices(const std::vector<T>& values) {
    const int type = sizeof(T) == 1 ? 5121 : sizeof(T) == 2 ? 5123 : 5125;
    return accessor({{"bufferView", view(values)},
                     {"componentType", type},
                     {"count", values.size()},
                     {"type", "SCALAR"}});
  }

  std::string glb() const {
    json whole = document;
    std::string binary = bytes;
    whole["buffers"] = {{{"byteLength", binary.size()}}};
    binary.resize((binary.size() + 3) / 4 * 4);
    return glb(whole.dump(), binary);
  }
  static std::string glb(std::string text, const std::string& binary) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string file = "glTF";
    put(file, std::uint32_t{2});
    put(file, static_cast<std::uint32_t>(12 + 8 + text.size() + 8 + binary.size()));
    put(file, static_cast<std::uint32_t>(text.size()));
    file += "JSON" + text;
    put(file, static_cast<std::uint32_t>(binary.size()));
    return file + std::string("BIN\0", 4) + binary;
  }
  /// As a document with its buffer embedded.
  std::string text() const {
    constexpr const char* digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string padded = bytes, base64;
    padded.resize((bytes.size() + 2) / 3 * 3);
    for (std::size_t i = 0; i < padded.size(); i += 3) {
      const auto at = [&](std::size_t j) { return static_cast<unsigned char>(padded[i + j]); };
      const unsigned bits = unsigned(at(0)) << 16 | unsigned(at(1)) << 8 | at(2);
      for (const int shift : {18, 12, 6, 0}) base64 += digits[bits >> shift & 63];
    }
    for (std::size_t i = 0; i < padded.size() - bytes.size(); ++i)
      base64[base64.size() - 1 - i] = '=';
    json whole = document;
    whole["buffers"] = {
        {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64}}};
    return whole.dump(1);
  }
};

std::vector<std::uint16_t> corners_of(const TriangleMesh& mesh) {
  std::vector<std::uint16_t> corners;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) corners.push_back(static_cast<std::uint16_t>(v));
  return corners;
}

/// A box of 2 x 4 x 6 mm.
Asset boxed() {
  const TriangleMesh mesh = box({.002, .004, .006});
  Asset asset;
  asset.document["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", asset.points(mesh.vertices)}}}}}}}};
  asset.document["meshes"][0]["primitives"][0]["indices"] = asset.indices(corners_of(mesh));
  return asset;
}

std::string refusal(const std::string& bytes) {
  try {
    parse_mesh(bytes);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "taken";
}

Asset changed(Asset asset, const char* pointer, json value) {
  asset.document[json::json_pointer(pointer)] = std::move(value);
  return asset;
}
std::string refusal(const char* pointer, json value) {
  return refusal(changed(boxed(), pointer, std::move(value)).glb());
}

TEST(GltfFile, IsInMetresOfEitherContainer) {
  const Asset asset = boxed();
  for (const std::string& file : {asset.glb(), asset.text(), "\n " + asset.text()}) {
    EXPECT_EQ(mesh_format(file), MeshFormat::gltf);
    const TriangleMesh mesh = parse_mesh(file).mesh;
    EXPECT_NEAR(volume(mesh), 48, 1e-4);
    EXPECT_EQ(mesh.vertices.size(), 8u);
  }
}

TEST(GltfFile, HasIndicesOfAnyTypeOrNone) {
  const TriangleMesh mesh = box({.002, .004, .006});
  const auto corners = corners_of(mesh);
  Asset small = boxed(), large = boxed(), none = boxed();
  json& primitive = small.document["meshes"][0]["primitives"][0];
  primitive["indices"] = small.indices(std::vector<std::uint8_t>(corners.begin(), corners.end()));
  large.document["meshes"][0]["primitives"][0]["indices"] =
      large.indices(std::vector<std::uint32_t>(corners.begin(), corners.end()));
  std::vector<Vec3> soup;
  for (const auto c : corners) soup.push_back(mesh.vertices[c]);
  json& bare = none.document["meshes"][0]["primitives"][0];
  bare.erase("indices");
  bare["attributes"]["POSITION"] = none.points(soup);
  for (const Asset& asset : {small, large, none})
    EXPECT_NEAR(volume(parse_mesh(asset.glb()).mesh), 48, 1e-4);
}

TEST(GltfFile, OfStripsAndFansIsTriangles) {
  // A tetrahedron: a strip of all four sides, and a fan of three with a triangle.
  const std::vector<Vec3> points{{0, 0, 0}, {0, .001, 0}, {.001, 0, 0}, {0, 0, .001}};
  Asset strip;
  strip.document["meshes"] = {
      {{"primitives",
        {{{"mode", 5},
          {"attributes", {{"POSITION", strip.points(points)}}},
          {"indices", strip.indices(std::vector<std::uint16_t>{0, 1, 2, 3, 0, 1})}}}}}};
  EXPECT_NEAR(volume(parse_mesh(strip.glb()).mesh), 1. / 6, 1e-6);
  Asset fan;
  const int position = fan.points(points);
  fan.document["meshes"] = {
      {{"primitives",
        {{{"mode", 6},
          {"attributes", {{"POSITION", position}}},
          {"indices", fan.indices(std::vector<std::uint16_t>{0, 1, 2, 3, 1})}},
         {{"attributes", {{"POSITION", position}}},
          {"indices", fan.indices(std::vector<std::uint16_t>{1, 3, 2})}},
         {{"mode", 1}, {"attributes", {{"POSITION", position}}}}}}}};
  EXPECT_NEAR(volume(parse_mesh(fan.glb()).mesh), 1. / 6, 1e-6);
}

TEST(GltfFile, IsPlacedByItsNodes) {
  Asset asset = boxed();
  const double half = std::sqrt(.5);
  asset.document["nodes"] =
      json::array({{{"translation", {0, 0, 1}}, {"children", {1, 2}}},
                   {{"mesh", 0}, {"rotation", {0, half, 0, half}}, {"scale", {1, 2, 1}}},
                   {{"mesh", 0}, {"matrix", {-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, .5, 0, 0, 1}}}});
  TriangleMesh mesh = parse_mesh(asset.glb()).mesh;
  // The second one is mirrored, and still looks outward.
  EXPECT_NEAR(volume(mesh), 48 * 2 + 48, 1e-3);
  Vec3 low{1e9, 1e9, 1e9}, high{-1e9, -1e9, -1e9};
  for (const Vec3& v : mesh.vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  EXPECT_NEAR(low.x, -3, 1e-4);  // turned about y, z lies along x
  EXPECT_NEAR(high.x, 501, 1e-4);
  EXPECT_NEAR(low.y, -4, 1e-4);
  EXPECT_NEAR(high.y, 4, 1e-4);
  EXPECT_NEAR(low.z, 997, 1e-4);
  EXPECT_NEAR(high.z, 1003, 1e-4);
  // A rotation by a quarter about y carries +z to +x.
  Asset turned = boxed();
  turned.document["nodes"][0]["rotation"] = {0, half, 0, half};
  turned.document["nodes"][0]["translation"] = {1, 2, 3};
  const TriangleMesh one = parse_mesh(turned.glb()).mesh;
  EXPECT_NEAR(one.vertices[0].x, 1000 - 3, 1e-3);
  EXPECT_NEAR(one.vertices[0].z, 3000 + 1, 1e-3);
}

TEST(GltfFile, IsTheDefaultSceneAlone) {
  Asset asset = boxed();
  asset.document["nodes"].push_back({{"mesh", 0}, {"scale", {2, 2, 2}}});
  asset.document["scenes"].push_back({{"nodes", {1}}});
  EXPECT_NEAR(volume(parse_mesh(asset.glb()).mesh), 48, 1e-4);
  asset.document["scene"] = 1;
  EXPECT_NEAR(volume(parse_mesh(asset.glb()).mesh), 8 * 48, 1e-3);
  asset.document.erase("scene");
  EXPECT_NEAR(volume(parse_mesh(asset.glb()).mesh), 48, 1e-4);
}

TEST(GltfFile, OfSparseAccessorsHasTheElementsThatReplace) {
  const TriangleMesh mesh = box({.002, .004, .006});
  Asset asset = boxed();
  // The first corner, x = y = z = -, moves out along x by 2 mm: by a pyramid of volume.
  const int index = asset.view(std::vector<std::uint8_t>{0}),
            value = asset.view(std::vector<float>{-.003f, -.002f, -.003f});
  json sparse{{"count", 1},
              {"indices", {{"bufferView", index}, {"componentType", 5121}}},
              {"values", {{"bufferView", value}}}};
  asset.document["accessors"][0]["sparse"] = sparse;
  const TriangleMesh moved = parse_mesh(asset.glb()).mesh;
  EXPECT_NEAR(moved.vertices[0].x, -3, 1e-6);
  EXPECT_GT(volume(moved), 48.1);
  // Upon zeros.
  Asset bare = boxed();
  std::vector<std::uint8_t> all;
  std::vector<float> points;
  for (std::uint8_t v = 0; v < 8; ++v) {
    all.push_back(v);
    for (const double x : {mesh.vertices[v].x, mesh.vertices[v].y, mesh.vertices[v].z})
      points.push_back(static_cast<float>(x));
  }
  json& accessor = bare.document["accessors"][0];
  const int indices = bare.view(all), values = bare.view(points);
  accessor["sparse"] = {{"count", 8},
                        {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                        {"values", {{"bufferView", values}}}};
  accessor.erase("bufferView");
  EXPECT_NEAR(volume(parse_mesh(bare.glb()).mesh), 48, 1e-4);
  accessor["count"] = 4'000'000'000u;
  EXPECT_THAT(refusal(bare.glb()), HasSubstr("/accessors/0/count: announces more elements"));
}

TEST(GltfFile, OfQuantizedPointsIsThem) {
  const TriangleMesh mesh = box({2, 4, 6});
  Asset asset = boxed();
  std::vector<std::int16_t> points;
  for (const Vec3& v : mesh.vertices)
    for (const double x : {v.x, v.y, v.z, 0.}) points.push_back(static_cast<std::int16_t>(x));
  const int view = asset.view(points);
  asset.document["bufferViews"][view]["byteStride"] = 8;
  asset.document["accessors"][0] = {
      {"bufferView", view}, {"componentType", 5122}, {"count", 8}, {"type", "VEC3"}};
  asset.document["nodes"][0]["scale"] = {.001, .001, .001};
  asset.document["extensionsRequired"] = {"KHR_mesh_quantization"};
  EXPECT_NEAR(volume(parse_mesh(asset.glb()).mesh), 48, 1e-9);
  asset.document["accessors"][0]["normalized"] = true;
  asset.document["nodes"][0]["scale"] = {32.767, 32.767, 32.767};
  EXPECT_NEAR(volume(parse_mesh(asset.glb()).mesh), 48, 1e-9);
}

TEST(GltfFile, IsRefusedWithThePointerAndWhy) {
  EXPECT_EQ(refusal("/asset/version", "1.0"), "/asset/version: must be 2.0");
  EXPECT_EQ(refusal("/scene", 1), "/scene: names 1 of the scenes: there are 1");
  EXPECT_EQ(refusal("/scene", -1), "/scene: must be an integer in [0, 9007199254740991]");
  EXPECT_EQ(refusal("/scene", .5), "/scene: must be an integer in [0, 9007199254740991]");
  EXPECT_EQ(refusal("/scenes/0/nodes", {0, 0}),
            "/scenes/0/nodes/1: names a node for the second time: nodes are a tree");
  EXPECT_EQ(refusal("/nodes/0/children", {0}),
            "/nodes/0/children/0: names a node for the second time: nodes are a tree");
  EXPECT_EQ(refusal("/nodes/0/mesh", 7), "/nodes/0/mesh: names 7 of the meshes: there are 1");
  EXPECT_EQ(refusal("/nodes/0/rotation", {0, 0, 0, 2}),
            "/nodes/0/rotation: must be a unit quaternion");
  EXPECT_EQ(refusal("/nodes/0/scale", {1, 1}), "/nodes/0/scale: must be 3 numbers");
  EXPECT_EQ(refusal("/nodes/0/scale", {1, "1", 1}), "/nodes/0/scale/1: must be a number");
  EXPECT_EQ(refusal("/nodes/0/matrix", {1, 0, 0, 1, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}),
            "/nodes/0/matrix: must have the last row 0 0 0 1");
  EXPECT_THAT(refusal("/nodes/0/skin", 0), StartsWith("/nodes/0/skin: meshes that a skeleton"));
  EXPECT_THAT(refusal("/meshes/0/weights", {0, .5}), StartsWith("/meshes/0/weights: morph"));
  EXPECT_EQ(refusal("/meshes/0/weights", {0, 0}), "taken");
  EXPECT_EQ(refusal("/meshes/0/primitives/0/mode", 7),
            "/meshes/0/primitives/0/mode: must be an integer in [0, 6]");
  EXPECT_EQ(refusal("/meshes/0/primitives/0/attributes", json::object()),
            "/meshes/0/primitives/0/attributes: has no POSITION");
  EXPECT_THAT(
      refusal("/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression", json::object()),
      HasSubstr("without Draco"));
  EXPECT_THAT(refusal("/bufferViews/0/extensions/EXT_meshopt_compression", json::object()),
              HasSubstr("without meshopt"));
  EXPECT_EQ(refusal("/extensionsRequired", {"KHR_draco_mesh_compression"}),
            "/extensionsRequired/0: requires KHR_draco_mesh_compression, which is not read");
  EXPECT_EQ(refusal("/extensionsRequired", {"KHR_materials_volume"}), "taken");
  EXPECT_EQ(refusal("/accessors/0/type", "VEC4"), "/accessors/0/type: must be VEC3");
  EXPECT_EQ(refusal("/accessors/0/componentType", 5125),
            "/accessors/0/componentType: must be one of 5126, 5120, 5121, 5122, 5123");
  EXPECT_EQ(refusal("/accessors/0/count", 9),
            "/bufferViews/0: has 96 bytes: its accessor needs 108");
  EXPECT_EQ(refusal("/accessors/0/byteOffset", 2),
            "/bufferViews/0: begins, with its accessor, at no multiple of 4 bytes");
  EXPECT_THAT(refusal("/accessors/0/byteOffset", 9007199254740988),
              StartsWith("/bufferViews/0: has 96 bytes"));
  EXPECT_EQ(refusal("/accessors/1/count", 35),
            "/meshes/0/primitives/0: has 35 corners of triangles: no multiple of 3");
  EXPECT_EQ(refusal("/bufferViews/0/byteStride", 10),
            "/bufferViews/0/byteStride: must be a multiple of 4 in [4, 252], and at least 12");
  EXPECT_EQ(refusal("/bufferViews/1/byteStride", 4),
            "/bufferViews/1/byteStride: is for vertices only");
  EXPECT_EQ(refusal("/bufferViews/0/byteLength", 999999),
            "/bufferViews/0: reaches to byte 999999 of a buffer of 168");
  EXPECT_EQ(refusal("/bufferViews/0/buffer", 1),
            "/bufferViews/0/buffer: names 1 of the buffers: there are 1");
  EXPECT_EQ(refusal("/meshes", json::array()), "/nodes/0/mesh: names 0 of the meshes: there are 0");
  EXPECT_EQ(refusal("/scenes/0/nodes", json::array()), "the default scene has no triangle");
  EXPECT_EQ(refusal("/scenes", json::array()), "/scene: names 0 of the scenes: there are 0");
  Asset beyond = boxed();
  beyond.document["meshes"][0]["primitives"][0]["indices"] =
      beyond.indices(std::vector<std::uint16_t>{0, 1, 8});
  EXPECT_EQ(refusal(beyond.glb()),
            "/meshes/0/primitives/0/indices: element 2 is vertex 8: there are 8");
  Asset infinite = boxed();
  std::memset(infinite.bytes.data() + 12, 0xff, 4);
  EXPECT_EQ(refusal(infinite.glb()), "/accessors/0: element 1 has a coordinate that is not finite");
}

TEST(GltfFile, OpensNoOtherFile) {
  Asset asset = boxed();
  for (const char* uri : {"box.bin", "/etc/passwd", "file:///etc/passwd", "http://localhost/x"}) {
    json whole = asset.document;
    whole["buffers"] = {{{"byteLength", 168}, {"uri", uri}}};
    EXPECT_THAT(refusal(whole.dump()), StartsWith("/buffers/0/uri: names another file"));
    // Pictures are not looked at.
    asset.document["images"] = {{{"uri", uri}}};
    EXPECT_EQ(refusal(asset.glb()), "taken");
  }
  json whole = asset.document;
  whole["buffers"] = {{{"byteLength", 168}}};
  EXPECT_THAT(refusal(whole.dump()), StartsWith("/buffers/0: has no uri"));
  for (const char* uri : {"data:,x", "data:;base64,====", "data:;base64,A", "data:;base64,AA*A"}) {
    whole["buffers"] = {{{"byteLength", 1}, {"uri", uri}}};
    EXPECT_THAT(refusal(whole.dump()), StartsWith("/buffers/0/uri: is no data: URI")) << uri;
  }
  whole["buffers"] = {{{"byteLength", 9}, {"uri", "data:;base64,AAAA"}}};
  EXPECT_EQ(refusal(whole.dump()), "/buffers/0/byteLength: announces 9 bytes: there are 3");
  EXPECT_EQ(gltf::bytes_of_data_uri("data:;base64,TWFu"), "Man");
  EXPECT_EQ(gltf::bytes_of_data_uri("data:a/b;base64,TWE="), "Ma");
  EXPECT_EQ(gltf::bytes_of_data_uri("data:a/b;base64,TQ=="), "M");
  EXPECT_EQ(gltf::bytes_of_data_uri("data:a/b;base64,TQ"), "M");
}

TEST(GltfFile, OfLyingLengthsIsRefusedAtOnce) {
  const std::string whole = boxed().glb();
  for (std::size_t length = 4; length < whole.size(); ++length)
    EXPECT_NE(refusal(whole.substr(0, length)), "taken") << length;
  const auto with = [&](std::size_t at, std::uint32_t number) {
    std::string bytes;
    put(bytes, number);
    std::string file = whole;
    return file.replace(at, 4, bytes);
  };
  EXPECT_EQ(refusal(with(4, 1)), "the GLB is of version 1; read is version 2");
  EXPECT_THAT(refusal(with(8, 0xffffffff)), HasSubstr("announces 4294967295 bytes"));
  EXPECT_THAT(refusal(with(12, 0xfffffffc)),
              HasSubstr("the chunk at byte 12 announces 4294967292 bytes"));
  EXPECT_EQ(refusal(with(16, 7)), "the first chunk of the GLB is no JSON");
  EXPECT_THAT(refusal("/accessors/0/count", 4294967295u),
              HasSubstr("its accessor needs 51539607540"));
  EXPECT_THAT(refusal("/accessors/0/count", 4294967296u), HasSubstr("/accessors/0/count: must be"));
}

TEST(GltfFile, WhoseJsonIsDamagedIsRefusedWithTheByte) {
  EXPECT_EQ(refusal("{\"asset\":,}"), "the JSON is damaged at its byte 10");
  EXPECT_EQ(refusal("{\"a\":1e999}"), "the JSON is damaged");
  EXPECT_EQ(refusal("{}"), "the document: has no asset");
  EXPECT_EQ(refusal(Asset::glb("[]", "")), "the document: must be an object");
  std::string deep = "{\"extras\":";
  for (int i = 0; i < 100'000; ++i) deep += '[';
  EXPECT_EQ(refusal(deep), "the JSON is nested too deeply");
}

TEST(GltfFile, OfALongChainOfNodesIsRead) {
  Asset asset = boxed();
  json nodes = json::array();
  constexpr int count = 20'000;
  for (int i = 0; i + 1 < count; ++i) nodes.push_back({{"children", {i + 1}}});
  nodes.push_back({{"mesh", 0}});
  asset.document["nodes"] = nodes;
  EXPECT_NEAR(volume(parse_mesh(asset.glb()).mesh), 48, 1e-4);
}

}  // namespace
}  // namespace translucube::test

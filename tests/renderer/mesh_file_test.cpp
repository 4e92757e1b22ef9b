// Mesh files mean what their user means: volumes in closed form, refusals that say where.

#include "renderer/shape/file/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <sstream>
#include <string>

#include "picture/sandbox/answer.h"
#include "renderer/shape/file/mesh_format.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// A box as OBJ text: quads from vertex `first` on, turned inside out if `flipped`.
std::string obj_box(Vec3 low, Vec3 high, int first = 1, bool flipped = false) {
  std::ostringstream text;
  text.precision(17);
  for (int i = 0; i < 8; ++i)
    text << "v " << (i & 1 ? high : low).x << ' ' << (i & 2 ? high : low).y << ' '
         << (i & 4 ? high : low).z << '\n';
  constexpr int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                               {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    text << "f";
    for (int i = 0; i < 4; ++i) text << ' ' << first + q[flipped ? 3 - i : i];
    text << '\n';
  }
  return text.str();
}

TriangleMesh obj(const std::string& text) { return parse_mesh(MeshFormat::obj, text).mesh; }
TriangleMesh ply(const std::string& text) { return parse_mesh(MeshFormat::ply, text).mesh; }

std::string refusal(MeshFormat format, const std::string& text) {
  try {
    parse_mesh(format, text);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "taken";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, text.npos) << what;
  return text.replace(at, what.size(), by);
}

const std::string unit_box = obj_box({0, 0, 0}, {1, 1, 1});

TEST(ObjFile, MayBeWrittenAsProgramsWriteIt) {
  const std::string written[] = {
      unit_box,
      "\xEF\xBB\xBF" + unit_box,
      "# a comment \\\n" + unit_box,
      replaced(unit_box, "f 1 5 7 3", "f 1 5 7 3 # behind a face"),
      replaced(unit_box, "f 1 5 7 3", "  f\t1/1 5/2/3 7//4 3/ "),
      replaced(unit_box, "f 1 5 7 3", "f 1 5 \\\n 7 3"),
      replaced(unit_box, "f 1 5 7 3", "f -8 -4 -2 -6"),
      replaced(unit_box, "v 0 0 0", "v +0.0e0 0 -0 1"),
      replaced(unit_box, "v 0 0 0", "v 0 0 0 0.5 0.25 1"),
      replaced(unit_box, "v 0 0 0", "v 0 0 1e-400"),
      "mtllib /etc/passwd\no a\ng b\ns off\nusemtl c\nvt 0 0\nvn 0 0 1\nl 1 2\n" + unit_box};
  for (std::string text : written) {
    EXPECT_NEAR(volume(obj(text)), 1, 1e-12) << text;
    std::string windows;
    for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
    EXPECT_NEAR(volume(obj(windows)), 1, 1e-12) << text;
    std::ranges::replace(text, '\n', '\r');
    EXPECT_NEAR(volume(obj(text)), 1, 1e-12) << text;
  }
}

/// The normals that a file gives to the corners of its triangles, each triangle's and corner's.
std::vector<Vec3> given_normals(const TriangleMesh& mesh) {
  std::vector<Vec3> all;
  for (const Triangle& t : mesh.corner_normals)
    for (const std::uint32_t n : t) all.push_back(n == no_normal ? Vec3{} : mesh.normals[n]);
  return all;
}

const std::string tetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";

TEST(ObjFile, GivesCornersTheNormalsThatTheyName) {
  const TriangleMesh none =
      obj(tetrahedron + "vn 0 0 1\nf 1/2 3/1 2/1\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  EXPECT_TRUE(none.corner_normals.empty());
  const TriangleMesh some = obj("vn 0 0 -2\nvn +3 0 0 \n" + tetrahedron +
                                "f 1//1 3/7/1 2//-2\nf 1//2 2//2 4//3\nf 1//4 4 3\nf 2 3 4\nvn 0 "
                                "4 0\nvn -nan(ind) 0 0\n");
  EXPECT_THAT(given_normals(some),
              testing::ElementsAre(Vec3{0, 0, -1}, Vec3{0, 0, -1}, Vec3{0, 0, -1}, Vec3{1, 0, 0},
                                   Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{}, Vec3{}, Vec3{}, Vec3{},
                                   Vec3{}, Vec3{}));
}

TEST(ObjFile, OfPolygonsAndPartsInsideOutKeepsNormalsAtTheirCorners) {
  // Each corner of a box has the direction from its centre: after cutting and turning, too.
  std::string text = obj_box({-1, -1, -1}, {1, 1, 1}, 1, true);
  for (int i = 0; i < 8; ++i)
    text += "vn " + std::to_string(i & 1 ? 1 : -1) + ' ' + std::to_string(i & 2 ? 1 : -1) + ' ' +
            std::to_string(i & 4 ? 1 : -1) + '\n';
  std::string with;
  for (std::istringstream lines(text); std::getline(lines, text);) {
    if (!text.starts_with("f")) {
      with += text + '\n';
      continue;
    }
    std::istringstream words(text.substr(1));
    with += 'f';
    for (std::string word; words >> word;) with += ' ' + word + "//" + word;
    with += '\n';
  }
  const TriangleMesh mesh = obj(with);
  ASSERT_EQ(mesh.corner_normals.size(), 12u);
  for (std::size_t t = 0; t < 12; ++t)
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_NEAR(length(mesh.normals[mesh.corner_normals[t][i]] -
                         normalize(mesh.vertices[mesh.triangles[t][i]])),
                  0, 1e-12);
}

TEST(ObjFile, IsRefusedForNormalsThatAreNone) {
  const auto refused = [](const std::string& text) {
    return refusal(MeshFormat::obj, tetrahedron + text + "f 1 2 4\nf 1 4 3\nf 2 3 4\n");
  };
  EXPECT_EQ(refused("vn 0 0\nf 1 3 2\n"), "line 5: a normal needs three coordinates");
  EXPECT_EQ(refused("vn 0 0 1 1\nf 1 3 2\n"), "line 5: a normal has three coordinates");
  EXPECT_EQ(refused("vn 0 0 up\nf 1 3 2\n"), "line 5: \"up\" is no number");
  EXPECT_EQ(refused("vn 0 0 1\nf 1//1 3//2 2//1\n"),
            "line 6: normal 2 does not exist: there are 1");
  EXPECT_EQ(refused("vn 0 0 1\nf 1//1 3//-2 2//1\n"), "line 6: normal -2 does not exist");
  EXPECT_EQ(refused("vn 0 0 1\nf 1//1 3//0 2//1\n"), "line 6: \"3//0\" names no corner of a face");
}

TEST(PlyFile, GivesVerticesTheirNormals) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float nz\n"
      "property float y\nproperty float z\nproperty float nx\n";
  const std::string faces =
      "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
      "0 -1 0 0 0 0\n1 -1 0 0 0 0\n0 0 1 0 0 2\n0 0 0 1 0 0\n"
      "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";
  const TriangleMesh mesh = ply(head + "property float ny\n" + faces);
  EXPECT_EQ(mesh.normals, (std::vector<Vec3>{{0, 0, -1}, {0, 0, -1}, {0, 1, 0}, {0, 0, 0}}));
  EXPECT_EQ(mesh.corner_normals, mesh.triangles);
  // Two of three say nothing; two of one kind are too many.
  EXPECT_TRUE(ply(head + "property float na\n" + faces).corner_normals.empty());
  EXPECT_EQ(refusal(MeshFormat::ply, head + "property float nx\n" + faces),
            "nx, ny and nz are one number each");
}

TEST(ObjFile, IsRefusedWithTheLineAndWhy) {
  const auto refused = [](const std::string& what, const std::string& by) {
    return refusal(MeshFormat::obj, replaced(unit_box, what, by));
  };
  EXPECT_EQ(refused("v 0 0 0", "v 0 0"), "line 1: a vertex needs three coordinates");
  EXPECT_EQ(refused("v 0 0 0", "v 0 0 nan"), "line 1: \"nan\" is no finite number");
  EXPECT_EQ(refused("v 0 0 0", "v 0 0 1e999"), "line 1: \"1e999\" is no finite number");
  EXPECT_EQ(refused("v 0 0 0", "v 0 0 0,5"), "line 1: \"0,5\" is no finite number");
  EXPECT_EQ(refused("v 0 0 0", "v 0 0 0 2"),
            "line 1: a weight of a vertex other than 1 is not read");
  EXPECT_EQ(refused("f 1 5 7 3", "f 1 5"), "line 9: a face needs three corners");
  EXPECT_EQ(refused("f 1 5 7 3", "f 1 5 7 9"), "line 9: vertex 9 does not exist: there are 8");
  EXPECT_EQ(refused("f 1 5 7 3", "f 1 5 7 -9"), "line 9: vertex -9 does not exist");
  EXPECT_EQ(refused("f 1 5 7 3", "f 1 5 7 0"), "line 9: \"0\" names no corner of a face");
  EXPECT_EQ(refused("f 1 5 7 3", "f 1 5 7 x"), "line 9: \"x\" names no corner of a face");
  EXPECT_EQ(refused("f 1 5 7 3", "f 1 5 7 99999999999"),
            "line 9: vertex 99999999999 does not exist");
  EXPECT_EQ(refused("f 1 5 7 3", "curv 0 1 2"),
            "line 9: free-form curves and surfaces (curv) are not read");
  EXPECT_EQ(refused("f 1 5 7 3", "face 1 5 7"), "line 9: \"face\" is no keyword of OBJ");
  EXPECT_EQ(refusal(MeshFormat::obj, "# nothing\n"), "the mesh has no face");
  EXPECT_EQ(refusal(MeshFormat::obj, ""), "the mesh has no face");
  EXPECT_THAT(refused("f 1 5 7 3\n", ""),
              AllOf(HasSubstr("not closed"), HasSubstr("4 of its"), HasSubstr("as that from")));
}

/// A prism of height 1 over a polygon, whose caps are one face each.
std::string prism(const std::vector<std::array<double, 2>>& outline) {
  std::ostringstream text;
  const std::size_t n = outline.size();
  for (const int z : {0, 1})
    for (const auto& [x, y] : outline) text << "v " << x << ' ' << y << ' ' << z << '\n';
  text << "f";
  for (std::size_t i = n; i > 0; --i) text << ' ' << i;
  text << "\nf";
  for (std::size_t i = 1; i <= n; ++i) text << ' ' << n + i;
  text << '\n';
  for (std::size_t i = 1; i <= n; ++i) {
    const std::size_t j = i % n + 1;
    text << "f " << i << ' ' << j << ' ' << n + j << ' ' << n + i << '\n';
  }
  return text.str();
}

double shoelace(const std::vector<std::array<double, 2>>& outline) {
  double twice = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto &a = outline[i], &b = outline[(i + 1) % outline.size()];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return twice / 2;
}

using Outline = std::vector<std::array<double, 2>>;
const std::pair<const char*, Outline> outlines[] = {
    {"an L", {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}},
    {"an L from its inner corner", {{1, 1}, {1, 2}, {0, 2}, {0, 0}, {2, 0}, {2, 1}}},
    {"a concave quad", {{0, 0}, {2, 1}, {0, 2}, {0.5, 1}}},
    {"a U", {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}},
    {"a corner within an edge", {{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}},
    {"a star",
     {{0, 3},
      {-.7, 1},
      {-2.9, .9},
      {-1.1, -.4},
      {-1.8, -2.4},
      {0, -1.2},
      {1.8, -2.4},
      {1.1, -.4},
      {2.9, .9},
      {.7, 1}}}};

TEST(Polygons, KeepTheirOutline) {
  for (const auto& [name, outline] : outlines) {
    const TriangleMesh mesh = obj(prism(outline));
    EXPECT_NEAR(volume(mesh), shoelace(outline), 1e-12) << name;
    // The caps cover the outline once, where a fan would cover more.
    double caps = 0;
    for (const Triangle& t : mesh.triangles) {
      const Vec3 a = mesh.vertices[t[0]], b = mesh.vertices[t[1]], c = mesh.vertices[t[2]];
      if (a.z == b.z && b.z == c.z) caps += 0.5 * length(cross(b - a, c - a));
    }
    EXPECT_NEAR(caps, 2 * shoelace(outline), 1e-12) << name;
  }
}

TEST(Polygons, OfManyCornersAreTriangles) {
  Outline comb;
  for (int i = 0; i < 100; ++i) {
    comb.push_back({2.0 * i, 0.0});
    comb.push_back({2.0 * i + 1, 5.0});
  }
  comb.push_back({200.0, 10.0});
  comb.push_back({0.0, 10.0});
  EXPECT_NEAR(volume(obj(prism(comb))), shoelace(comb), 1e-9);
}

TEST(Polygons, ThatCrossThemselvesAreRefused) {
  EXPECT_EQ(refusal(MeshFormat::obj, prism({{0, 0}, {2, 2}, {2, 0}, {0, 1}})),
            "line 9: the outline of the face crosses itself");
  Outline pentagram;
  for (int i = 0; i < 5; ++i)
    pentagram.push_back(
        {std::cos(i * 4 * std::numbers::pi / 5), std::sin(i * 4 * std::numbers::pi / 5)});
  EXPECT_THAT(refusal(MeshFormat::obj, prism(pentagram)), HasSubstr("crosses itself"));
}

TEST(Parts, AreOneBodyByTheirWindingNumber) {
  const auto big = [](bool flipped) { return obj_box({0, 0, 0}, {4, 4, 4}, 1, flipped); };
  const auto small = [](bool flipped) { return obj_box({1, 1, 1}, {2, 2, 2}, 9, flipped); };
  const auto beside = [](bool flipped) { return obj_box({5, 0, 0}, {6, 1, 1}, 9, flipped); };
  const auto least = [](bool flipped) {
    return obj_box({1.25, 1.25, 1.25}, {1.75, 1.75, 1.75}, 17, flipped);
  };
  const struct {
    const char* name;
    std::string text;
    double volume;
    std::size_t triangles;
  } cases[] = {{"inside out", big(true), 64, 12},
               {"beside each other", big(false) + beside(false), 65, 24},
               {"one of them inside out", big(false) + beside(true), 65, 24},
               {"both inside out", big(true) + beside(true), 65, 24},
               {"one in the other", big(false) + small(false), 64, 12},
               {"both so, inside out", big(true) + small(true), 64, 12},
               {"a cavity", big(false) + small(true), 63, 24},
               {"a cavity, all inside out", big(true) + small(false), 63, 24},
               {"a body in a cavity", big(false) + small(true) + least(false), 63.125, 36},
               {"a body in a body in a body", big(false) + small(false) + least(false), 64, 12},
               {"a cavity in what is in it", big(false) + small(false) + least(true), 64, 12}};
  for (const auto& c : cases) {
    const TriangleMesh mesh = obj(c.text);
    EXPECT_NEAR(volume(mesh), c.volume, 1e-12) << c.name;
    EXPECT_EQ(mesh.triangles.size(), c.triangles) << c.name;
  }
}

TEST(Parts, ThatMeetAreRefusedByName) {
  const std::string first = obj_box({0, 0, 0}, {2, 2, 2});
  const std::pair<const char*, std::string> cases[] = {
      {"overlapping", obj_box({1, 1, 1}, {3, 3, 3}, 9)},
      {"a bar through", obj_box({-1, .5, .5}, {3, 1.5, 1.5}, 9)},
      {"touching faces", obj_box({2, 0.5, 0.5}, {3, 1.5, 1.5}, 9)},
      {"touching from within", obj_box({0, 0.5, 0.5}, {1, 1.5, 1.5}, 9, true)},
      {"a common corner", obj_box({2, 2, 2}, {3, 3, 3}, 9)}};
  for (const auto& [name, second] : cases)
    EXPECT_THAT(refusal(MeshFormat::obj, first + second),
                AllOf(HasSubstr("parts 1 (with the vertex 0 0 0) and 2"), HasSubstr("meet")))
        << name;
  // Balls of many faces, which cross in a ring and nowhere else.
  std::ostringstream text;
  std::uint32_t base = 1;
  for (const double x : {0.0, 1.5}) {
    const TriangleMesh ball = icosphere(3);
    for (const Vec3& v : ball.vertices) text << "v " << v.x + x << ' ' << v.y << ' ' << v.z << '\n';
    for (const Triangle& t : ball.triangles)
      text << "f " << base + t[0] << ' ' << base + t[1] << ' ' << base + t[2] << '\n';
    base += static_cast<std::uint32_t>(ball.vertices.size());
  }
  EXPECT_THAT(refusal(MeshFormat::obj, text.str()), HasSubstr("meet"));
}

TEST(MeshPrecision, IsThatOfTheFile) {
  // UTM metres: double precision keeps a box of .2 there, single precision does not.
  const Vec3 far{4649776.22, 551234.5, 112.3};
  const std::string text = obj_box(far, far + Vec3{.2, .2, .2});
  EXPECT_NEAR(volume(obj(text)), .008, 1e-10);
  EXPECT_THAT(refusal(MeshFormat::obj, obj_box({1e15, 0, 0}, {1e15 + 1, 1, 1})),
              HasSubstr("too coarse"));
}

// ---- PLY

enum class Order { ascii, little, big };

class PlyText {
 public:
  explicit PlyText(Order order) : order_(order) {
    text_ = "ply\nformat ";
    text_ += order == Order::ascii    ? "ascii"
             : order == Order::little ? "binary_little_endian"
                                      : "binary_big_endian";
    text_ += " 1.0\ncomment by a test\n";
  }
  PlyText& line(const std::string& line) {
    text_ += line + "\n";
    return *this;
  }
  template <class T>
  PlyText& put(T value) {
    if (order_ == Order::ascii) {
      std::ostringstream word;
      word.precision(17);
      word << +value;
      text_ += word.str() + " ";
      return *this;
    }
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    if ((order_ == Order::little) != (std::endian::native == std::endian::little))
      std::ranges::reverse(bytes);
    text_.append(bytes.data(), bytes.size());
    return *this;
  }
  std::string text() const { return text_; }

 private:
  Order order_;
  std::string text_;
};

template <class Coordinate>
std::string ply_box(Order order, Vec3 low, Vec3 high) {
  PlyText ply(order);
  const std::string type = std::is_same_v<Coordinate, double> ? "double" : "float";
  ply.line("obj_info nothing").line("element vertex 8");
  for (const char* axis : {"x", "y", "z"}) ply.line("property " + type + " " + axis);
  ply.line("property uchar red").line("element camera 1").line("property list uchar short name");
  ply.line("element face 6").line("property list uchar uint vertex_indices");
  ply.line("property int8 flags").line("end_header");
  for (int i = 0; i < 8; ++i)
    ply.put(Coordinate((i & 1 ? high : low).x))
        .put(Coordinate((i & 2 ? high : low).y))
        .put(Coordinate((i & 4 ? high : low).z))
        .put(std::uint8_t(255));
  ply.put(std::uint8_t(2)).put(std::int16_t(-1)).put(std::int16_t(300));
  constexpr std::uint32_t quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    ply.put(std::uint8_t(4));
    for (const std::uint32_t v : q) ply.put(v);
    ply.put(std::int8_t(-3));
  }
  return ply.text();
}

TEST(PlyFile, IsReadInEveryEncoding) {
  for (const Order order : {Order::ascii, Order::little, Order::big}) {
    EXPECT_NEAR(volume(ply(ply_box<float>(order, {0, 0, 0}, {1, 2, 3}))), 6, 1e-12);
    EXPECT_NEAR(volume(ply(ply_box<double>(order, {0, 0, 0}, {1, 2, 3}))), 6, 1e-12);
  }
}

TEST(PlyFile, OfCoordinatesTooFarForItsTypeIsRefused) {
  const Vec3 far{4649776.22, 551234.5, 112.3};
  for (const Order order : {Order::ascii, Order::little}) {
    EXPECT_NEAR(volume(ply(ply_box<double>(order, far, far + Vec3{.2, .2, .2}))), .008, 1e-10);
    EXPECT_THAT(refusal(MeshFormat::ply, ply_box<float>(order, far, far + Vec3{.2, .2, .2})),
                HasSubstr("too coarse"));
  }
}

TEST(PlyFile, IsRefusedWhereverItIsCutOff) {
  for (const Order order : {Order::ascii, Order::little, Order::big}) {
    const std::string whole = ply_box<float>(order, {0, 0, 0}, {1, 1, 1});
    for (std::size_t length = 0; length + 2 < whole.size(); ++length)
      EXPECT_NE(refusal(MeshFormat::ply, whole.substr(0, length)), "taken") << length;
  }
}

TEST(PlyFile, IsRefusedWithThePlaceAndWhy) {
  const std::string good = ply_box<float>(Order::ascii, {0, 0, 0}, {1, 1, 1});
  const auto refused = [&](const std::string& what, const std::string& by) {
    return refusal(MeshFormat::ply, replaced(good, what, by));
  };
  EXPECT_EQ(refused("ply\n", "plx\n"), "the file does not begin with the line \"ply\"");
  EXPECT_EQ(refused("end_header\n", ""), "line 15 of the header: is no line of a header");
  EXPECT_EQ(refused("format ascii 1.0", "format ascii 2.0"),
            "line 2 of the header: is not version 1.0");
  EXPECT_EQ(refused("float x", "quad x"), "line 6 of the header: is no type of PLY");
  EXPECT_EQ(refused("list uchar uint", "list float uint"),
            "line 13 of the header: the length of a list is an integer");
  EXPECT_EQ(refused("float x", "float u"), "its vertices have no x, y and z");
  EXPECT_EQ(refused("element vertex 8", "element vertex 4000000000"),
            "the file is too short for 4000000000 of \"vertex\"");
  EXPECT_EQ(refused("4 0 4 6 2 ", "4 0 4 6 8 "),
            "face 1 of 6: a vertex that does not exist: there are 8");
  EXPECT_EQ(refused("4 0 4 6 2 ", "4 0 4 6 -1 "),
            "face 1 of 6: a number that its type does not have");
  EXPECT_EQ(refused("4 0 4 6 2 ", "4 0 4 6 1.5 "),
            "face 1 of 6: a number that its type does not have");
  EXPECT_EQ(refused("4 0 4 6 2 ", "255 0 4 6 2 "),
            "face 1 of 6: a list longer than the rest of the file");
  EXPECT_EQ(refused("4 0 4 6 2 ", "2 0 4 "), "face 1 of 6: a face needs three corners");
  EXPECT_EQ(refused("0 0 0 255 ", "0 0 nan 255 "),
            "vertex 1 of 8: a word that is no finite number");
  EXPECT_EQ(refusal(MeshFormat::ply, good + "more"), "more bytes follow behind the last element");
  EXPECT_EQ(refused("element camera 1\n", "element tristrips 1\n"),
            "triangle strips (tristrips) are not read");
}

// ---- the answer of the process that reads

TEST(MeshAnswer, IsBelievedInNothing) {
  const TriangleMesh mesh = box({1, 1, 1});
  const auto packed = [](std::uint64_t vertices, std::uint64_t triangles, const TriangleMesh& m) {
    std::string text;
    const auto add = [&](auto span) {
      const auto part = std::as_bytes(span);
      text.append(reinterpret_cast<const char*>(part.data()), part.size());
    };
    const std::uint64_t normals = m.normals.size(), corners = m.corner_normals.size();
    const MeshReport report{8, 12, 1, 2, 3};
    add(std::span(&report, 1));
    add(std::span(&vertices, 1));
    add(std::span(m.vertices));
    add(std::span(&triangles, 1));
    add(std::span(m.triangles));
    add(std::span(&normals, 1));
    add(std::span(m.normals));
    add(std::span(&corners, 1));
    add(std::span(m.corner_normals));
    std::vector<std::byte> bytes(text.size());
    std::memcpy(bytes.data(), text.data(), text.size());
    return bytes;
  };
  EXPECT_EQ(unpack_mesh(packed(8, 12, mesh)).mesh.triangles.size(), 12u);
  EXPECT_EQ(unpack_mesh(packed(8, 12, mesh)).report, (MeshReport{8, 12, 1, 2, 3}));
  for (const auto& [v, t] :
       {std::pair(7u, 12u), {8u, 11u}, {9u, 12u}, {8u, 13u}, {0u, 12u}, {8u, 0u}})
    EXPECT_THROW(unpack_mesh(packed(v, t, mesh)), AnswerError) << v << " " << t;
  EXPECT_THROW(unpack_mesh(packed(~0ull, 12, mesh)), AnswerError);
  EXPECT_THROW(unpack_mesh(packed(8, ~0ull / 12, mesh)), AnswerError);
  TriangleMesh bad = mesh;
  bad.triangles[3][1] = 8;
  EXPECT_THROW(unpack_mesh(packed(8, 12, bad)), AnswerError);
  bad = mesh;
  bad.vertices[2].y = std::nan("");
  EXPECT_THROW(unpack_mesh(packed(8, 12, bad)), AnswerError);
  bad = mesh;
  bad.normals = {{0, 0, 1}};
  bad.corner_normals.assign(11, {0, 0, 0});
  EXPECT_THROW(unpack_mesh(packed(8, 12, bad)), AnswerError);
  bad.corner_normals.push_back({0, 0, no_normal});
  EXPECT_EQ(unpack_mesh(packed(8, 12, bad)).mesh.corner_normals, bad.corner_normals);
  bad.corner_normals[7][1] = 1;
  EXPECT_THROW(unpack_mesh(packed(8, 12, bad)), AnswerError);
  bad.corner_normals[7][1] = 0;
  bad.normals[0].z = infinity;
  EXPECT_THROW(unpack_mesh(packed(8, 12, bad)), AnswerError);
  const auto whole = packed(8, 12, mesh);
  for (std::size_t size = 0; size < whole.size(); ++size)
    EXPECT_THROW(unpack_mesh(std::span(whole).first(size)), AnswerError) << size;
}

}  // namespace
}  // namespace translucube::test

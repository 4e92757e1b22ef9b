// STL files, of either kind, mean their corners; what is none says why.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <sstream>
#include <string>

#include "renderer/shape/file/mesh_format.h"
#include "tests/support/meshes.h"

namespace translucube::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

void put(std::string& bytes, std::uint32_t number) {
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(number >> 8 * i & 255);
}
void put(std::string& bytes, float number) { put(bytes, std::bit_cast<std::uint32_t>(number)); }

std::string binary_stl(const TriangleMesh& mesh, const std::string& header = "made by a test",
                       Vec3 move = {}) {
  std::string bytes = header;
  bytes.resize(80);
  put(bytes, static_cast<std::uint32_t>(mesh.triangles.size()));
  for (const Triangle& t : mesh.triangles) {
    for (int i = 0; i < 3; ++i) put(bytes, std::nanf(""));  // of no meaning
    for (const std::uint32_t v : t)
      for (const double x :
           {mesh.vertices[v].x + move.x, mesh.vertices[v].y + move.y, mesh.vertices[v].z + move.z})
        put(bytes, static_cast<float>(x));
    bytes += "\x1f\x7c";  // a colour, to some programs
  }
  return bytes;
}

std::string ascii_stl(const TriangleMesh& mesh, const std::string& name = "a box") {
  std::ostringstream text;
  text << "solid " << name << "\n";
  for (const Triangle& t : mesh.triangles) {
    text << "  facet normal 0 0 nan\n    outer loop\n";
    for (const std::uint32_t v : t)
      text << "      vertex " << mesh.vertices[v].x << ' ' << mesh.vertices[v].y << ' '
           << mesh.vertices[v].z << "\n";
    text << "    endloop\n  endfacet\n";
  }
  text << "endsolid " << name << "\n";
  return text.str();
}

std::string refusal(const std::string& bytes) {
  try {
    parse_mesh(bytes);
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

const TriangleMesh solid_box = box({2, 4, 6});

TEST(StlFile, OfEitherKindIsItsCorners) {
  for (const std::string& bytes :
       {binary_stl(solid_box), binary_stl(solid_box, "solid says this header"),
        binary_stl(solid_box, "ply"), ascii_stl(solid_box), ascii_stl(solid_box, "")}) {
    const TriangleMesh mesh = parse_mesh(bytes).mesh;
    EXPECT_EQ(mesh_format(bytes), MeshFormat::stl);
    EXPECT_NEAR(volume(mesh), 48, 1e-12);
    EXPECT_EQ(mesh.vertices.size(), 8u);
    EXPECT_EQ(mesh.triangles.size(), 12u);
  }
}

TEST(StlFile, OfTextMayBeWrittenAsProgramsWriteIt) {
  const std::string text = ascii_stl(solid_box);
  std::string upper = text, mac = text, windows, one_line = text;
  for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::ranges::replace(mac, '\n', '\r');
  for (const char c : text) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  std::replace(one_line.begin() + 20, one_line.end(), '\n', ' ');
  for (const std::string& written :
       {upper, mac, windows, one_line, "\n \t" + text, text + "\n\n",
        replaced(text, "vertex 1", "vertex +1.0e0"), replaced(text, "endsolid a box", "endsolid")})
    EXPECT_NEAR(volume(parse_mesh(written).mesh), 48, 1e-12) << written;
}

TEST(StlFile, HoldsSeveralSolids) {
  TriangleMesh beside = solid_box;
  for (Vec3& v : beside.vertices) v.x += 5;
  EXPECT_NEAR(volume(parse_mesh(ascii_stl(solid_box) + ascii_stl(beside)).mesh), 96, 1e-12);
}

TEST(StlFile, OfTextIsRefusedWithTheLineAndWhy) {
  const std::string text = ascii_stl(solid_box);
  const auto refused = [&](const std::string& what, const std::string& by) {
    return refusal(replaced(text, what, by));
  };
  EXPECT_EQ(refused("outer loop", "outer look"),
            "line 3: \"look\" stands where \"loop\" has to follow");
  EXPECT_EQ(refused("vertex ", "vertex x"), "line 4: \"x-1\" is no finite number");
  EXPECT_EQ(refused("vertex ", "vertex 1e999 "), "line 4: \"1e999\" is no finite number");
  EXPECT_EQ(refused("    endloop\n", "      vertex 1 2 3\n    endloop\n"),
            "line 7: \"vertex\" stands where \"endloop\" has to follow");
  EXPECT_EQ(refused("endsolid a box\n", "more"),
            "line 86: \"more\" stands where \"facet\" has to follow");
  EXPECT_EQ(refused("endsolid a box\n", ""),
            "line 86: the file ends where \"facet\" has to follow");
  EXPECT_EQ(refusal("solid nothing\nendsolid\n"), "the mesh has no triangle");
  // Of the last solid's name, "endsolid" is enough.
  const std::size_t least = text.size() - std::string("endsolid a box\n").size() + 8;
  for (std::size_t length = 0; length < least; ++length)
    EXPECT_NE(refusal(text.substr(0, length)), "taken") << length;
}

TEST(StlFile, OfBytesIsRefusedWhereverItIsCutOff) {
  for (const char* header : {"made by a test", "solid"}) {
    const std::string whole = binary_stl(solid_box, header);
    for (std::size_t length = 0; length < whole.size(); ++length)
      EXPECT_NE(refusal(whole.substr(0, length)), "taken") << length;
    EXPECT_THAT(refusal(whole + "x"),
                HasSubstr("as a binary STL announces 12 triangles, which make 684 bytes: there "
                          "are 685"));
  }
}

TEST(StlFile, ThatAnnouncesWhatItHasNotIsRefusedAtOnce) {
  std::string bytes(84, '\0');
  bytes[83] = '\x06';  // 100,663,296
  EXPECT_THAT(refusal(bytes), AllOf(HasSubstr("100663296 triangles"), HasSubstr("there are 84")));
  bytes.resize(84);
  std::memset(bytes.data() + 80, 0xff, 4);
  EXPECT_THAT(refusal(bytes), HasSubstr("4294967295 triangles"));
  EXPECT_EQ(refusal(std::string(84, '\0')), "the mesh has no triangle");
}

TEST(StlFile, OfBytesIsRefusedWithTheTriangleAndWhy) {
  TriangleMesh bad = solid_box;
  bad.vertices.push_back({0, std::nan(""), 0});
  bad.triangles[4][1] = 8;
  EXPECT_EQ(refusal(binary_stl(bad)), "triangle 5 of 12: a coordinate that is not finite");
  EXPECT_THAT(refusal(binary_stl(solid_box, "far away", {1e7, 0, 0})), HasSubstr("too coarse"));
}

TEST(MeshFormat, IsToldByTheBytes) {
  EXPECT_EQ(mesh_format("ply\n"), MeshFormat::ply);
  EXPECT_EQ(mesh_format("# anything\nv 1 2 3\n"), MeshFormat::obj);
  EXPECT_EQ(mesh_format("  SOLID\n"), MeshFormat::stl);
  EXPECT_EQ(mesh_format(""), MeshFormat::obj);
  EXPECT_THAT(refusal(std::string("PK\3\4\0\0", 6)), HasSubstr("no OBJ, PLY, STL or glTF"));
}

}  // namespace
}  // namespace translucube::test

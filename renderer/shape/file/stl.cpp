#include <bit>
#include <cctype>
#include <cstring>
#include <limits>

#include "renderer/shape/file/number.h"
#include "renderer/shape/file/polygon_mesh.h"

namespace translucube {
namespace {

// A binary file: 80 bytes of anything, the number of triangles, and of each its normal, its corners
// and two bytes of which nobody agreed what they mean.
constexpr std::size_t header_bytes = 80, head_bytes = header_bytes + 4, triangle_bytes = 50,
                      normal_bytes = 12;

template <class T>
T little_endian(const char* bytes) {
  std::uint32_t bits = 0;
  for (int i = 3; i >= 0; --i) bits = bits << 8 | static_cast<unsigned char>(bytes[i]);
  return std::bit_cast<T>(bits);
}

std::uint64_t announced(std::string_view bytes) {
  return little_endian<std::uint32_t>(bytes.data() + header_bytes);
}

void add_triangle(const std::array<Vec3, 3>& corners, std::uint32_t place, PolygonMesh& mesh) {
  if (mesh.vertices.size() > std::numeric_limits<std::uint32_t>::max() - corners.size())
    throw MeshError("more triangles than can be counted");
  for (const Vec3& corner : corners) {
    mesh.corners.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
    mesh.vertices.push_back(corner);
  }
  mesh.ends.push_back(mesh.corners.size());
  mesh.places.push_back(place);
}

PolygonMesh parse_binary(std::string_view bytes) {
  PolygonMesh mesh;
  mesh.place = "triangle";
  mesh.rounding = 0x1p-24;
  const std::uint64_t count = announced(bytes);
  mesh.vertices.reserve(3 * count);
  mesh.corners.reserve(3 * count);
  mesh.ends.reserve(count);
  mesh.places.reserve(count);
  for (std::uint64_t t = 0; t < count; ++t) {
    const char* at = bytes.data() + head_bytes + t * triangle_bytes + normal_bytes;
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners)
      for (double* x : {&corner.x, &corner.y, &corner.z}) {
        *x = static_cast<double>(little_endian<float>(at));
        at += sizeof(float);
        if (!std::isfinite(*x))
          throw MeshError("triangle " + std::to_string(t + 1) + " of " + std::to_string(count) +
                          ": a coordinate that is not finite");
      }
    add_triangle(corners, static_cast<std::uint32_t>(t + 1), mesh);
  }
  return mesh;
}

/// Words between white space of any kind, in any case, as programs write them.
class AsciiParser {
 public:
  explicit AsciiParser(std::string_view text) : rest_(text) {}

  PolygonMesh parse() {
    for (std::string_view word = next(); !word.empty(); word = next()) {
      if (!is(word, "solid")) fail(word, "solid");
      pass_line();  // its name
      read_solid();
    }
    return std::move(mesh_);
  }

 private:
  static bool is(std::string_view word, std::string_view keyword) {
    return std::ranges::equal(word, keyword, {}, [](unsigned char c) { return std::tolower(c); });
  }

  [[noreturn]] void refuse(const std::string& why) const {
    throw MeshError("line " + std::to_string(line_) + ": " + why);
  }
  [[noreturn]] void fail(std::string_view word, const std::string& expected) const {
    if (word.empty()) refuse("the file ends where \"" + expected + "\" has to follow");
    refuse("\"" + printable(word) + "\" stands where \"" + expected + "\" has to follow");
  }

  std::string_view next() {
    for (; !rest_.empty(); rest_.remove_prefix(1)) {
      const char c = rest_.front();
      if (c == '\n' || (c == '\r' && !rest_.starts_with("\r\n")))
        ++line_;
      else if (c != ' ' && c != '\t' && c != '\r' && c != '\f' && c != '\v')
        break;
    }
    return next_word(rest_, " \t\r\n\f\v");
  }

  void pass_line() { rest_.remove_prefix(std::min(rest_.find_first_of("\r\n"), rest_.size())); }

  void expect(const std::string& keyword) {
    const std::string_view word = next();
    if (!is(word, keyword)) fail(word, keyword);
  }

  void read_solid() {
    for (;;) {
      const std::string_view word = next();
      if (is(word, "endsolid")) return pass_line();
      if (!is(word, "facet")) fail(word, "facet");
      read_facet();
    }
  }

  void read_facet() {
    const std::uint32_t place = line_;
    expect("normal");
    // The corners say it better: of a narrow triangle it is often no number.
    for (int i = 0; i < 3; ++i)
      if (next().empty()) fail({}, "a number");
    expect("outer");
    expect("loop");
    std::array<Vec3, 3> corners;
    for (Vec3& corner : corners) {
      expect("vertex");
      for (double* x : {&corner.x, &corner.y, &corner.z}) {
        const std::string_view word = next();
        if (!read_number(word, *x)) refuse("\"" + printable(word) + "\" is no finite number");
      }
    }
    expect("endloop");
    expect("endfacet");
    add_triangle(corners, place, mesh_);
  }

  std::string_view rest_;
  std::uint32_t line_ = 1;
  PolygonMesh mesh_;
};

}  // namespace

bool is_binary_stl(std::string_view bytes) {
  return bytes.size() >= head_bytes &&
         bytes.size() == head_bytes + announced(bytes) * triangle_bytes;
}

std::string size_as_binary_stl(std::string_view bytes) {
  if (bytes.size() < head_bytes) return "is shorter than the head of a binary STL";
  return "as a binary STL announces " + std::to_string(announced(bytes)) +
         " triangles, which make " +
         std::to_string(head_bytes + announced(bytes) * triangle_bytes) + " bytes: there are " +
         std::to_string(bytes.size());
}

PolygonMesh parse_stl(std::string_view bytes) {
  PolygonMesh mesh = is_binary_stl(bytes) ? parse_binary(bytes) : AsciiParser(bytes).parse();
  if (mesh.faces() == 0) throw MeshError("the mesh has no triangle");
  return mesh;
}

}  // namespace translucube

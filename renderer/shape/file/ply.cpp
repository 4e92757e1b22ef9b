#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <limits>

#include "renderer/shape/file/number.h"
#include "renderer/shape/file/ply_header.h"
#include "renderer/shape/file/polygon_mesh.h"

namespace translucube {
namespace {

using namespace ply;

/// One number after the other from the body.
class BodyReader {
 public:
  BodyReader(std::string_view rest, Encoding encoding) : rest_(rest), encoding_(encoding) {}

  void stand_at(const Element& element, std::uint64_t index) {
    element_ = &element;
    index_ = index;
  }

  [[noreturn]] void fail_here(const std::string& why) const {
    throw MeshError(element_->name + " " + std::to_string(index_ + 1) + " of " +
                    std::to_string(element_->count) + ": " + why);
  }

  double number(Scalar type) {
    if (encoding_ == Encoding::ascii) return ascii_number(type);
    const std::size_t size = size_of(type);
    if (rest_.size() < size) fail_here("the file ends within it");
    std::array<char, 8> bytes{};
    std::ranges::copy(rest_.substr(0, size), bytes.begin());
    if ((encoding_ == Encoding::little_endian) != (std::endian::native == std::endian::little))
      std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    rest_.remove_prefix(size);
    switch (type) {
      case Scalar::int8:
        return as<std::int8_t>(bytes);
      case Scalar::uint8:
        return as<std::uint8_t>(bytes);
      case Scalar::int16:
        return as<std::int16_t>(bytes);
      case Scalar::uint16:
        return as<std::uint16_t>(bytes);
      case Scalar::int32:
        return as<std::int32_t>(bytes);
      case Scalar::uint32:
        return as<std::uint32_t>(bytes);
      case Scalar::float32:
        return static_cast<double>(as<float>(bytes));
      case Scalar::float64:
        return as<double>(bytes);
    }
    return 0;
  }

  /// A list's length. No list is longer than what is left of the file.
  std::uint64_t length(Scalar type, Scalar of) {
    const double count = number(type);
    const std::size_t least = encoding_ == Encoding::ascii ? 2 : size_of(of);
    if (count < 0) fail_here("a list of negative length");
    if (count * static_cast<double>(least) > static_cast<double>(rest_.size() + 1))
      fail_here("a list longer than the rest of the file");
    return static_cast<std::uint64_t>(count);
  }

  bool can_hold(const Element& element) const {
    std::size_t least = 0;
    for (const Property& p : element.properties)
      least += encoding_ == Encoding::ascii ? 2 : size_of(p.count ? *p.count : p.type);
    return element.properties.empty() ||
           element.count <= (rest_.size() + 1) / std::max<std::size_t>(1, least);
  }

  /// Whether nothing but white space is left.
  bool at_end() const { return rest_.find_first_not_of(" \t\r\n") == rest_.npos; }

 private:
  template <class T>
  static T as(const std::array<char, 8>& bytes) {
    T value;
    std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }

  double ascii_number(Scalar type) {
    const std::string_view word = next_word(rest_, " \t\r\n");
    if (word.empty()) fail_here("the file ends within it");
    double value = 0;
    if (!read_number(word, value)) fail_here("a word that is no finite number");
    if (!is_integer(type)) return value;
    const bool is_signed = type == Scalar::int8 || type == Scalar::int16 || type == Scalar::int32;
    const int bits = static_cast<int>(8 * size_of(type)) - is_signed;
    const double most = std::ldexp(1.0, bits) - 1, least = is_signed ? -most - 1 : 0;
    if (value != std::floor(value) || value > most || value < least)
      fail_here("a number that its type does not have");
    return value;
  }

  std::string_view rest_;
  Encoding encoding_;
  const Element* element_ = nullptr;
  std::uint64_t index_ = 0;
};

void skip(const Property& property, BodyReader& body) {
  const std::uint64_t n = property.count ? body.length(*property.count, property.type) : 1;
  for (std::uint64_t i = 0; i < n; ++i) body.number(property.type);
}

/// What a vertex's property is of its position and normal: an index into `vertex_numbers`, or none.
constexpr std::array<std::string_view, 6> vertex_numbers{"x", "y", "z", "nx", "ny", "nz"};
using VertexLayout = std::vector<std::size_t>;

VertexLayout vertex_layout(const Element& element, PolygonMesh& mesh) {
  constexpr std::size_t none = vertex_numbers.size();
  VertexLayout layout;
  std::array<int, none> times{};
  for (const Property& property : element.properties) {
    const std::size_t number = static_cast<std::size_t>(
        std::ranges::find(vertex_numbers, property.name) - vertex_numbers.begin());
    layout.push_back(number);
    if (number == none) continue;
    const bool of_position = number < 3;
    if (property.count || ++times[number] > 1)
      throw MeshError(of_position ? "x, y and z are one number each"
                                  : "nx, ny and nz are one number each");
    if (of_position && property.type == Scalar::float32) mesh.rounding = 0x1p-24;
  }
  if (!times[0] || !times[1] || !times[2]) throw MeshError("its vertices have no x, y and z");
  if (!times[3] || !times[4] || !times[5])
    for (std::size_t& number : layout)
      if (number >= 3) number = none;
  return layout;
}

void read_vertices(const Element& element, BodyReader& body, PolygonMesh& mesh) {
  const VertexLayout layout = vertex_layout(element, mesh);
  const bool normals = std::ranges::find(layout, 3u) != layout.end();
  mesh.vertices.reserve(element.count);
  if (normals) mesh.normals.reserve(element.count);
  for (std::uint64_t v = 0; v < element.count; ++v) {
    body.stand_at(element, v);
    std::array<double, vertex_numbers.size()> p{};
    for (std::size_t i = 0; i < layout.size(); ++i) {
      if (layout[i] == vertex_numbers.size()) {
        skip(element.properties[i], body);
        continue;
      }
      const double x = body.number(element.properties[i].type);
      if (layout[i] < 3 && !std::isfinite(x)) body.fail_here("a coordinate that is not finite");
      p[layout[i]] = x;
    }
    mesh.vertices.push_back({p[0], p[1], p[2]});
    // Programs write the normal of a vertex without a face as 0 / 0.
    const bool finite = std::isfinite(p[3]) && std::isfinite(p[4]) && std::isfinite(p[5]);
    if (normals) mesh.normals.push_back(finite ? unit_or_zero({p[3], p[4], p[5]}) : Vec3{});
  }
}

void read_corners(const Property& property, std::uint64_t vertices, BodyReader& body,
                  PolygonMesh& mesh) {
  const std::uint64_t n = body.length(*property.count, property.type);
  if (n < 3) body.fail_here("a face needs three corners");
  for (std::uint64_t i = 0; i < n; ++i) {
    const double vertex = body.number(property.type);
    if (vertex < 0 || vertex >= static_cast<double>(vertices))
      body.fail_here("a vertex that does not exist: there are " + std::to_string(vertices));
    mesh.corners.push_back(static_cast<std::uint32_t>(vertex));
  }
}

void read_faces(const Element& element, std::uint64_t vertices, BodyReader& body,
                PolygonMesh& mesh) {
  const auto names_corners = [](const Property& p) {
    return p.name == "vertex_indices" || p.name == "vertex_index";
  };
  if (std::ranges::count_if(element.properties, names_corners) != 1)
    throw MeshError("its faces have no vertex_indices");
  const Property& corners = *std::ranges::find_if(element.properties, names_corners);
  if (!corners.count || !is_integer(corners.type))
    throw MeshError("vertex_indices is no list of integers");
  mesh.ends.reserve(element.count);
  mesh.places.reserve(element.count);
  for (std::uint64_t f = 0; f < element.count; ++f) {
    body.stand_at(element, f);
    for (const Property& property : element.properties)
      if (&property == &corners)
        read_corners(property, vertices, body, mesh);
      else
        skip(property, body);
    mesh.ends.push_back(mesh.corners.size());
    mesh.places.push_back(static_cast<std::uint32_t>(f + 1));
  }
}

}  // namespace

PolygonMesh parse_ply(std::string_view bytes) {
  const Header header = read_header(bytes);
  PolygonMesh mesh;
  mesh.place = "face";
  const auto& elements = header.elements;
  const auto vertex = std::ranges::find(elements, "vertex", &Element::name);
  if (vertex == elements.end()) throw MeshError("the file has no element \"vertex\"");
  if (vertex->count > std::numeric_limits<std::uint32_t>::max())
    throw MeshError("more vertices than can be counted");
  BodyReader body(header.body, header.encoding);
  for (const Element& element : elements) {
    if (element.name == "tristrips") throw MeshError("triangle strips (tristrips) are not read");
    if (!body.can_hold(element))
      throw MeshError("the file is too short for " + std::to_string(element.count) + " of \"" +
                      element.name + "\"");
    if (&element == &*vertex) {
      read_vertices(element, body, mesh);
    } else if (element.name == "face") {
      read_faces(element, vertex->count, body, mesh);
    } else if (!element.properties.empty()) {
      for (std::uint64_t i = 0; i < element.count; ++i) {
        body.stand_at(element, i);
        for (const Property& property : element.properties) skip(property, body);
      }
    }
  }
  if (!body.at_end()) throw MeshError("more bytes follow behind the last element");
  if (mesh.faces() == 0) throw MeshError("the mesh has no face");
  if (!mesh.normals.empty()) mesh.corner_normals = mesh.corners;  // a vertex has one of its own
  return mesh;
}

}  // namespace translucube

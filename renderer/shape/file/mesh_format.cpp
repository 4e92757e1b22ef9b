#include "renderer/shape/file/mesh_format.h"

#include <sstream>

#include "renderer/shape/bounding_box.h"
#include "renderer/shape/file/number.h"
#include "renderer/shape/file/polygon_mesh.h"

namespace translucube {
namespace {

bool is_text(std::string_view bytes) {
  constexpr std::size_t enough = 512;
  return bytes.substr(0, enough).find('\0') == bytes.npos;
}

PolygonMesh parse_polygons(MeshFormat format, std::string_view bytes) {
  switch (format) {
    case MeshFormat::obj:
      return parse_obj(bytes);
    case MeshFormat::ply:
      return parse_ply(bytes);
    case MeshFormat::stl:
      return parse_stl(bytes);
    case MeshFormat::gltf:
      return parse_gltf(bytes);
  }
  throw MeshError("no format of a mesh");
}

/// Lengths of bodies are from a nanometre to a thousand kilometres, as those of other objects.
void check_extent(const TriangleMesh& mesh) {
  constexpr double least = 1e-6, most = 1e9;  // mm
  BoundingBox box;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) box.add(mesh.vertices[v]);
  const Vec3 size = box.high - box.low;
  const double largest = std::max({size.x, size.y, size.z});
  if (largest >= least && largest <= most) return;
  std::ostringstream text;
  text << "the mesh is " << largest << " mm large; it has to be from 1e-6 to 1e9 mm";
  throw MeshError(text.str());
}

}  // namespace

MeshFormat mesh_format(std::string_view bytes) {
  if (is_binary_stl(bytes)) return MeshFormat::stl;
  if (bytes.starts_with("ply")) return MeshFormat::ply;
  if (bytes.starts_with("glTF")) return MeshFormat::gltf;  // GLB
  if (!is_text(bytes))
    throw MeshError("the file is no OBJ, PLY, STL or glTF, and " + size_as_binary_stl(bytes));
  std::string_view rest = bytes;
  std::string first(next_word(rest, " \t\r\n\f\v").substr(0, 8));
  std::ranges::transform(first, first.begin(), [](unsigned char c) { return std::tolower(c); });
  if (first.starts_with('{')) return MeshFormat::gltf;
  return first == "solid" ? MeshFormat::stl : MeshFormat::obj;
}

ClosedMesh parse_mesh(MeshFormat format, std::string_view bytes) {
  ClosedMesh closed{triangulate(parse_polygons(format, bytes)), {}};
  check_extent(closed.mesh);
  closed.report = close_mesh(closed.mesh);
  return closed;
}

}  // namespace translucube

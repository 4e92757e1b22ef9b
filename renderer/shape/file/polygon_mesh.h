#pragma once

// Mesh files: their bytes, as strangers write them, become triangles or a refusal that says where.
// Everything here is a function of bytes: it opens nothing, and runs in a process without rights
// (picture/sandbox).

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/shape/triangle_mesh.h"

namespace translucube {

/// Faces of any number of corners, in the order of a file.
struct PolygonMesh {
  std::vector<Vec3> vertices;
  std::vector<std::uint32_t> corners;         ///< of all faces, one after the other
  std::vector<std::uint64_t> ends;            ///< of each face's corners
  std::vector<std::uint32_t> places;          ///< where each face stands in the file
  std::vector<Vec3> normals;                  ///< unit, or zero where the file gives no direction
  std::vector<std::uint32_t> corner_normals;  ///< of each corner, or no_normal; empty: none at all
  std::string_view place = "line";            ///< what `places` counts, from 1
  /// What storing a coordinate may round off, of its size: 2^-53 for numbers in double precision.
  double rounding = 0x1p-53;

  std::size_t faces() const { return ends.size(); }
  std::span<const std::uint32_t> face(std::size_t i) const { return of_face(corners, i); }
  /// Of its corners; empty where the file has none.
  std::span<const std::uint32_t> face_normals(std::size_t i) const {
    return corner_normals.empty() ? std::span<const std::uint32_t>{} : of_face(corner_normals, i);
  }

 private:
  std::span<const std::uint32_t> of_face(const std::vector<std::uint32_t>& all,
                                         std::size_t i) const {
    const std::uint64_t begin = i == 0 ? 0 : ends[i - 1];
    return {all.data() + begin, static_cast<std::size_t>(ends[i] - begin)};
  }
};

/// Wavefront OBJ, the polygons alone. Throws MeshError that names the line.
PolygonMesh parse_obj(std::string_view text);

/// PLY 1.0, ASCII or binary of either byte order (Turk 1994). Throws MeshError that names the line
/// of the header or the element.
PolygonMesh parse_ply(std::string_view bytes);

/// STL, ASCII or binary (3D Systems 1989). Its corners are the mesh; normals and attribute bytes
/// say nothing more. Throws MeshError that names the line or the triangle.
PolygonMesh parse_stl(std::string_view bytes);

/// By its size: the header of a binary file may say "solid" too.
bool is_binary_stl(std::string_view bytes);
/// Why a file is none, for a refusal: "as a binary STL announces ...".
std::string size_as_binary_stl(std::string_view bytes);

/// glTF 2.0, as GLB or as a document with its buffers embedded (gltf/): the triangles of the
/// default scene, placed by its nodes, in metres as glTF has them, here in millimetres. Throws
/// MeshError that names the JSON pointer or the byte.
PolygonMesh parse_gltf(std::string_view bytes);

/// The faces as triangles: polygons by clipping ears (Meisters 1975), so that concave ones keep
/// their outline. Throws MeshError for polygons that cross themselves, and for coordinates that
/// were rounded by more than 1e-5 of the mesh's extent.
TriangleMesh triangulate(const PolygonMesh& polygons);

}  // namespace translucube

#pragma once

#include <string_view>

#include "renderer/shape/triangle_mesh.h"

namespace translucube {

enum class MeshFormat { obj, ply, stl, gltf };

/// What the sandbox's program calls meshes of any format.
inline constexpr const char* mesh_kind = "mesh";

/// The format of a file by its bytes, whatever its name. Throws MeshError where it is none that is
/// known.
MeshFormat mesh_format(std::string_view bytes);

/// A file's bytes as the boundary of one body (close_mesh). Throws MeshError that says where.
ClosedMesh parse_mesh(MeshFormat format, std::string_view bytes);
inline ClosedMesh parse_mesh(std::string_view bytes) {
  return parse_mesh(mesh_format(bytes), bytes);
}

}  // namespace translucube

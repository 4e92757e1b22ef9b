#pragma once

#include <string>
#include <string_view>

#include "renderer/shape/triangle_mesh.h"

namespace translucube {

enum class MeshFormat { obj, ply };

/// What the sandbox's program calls it.
inline std::string sandbox_kind(MeshFormat format) {
  return format == MeshFormat::obj ? "mesh.obj" : "mesh.ply";
}

/// A file's bytes as the boundary of one body (close_mesh). Throws MeshError that says where.
TriangleMesh parse_mesh(MeshFormat format, std::string_view bytes);

}  // namespace translucube

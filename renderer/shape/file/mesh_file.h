#pragma once

#include <filesystem>
#include <span>

#include "renderer/shape/triangle_mesh.h"

namespace translucube {

/// What went wrong with the machine rather than the file, which may be readable another time.
struct MeshUnavailable : MeshError {
  using MeshError::MeshError;
};

/// Reads an OBJ or PLY file, by its extension, as the boundary of one body (close_mesh), in a
/// process without rights. Throws MeshError, and MeshUnavailable where another try may help.
TriangleMesh read_mesh(const std::filesystem::path& file);

/// A mesh out of that process' answer, which is believed in nothing that memory depends on. Throws
/// AnswerError.
TriangleMesh unpack_mesh(std::span<const std::byte> bytes);

}  // namespace translucube

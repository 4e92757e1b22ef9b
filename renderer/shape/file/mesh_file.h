#pragma once

#include <filesystem>
#include <span>

#include "renderer/shape/triangle_mesh.h"

namespace translucube {

/// What went wrong with the machine rather than the file, which may be readable another time.
struct MeshUnavailable : MeshError {
  using MeshError::MeshError;
};

/// Reads a file of any format of a mesh as the boundary of one body (close_mesh), in a process
/// without rights. Throws MeshError, and MeshUnavailable where another try may help.
ClosedMesh read_mesh(const std::filesystem::path& file);

/// A mesh out of that process' answer, which is believed in nothing that memory depends on. Throws
/// AnswerError.
ClosedMesh unpack_mesh(std::span<const std::byte> bytes);

}  // namespace translucube

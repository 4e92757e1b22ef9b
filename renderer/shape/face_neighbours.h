#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "renderer/shape/triangle_mesh.h"

namespace translucube {

/// The faces of a mesh that share a vertex with each, but for vertices where so many meet that all
/// pairs of them would be too many.
class FaceNeighbours {
 public:
  static constexpr std::uint32_t most_around_vertex = 32;

  FaceNeighbours() = default;
  explicit FaceNeighbours(const TriangleMesh& mesh);

  /// In ascending order, without the face itself.
  std::span<const std::uint32_t> of(std::uint32_t face) const {
    return std::span(faces_).subspan(from_[face], from_[face + 1] - from_[face]);
  }

 private:
  std::vector<std::uint32_t> from_, faces_;  ///< those of face i begin at from_[i]
};

}  // namespace translucube

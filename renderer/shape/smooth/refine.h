#pragma once

// Smooth surfaces by geometry: the triangles of a mesh stand for curved patches, and many small
// triangles for each of these. Nothing is said of normals that the surface does not have, so light
// keeps its energy, its lengths and its refraction.

#include <cstdint>
#include <optional>

#include "renderer/shape/triangle_mesh.h"

namespace translucube {

/// What became of a mesh that was made smooth.
struct Refinement {
  std::uint64_t given = 0;  ///< triangles
  std::uint64_t made = 0;   ///< triangles in their place
  double chord_error = 0;   ///< of their sides from the curved ones, in radii of the mesh
  bool limited = false;     ///< the error is larger than wished, or there would be too many
  friend bool operator==(const Refinement&, const Refinement&) = default;
};

/// How fine it should get, in radii of the mesh: as no picture of a thousand pixels shows.
struct Fineness {
  double chord_error = 1e-5;  ///< a hundredth of a pixel
  double least_side = 1e-3;   ///< what is shorter is not divided, however it bends: half a pixel
};
inline constexpr std::uint64_t most_refined_triangles = 2'000'000;

/// Replaces the triangles of a closed mesh by those of curved PN triangles (Vlachos, Peters, Boyd,
/// Mitchell 2001) over them, of the normals at their corners (normals.h), which are used up. Where
/// the two triangles of an edge have different normals, the edge stays a crease. The mesh stays
/// closed, as both triangles of an edge have the same points on it; flat parts stay as they are.
Refinement refine(TriangleMesh& mesh, const Fineness& wish = {},
                  std::uint64_t most_triangles = most_refined_triangles);
/// Half the diagonal of the bounding box: the radius that chord errors are told in.
double bounding_radius(const TriangleMesh& mesh);

/// Refines the mesh of a file as somebody asked for: `smooth`, by the file's normals, or where
/// these say nothing (has_smooth_normals) by means of the triangles'; not at all; or, where nobody
/// asked, if the file's normals say something. Throws MeshError where parts meet that did not
/// before.
std::optional<Refinement> make_smooth(TriangleMesh& mesh, std::optional<bool> smooth);

}  // namespace translucube

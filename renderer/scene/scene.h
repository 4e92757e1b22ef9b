#pragma once

// What the transport reads: the scene with its resources loaded and everything that can be decided
// once decided. Lengths are in the body's unit.

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "renderer/film/absorption.h"
#include "renderer/film/length_bins.h"
#include "renderer/light/backdrop.h"
#include "renderer/light/lighting.h"
#include "renderer/optics/interface.h"
#include "renderer/optics/interior.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/spec.h"
#include "renderer/shape/bowl.h"
#include "renderer/shape/mesh.h"
#include "renderer/shape/polytope.h"
#include "renderer/shape/smooth/refine.h"
#include "renderer/shape/sphere.h"

namespace translucube {

/// Where a film smooths the rough interface, in the body's coordinates.
struct OiledPart {
  Vec3 normal;
  double offset = 0;
  bool covers(Vec3 p) const { return dot(p, normal) >= offset; }
};

using AnyShape = std::variant<Sphere, Mesh, Polytope, Bowl>;

struct Scene {
  int width = 0, height = 0;
  std::uint64_t seed = 0;
  double unit_mm = 1;  ///< the body's unit of length
  AnyShape shape;
  std::optional<MeshReport> mesh;        ///< of a shape that was read from a file
  std::optional<Refinement> refinement;  ///< of a mesh that was made smooth
  AnyInterface interface;
  std::optional<OiledPart> oiled;  ///< of a rough interface
  AnyInterior interior;
  Lighting environment;
  std::optional<Backdrop>
      backdrop;  ///< or the ground: the environment shows the half before it only
  Camera camera;
  bool camera_inside = false;
  std::vector<Lane> lanes;          ///< of the film, unless it is explorable; [0] is the material's
  std::optional<BinSpread> spread;  ///< explorable: the film's lanes are bins of length

  int film_lanes() const {
    return spread ? spread->bins().count() : static_cast<int>(lanes.size());
  }
};

}  // namespace translucube

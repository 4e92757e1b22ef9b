#pragma once

// What the transport reads: the scene with its resources loaded and everything that can be decided
// once decided. Lengths are in the body's unit.

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "renderer/absorption.h"
#include "renderer/backdrop.h"
#include "renderer/bowl.h"
#include "renderer/bsdf.h"
#include "renderer/camera.h"
#include "renderer/dipole_interior.h"
#include "renderer/environment.h"
#include "renderer/explorable.h"
#include "renderer/lambertian.h"
#include "renderer/medium.h"
#include "renderer/polytope.h"
#include "renderer/scene.h"
#include "renderer/shapes.h"

namespace translucube {

/// What lies behind the interface, and so which transport runs.
struct BlackInterior {};  ///< a = 1: nothing comes back
struct ClearInterior {};  ///< s = 0: interface events only
struct ScatteringInterior {
  Medium medium;  ///< 0 < s < 1: random walk
};
struct DensePigmentInterior {
  Medium medium;  ///< s = 1 with pigments: a half space below each point of the surface, lengths in
                  ///< mean free paths of scattering
};
struct LambertianInterior {
  InterfacedLambertian base;   ///< s = 1: closed form
  InterfacedLambertian oiled;  ///< the same under the film, where there is one
};

/// Where a film smooths the rough interface, in the body's coordinates.
struct OiledPart {
  Vec3 normal;
  double offset = 0;
  bool covers(Vec3 p) const { return dot(p, normal) >= offset; }
};

using Shape = std::variant<Sphere, Slab, Mesh, Polytope, Bowl>;
using Interface = std::variant<SmoothInterface, RoughInterface>;
using Interior = std::variant<BlackInterior, ClearInterior, ScatteringInterior,
                              DensePigmentInterior, LambertianInterior, DipoleInterior>;

struct Scene {
  int width = 0, height = 0;
  std::uint64_t seed = 0;
  double unit_mm = 1;  ///< the body's unit of length
  Shape shape;
  Interface interface;
  std::optional<OiledPart> oiled;  ///< of a rough interface
  Interior interior;
  Environment environment;
  std::optional<Backdrop> backdrop;  ///< with it, the environment shows its front half only
  Camera camera;
  bool camera_inside = false;
  std::vector<Lane> lanes;          ///< of the film, unless it is explorable; [0] is the material's
  std::optional<BinSpread> spread;  ///< explorable: the film's lanes are bins of length
  /// Whether light is looked for at rough exits and through smooth boundaries; without, the same
  /// mean comes of the paths alone, with more noise.
  bool next_event_estimation = true;

  int film_lanes() const {
    return spread ? spread->bins().count() : static_cast<int>(lanes.size());
  }
};

/// The optics of a material for a body with this unit.
Interface make_interface(const Material& material);
Interior make_interior(const Material& material, double unit_mm);
/// The material's lane in the lengths that the interior's paths bring.
Lane make_lane(const Material& material, const Interior& interior, double unit_mm);
std::string transport_name(const Interior& interior);
/// The paper's model of a body that is neither empty nor black; every distance on it is within
/// `reach` units.
Interior make_dipole(const Material& material, double unit_mm, double opacity, double reach,
                     const std::vector<Absorption>& absorptions);

}  // namespace translucube

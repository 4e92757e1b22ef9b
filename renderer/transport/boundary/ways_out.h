#pragma once

// In this room stands how scatterers in any body find light through its boundary, where a sphere
// has ways of its own (../sphere). Nothing here knows of a path's stages.
//
// Within a flat face all light from one direction goes on in one direction inside (Snell), so that
// the way out of a point through a face towards a light is known at once, and that a ray in that
// direction meets the face says whether there is one (Walter, Zhao, Holzschuch, Bala 2009, of flat
// triangles).

#include <algorithm>
#include <array>
#include <optional>

#include "renderer/optics/fresnel.h"
#include "renderer/shape/mesh.h"
#include "renderer/shape/polytope.h"

namespace translucube {

/// A straight way out of a body.
struct WayOut {
  Vec3 d;           ///< inside, from the point
  double distance;  ///< to the boundary
  Vec3 n;           ///< there
};

/// The direction inside, towards the boundary, of light that comes in from `light` through a face
/// with normal n.
inline std::optional<Vec3> way_to(Vec3 light, Vec3 n, double ior) {
  constexpr double grazing = 1e-3;
  if (dot(light, n) <= grazing) return {};
  return -*refract(light, n, ior);
}

/// A plane about as the boundary near a point inside.
struct NearPlane {
  Vec3 n;        ///< outward
  double depth;  ///< of the point
};
inline NearPlane plane_near(const Polytope& body, Vec3 p) {
  NearPlane nearest{{}, std::numeric_limits<double>::infinity()};
  for (const Polytope::Plane& plane : body.planes())
    if (const double depth = plane.offset - dot(plane.n, p); depth < nearest.depth)
      nearest = {plane.n, depth};
  return nearest;
}
inline NearPlane plane_near(const Mesh& body, Vec3 p) {
  const Facet& facet = body.facet(body.face_near(p));
  return {facet.normal, std::fmax(0.0, dot(facet.a - p, facet.normal))};
}

/// A normal of the boundary near a point inside; any where that is not known.
template <class Shape>
Vec3 normal_near(const Shape&, Vec3) {
  return {0, 0, 1};
}
inline Vec3 normal_near(const Polytope& body, Vec3 p) { return plane_near(body, p).n; }
inline Vec3 normal_near(const Mesh& body, Vec3 p) { return plane_near(body, p).n; }

/// Calls `use` with ways out of p, a point inside, towards `light`: all that there are. Which ones
/// it finds depends on p and `light` alone.
template <class Use>
void find_ways_out(const Polytope& body, double ior, Vec3 p, Vec3 light, Use&& use) {
  for (std::uint32_t i = 0; i < Polytope::faces; ++i) {
    const Vec3 n = body.planes()[i].n;
    Hit hit;
    if (const auto d = way_to(light, n, ior))
      if (body.intersect_inside(p, *d, std::numeric_limits<double>::infinity(), hit) &&
          hit.face == i)
        use(WayOut{*d, hit.t, n});
  }
}

/// The faces around one through which there are ways out, found from face to face.
class FacetSearch {
 public:
  FacetSearch(const Mesh& body, double ior, Vec3 p, Vec3 light)
      : body_(body), ior_(ior), p_(p), light_(light) {}

  /// By a fixed point from `face`: its normal sends the light along a ray that meets the next one.
  /// Then around the last, where the surface bends outwards, others.
  template <class Use>
  void from(std::uint32_t face, Use&& use) {
    constexpr int steps = 4;
    for (int step = 0; step < steps; ++step) {
      Hit hit;
      const auto d = way_to(light_, body_.facet(face).normal, ior_);
      if (!d || !body_.intersect_inside(p_, *d, infinity, hit)) return;
      if (hit.face == face) break;
      face = hit.face;
    }
    if (!consider(face, use)) see(face), open_[opened_++] = face;
    while (expanded_ < opened_)
      for (const std::uint32_t near : body_.neighbours(open_[expanded_++])) consider(near, use);
  }

  bool found() const { return found_; }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  static constexpr std::size_t most_faces = 128, most_open = 16;

  bool see(std::uint32_t face) {
    const auto end = seen_.begin() + static_cast<std::ptrdiff_t>(count_);
    if (count_ == most_faces || std::find(seen_.begin(), end, face) != end) return false;
    seen_[count_++] = face;
    return true;
  }

  template <class Use>
  bool consider(std::uint32_t face, Use&& use) {
    if (!see(face)) return true;
    const Facet& facet = body_.facet(face);
    const auto d = way_to(light_, facet.normal, ior_);
    if (!d || !facet.lets_out(p_, *d)) return false;
    if (opened_ < most_open) open_[opened_++] = face;
    Hit hit;
    if (body_.intersect_inside(p_, *d, infinity, hit) && hit.face == face) {
      use(WayOut{*d, hit.t, hit.n});
      found_ = true;
    }
    return true;
  }

  const Mesh& body_;
  const double ior_;
  const Vec3 p_, light_;
  std::array<std::uint32_t, most_faces> seen_;
  std::array<std::uint32_t, most_open> open_;
  std::size_t count_ = 0, opened_ = 0, expanded_ = 0;
  bool found_ = false;
};

/// Of a mesh: those near a face that is sought from the one nearest to p, or else from where p sees
/// the light without a boundary. What lies further away is not found.
template <class Use>
void find_ways_out(const Mesh& body, double ior, Vec3 p, Vec3 light, Use&& use) {
  FacetSearch search(body, ior, p, light);
  search.from(body.face_near(p), use);
  Hit hit;
  if (!search.found() &&
      body.intersect_inside(p, light, std::numeric_limits<double>::infinity(), hit))
    search.from(hit.face, use);
}

}  // namespace translucube

#include <algorithm>

#include "renderer/shape/body/body.h"

namespace translucube {

TriangleMesh refined(BodyMesh body) {
  constexpr std::uint64_t most_triangles = 1'000'000;
  // Of what is thinnest, a hundredth of a percent, and a hundredth of its girth.
  constexpr double error = 2e-4, side = 0.03;
  const double thinnest = body.thinnest / bounding_radius(body.mesh);
  body.wish.chord_error = std::min(body.wish.chord_error, error * thinnest);
  body.wish.least_side = std::min(body.wish.least_side, side * thinnest);
  refine(body.mesh, body.wish, most_triangles);
  return std::move(body.mesh);
}

}  // namespace translucube

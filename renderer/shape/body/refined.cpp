#include <algorithm>

#include "renderer/shape/body/body.h"
#include "renderer/shape/smooth/refine.h"

namespace translucube {

TriangleMesh refined(BodyMesh body) {
  constexpr std::uint64_t most_triangles = 1'000'000;
  constexpr double of_thinnest = 2e-4;
  const double thin = of_thinnest * body.thinnest / bounding_radius(body.mesh);
  refine(body.mesh, std::min(body.chord_error, thin), most_triangles);
  return std::move(body.mesh);
}

}  // namespace translucube

#include <cmath>
#include <numbers>

#include "renderer/shape/body/body.h"

namespace translucube {

BodyMesh make_torus(double major, double minor) {
  // So many that curved triangles over them are a millionth off. Along the top of the tube all
  // normals are the same and say nothing of how it bends: there a chord has to stay near it.
  constexpr double off = 0.01;  // of the minor radius
  constexpr std::uint32_t around = 48;
  const double chords = std::ceil(std::numbers::pi * std::sqrt(major / (2 * off * minor)));
  const auto along = static_cast<std::uint32_t>(std::fmax(96, chords));
  BodyMesh body{{}, 2 * minor};
  TriangleMesh& mesh = body.mesh;
  for (std::uint32_t i = 0; i < along; ++i) {
    const double theta = 2 * std::numbers::pi * i / along;
    const Vec3 out{std::sin(theta), 0, std::cos(theta)};
    for (std::uint32_t j = 0; j < around; ++j) {
      const double phi = 2 * std::numbers::pi * j / around;
      const Vec3 normal = std::cos(phi) * out + Vec3{0, std::sin(phi), 0};
      mesh.normals.push_back(normal);
      mesh.vertices.push_back(major * out + minor * normal);
    }
  }
  for (std::uint32_t i = 0; i < along; ++i)
    for (std::uint32_t j = 0; j < around; ++j) {
      const std::uint32_t i2 = (i + 1) % along, j2 = (j + 1) % around;
      const std::uint32_t a = i * around + j, b = i2 * around + j, c = i2 * around + j2,
                          d = i * around + j2;
      mesh.triangles.insert(mesh.triangles.end(), {{a, b, c}, {a, c, d}});
    }
  mesh.corner_normals = mesh.triangles;
  return body;
}

}  // namespace translucube

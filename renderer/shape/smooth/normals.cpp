#include "renderer/shape/smooth/normals.h"

#include <cmath>

namespace translucube {
namespace {

Vec3 triangle_normal(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3 a = mesh.vertices[t[0]];
  return unit_or_zero(cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
}

}  // namespace

CornerNormals corner_normals(const TriangleMesh& mesh, std::size_t triangle) {
  constexpr double least_cosine = 0.26;  // 75 degrees
  const Vec3 own = triangle_normal(mesh, mesh.triangles[triangle]);
  CornerNormals corners{own, own, own};
  if (mesh.corner_normals.empty()) return corners;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t index = mesh.corner_normals[triangle][i];
    if (index == no_normal) continue;
    const Vec3 given = unit_or_zero(mesh.normals[index]);
    const double cosine = dot(given, own);
    if (std::fabs(cosine) >= least_cosine) corners[i] = cosine > 0 ? given : -given;
  }
  return corners;
}

bool has_smooth_normals(const TriangleMesh& mesh) {
  constexpr double cosine = 0.99996;  // half a degree
  for (std::size_t t = 0; t < mesh.corner_normals.size(); ++t) {
    const Vec3 own = triangle_normal(mesh, mesh.triangles[t]);
    for (const Vec3 n : corner_normals(mesh, t))
      if (own != Vec3{} && dot(n, own) < cosine) return true;
  }
  return false;
}

void average_normals(TriangleMesh& mesh) {
  mesh.normals.assign(mesh.vertices.size(), {});
  mesh.corner_normals = mesh.triangles;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 p = mesh.vertices[t[i]];
      const Vec3 a = mesh.vertices[t[(i + 1) % 3]] - p, b = mesh.vertices[t[(i + 2) % 3]] - p;
      const double weight = length_squared(a) * length_squared(b);
      if (weight > 0) mesh.normals[t[i]] = mesh.normals[t[i]] + cross(a, b) * (1 / weight);
    }
  for (Vec3& n : mesh.normals) n = unit_or_zero(n);
}

}  // namespace translucube

#pragma once

// Closed meshes to test with, made rather than stored.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>

#include "renderer/shape/mesh.h"

namespace translucube::test {

inline TriangleMesh box(Vec3 size) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.vertices.push_back({(i & 1 ? 0.5 : -0.5) * size.x, (i & 2 ? 0.5 : -0.5) * size.y,
                             (i & 4 ? 0.5 : -0.5) * size.z});
  const std::uint32_t quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                     {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& q : quads) {
    mesh.triangles.push_back({q[0], q[1], q[2]});
    mesh.triangles.push_back({q[0], q[2], q[3]});
  }
  return mesh;
}

/// Unit sphere, 20 * 4^levels triangles.
inline TriangleMesh icosphere(int levels) {
  const double a = (1 + std::sqrt(5.0)) / 2;
  TriangleMesh mesh{
      {{-1, a, 0},
       {1, a, 0},
       {-1, -a, 0},
       {1, -a, 0},
       {0, -1, a},
       {0, 1, a},
       {0, -1, -a},
       {0, 1, -a},
       {a, 0, -1},
       {a, 0, 1},
       {-a, 0, -1},
       {-a, 0, 1}},
      {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
       {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
       {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};
  for (Vec3& v : mesh.vertices) v = normalize(v);
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
    const auto middle = [&](std::uint32_t p, std::uint32_t q) {
      const auto [entry, fresh] = middles.try_emplace(std::minmax(p, q), mesh.vertices.size());
      if (fresh) mesh.vertices.push_back(normalize(mesh.vertices[p] + mesh.vertices[q]));
      return entry->second;
    };
    std::vector<Triangle> finer;
    for (const auto& [p, q, r] : mesh.triangles) {
      const std::uint32_t pq = middle(p, q), qr = middle(q, r), rp = middle(r, p);
      finer.insert(finer.end(), {{p, pq, rp}, {q, qr, pq}, {r, rp, qr}, {pq, qr, rp}});
    }
    mesh.triangles = std::move(finer);
  }
  return mesh;
}

/// A tube along a (2, 3) torus knot.
inline TriangleMesh knot(std::uint32_t along, std::uint32_t around, double tube = 0.3) {
  const auto center = [](double t) {
    const double r = 1 + 0.45 * std::cos(3 * t);
    return Vec3{r * std::cos(2 * t), r * std::sin(2 * t), 0.45 * std::sin(3 * t)};
  };
  TriangleMesh mesh;
  for (std::uint32_t i = 0; i < along; ++i) {
    const double t = 2 * std::numbers::pi * i / along, h = 1e-5;
    const Vec3 c = center(t), tangent = normalize(center(t + h) - center(t - h));
    const Vec3 x = normalize(cross(tangent, Vec3{c.x, c.y, 0})), y = cross(tangent, x);
    for (std::uint32_t j = 0; j < around; ++j) {
      const double phi = 2 * std::numbers::pi * j / around;
      mesh.vertices.push_back(c + tube * (std::cos(phi) * x + std::sin(phi) * y));
    }
  }
  for (std::uint32_t i = 0; i < along; ++i)
    for (std::uint32_t j = 0; j < around; ++j) {
      const std::uint32_t i2 = (i + 1) % along, j2 = (j + 1) % around;
      const std::uint32_t a = i * around + j, b = i2 * around + j, c = i2 * around + j2,
                          d = i * around + j2;
      mesh.triangles.push_back({a, b, c});
      mesh.triangles.push_back({a, c, d});
    }
  close_mesh(mesh);
  return mesh;
}

/// With the sphere's own normals at the corners.
inline TriangleMesh icosphere_with_normals(int levels) {
  TriangleMesh mesh = icosphere(levels);
  mesh.normals = mesh.vertices;
  mesh.corner_normals = mesh.triangles;
  return mesh;
}

/// A cylinder about y of radius 1 and height 2: smooth around, with a crease at either rim.
inline TriangleMesh cylinder_with_normals(std::uint32_t around) {
  TriangleMesh mesh;
  mesh.normals = {{0, -1, 0}, {0, 1, 0}};
  for (std::uint32_t i = 0; i < around; ++i) {
    const double phi = 2 * std::numbers::pi * i / around;
    const Vec3 out{std::sin(phi), 0, std::cos(phi)};
    mesh.vertices.insert(mesh.vertices.end(), {out - Vec3{0, 1, 0}, out + Vec3{0, 1, 0}});
    mesh.normals.push_back(out);
  }
  const auto centers = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), {{0, -1, 0}, {0, 1, 0}});
  for (std::uint32_t i = 0; i < around; ++i) {
    const std::uint32_t j = (i + 1) % around, a = 2 * i, b = 2 * j;
    mesh.triangles.insert(
        mesh.triangles.end(),
        {{a, b, b + 1}, {a, b + 1, a + 1}, {b, a, centers}, {a + 1, b + 1, centers + 1}});
    mesh.corner_normals.insert(
        mesh.corner_normals.end(),
        {{2 + i, 2 + j, 2 + j}, {2 + i, 2 + j, 2 + i}, {0, 0, 0}, {1, 1, 1}});
  }
  return mesh;
}

inline void write_obj(const TriangleMesh& mesh, const std::filesystem::path& file) {
  std::ofstream out(file);
  out.precision(9);
  for (const Vec3& v : mesh.vertices) out << "v " << v.x << " " << v.y << " " << v.z << "\n";
  for (const Triangle& t : mesh.triangles)
    out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
}

inline void write_ply(const TriangleMesh& mesh, const std::filesystem::path& file) {
  std::ofstream out(file);
  out.precision(9);
  out << "ply\nformat ascii 1.0\nelement vertex " << mesh.vertices.size()
      << "\nproperty float x\nproperty float y\nproperty float z\nelement face "
      << mesh.triangles.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Vec3& v : mesh.vertices) out << v.x << " " << v.y << " " << v.z << "\n";
  for (const Triangle& t : mesh.triangles)
    out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
}

}  // namespace translucube::test

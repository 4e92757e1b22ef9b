#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "renderer/shape/body/body.h"

namespace translucube {
namespace {

/// A point of the front's outline, with its normals towards falling and rising x.
struct OutlinePoint {
  double x, z;
  Vec3 before, after;
};

/// The front from the left to the right end: half valleys at both, ridges between them.
std::vector<OutlinePoint> outline(Vec3 extents, double sharpness, double share,
                                  std::uint32_t ridges) {
  // So many that curved triangles over a slope are a millionth of its size off.
  constexpr int parts = 24;
  constexpr double upright = 1e-4;  // a slope that takes less of its step is a wall
  const double step = extents.x / (2.0 * ridges);
  const double slope = 1 - sharpness < upright ? 0 : step * (1 - sharpness);
  const double top = 0.5 * extents.z, rise = share * extents.z;
  const Vec3 front{0, 0, 1};
  std::vector<OutlinePoint> points{{-0.5 * extents.x, top - rise, front, front}};
  for (std::uint32_t s = 0; s < 2 * ridges; ++s) {
    const bool up = s % 2 == 0;
    const double middle = -0.5 * extents.x + (s + 0.5) * step;
    const Vec3 wall{up ? -1.0 : 1.0, 0, 0};
    for (int i = 0; i <= parts; ++i) {
      if (slope == 0 && i > 0 && i < parts) continue;
      const double t = double(i) / parts, phase = std::numbers::pi * t;
      const double part = 0.5 * (1 - std::cos(phase));
      OutlinePoint point{middle + (t - 0.5) * slope, top - rise * (up ? 1 - part : part), {}, {}};
      const double rate = 0.5 * rise * std::numbers::pi * std::sin(phase) * (up ? 1 : -1);
      point.before = point.after = i == 0 || i == parts ? front : direction_of({-rate, 0, slope});
      if (slope == 0) (i == 0 ? point.after : point.before) = wall;
      // Where nothing is flat a slope begins where the last one ended.
      if (i > 0 || point.x > points.back().x + 0.5 * upright * step) points.push_back(point);
    }
  }
  const double end = 0.5 * extents.x;
  if (end > points.back().x + 0.5 * upright * step) points.push_back({end, 0, front, front});
  points.back().x = end;
  points.back().z = points.front().z;
  return points;
}

}  // namespace

BodyMesh make_relief(Vec3 extents, double sharpness, double share, std::uint32_t ridges) {
  const std::vector<OutlinePoint> points = outline(extents, sharpness, share, ridges);
  BodyMesh body{{}, std::min({extents.x, extents.y, (1 - share) * extents.z})};
  TriangleMesh& mesh = body.mesh;
  mesh.normals = {{0, 0, -1}, {0, -1, 0}, {0, 1, 0}, {-1, 0, 0}, {1, 0, 0}};
  const double half = 0.5 * extents.y, back = -0.5 * extents.z;
  for (const OutlinePoint& p : points) {
    mesh.vertices.insert(
        mesh.vertices.end(),
        {{p.x, -half, p.z}, {p.x, half, p.z}, {p.x, -half, back}, {p.x, half, back}});
    mesh.normals.insert(mesh.normals.end(), {p.before, p.after});
  }
  const auto add_quad = [&](std::array<std::uint32_t, 4> v, std::array<std::uint32_t, 4> n) {
    mesh.triangles.insert(mesh.triangles.end(), {{v[0], v[1], v[2]}, {v[0], v[2], v[3]}});
    mesh.corner_normals.insert(mesh.corner_normals.end(), {{n[0], n[1], n[2]}, {n[0], n[2], n[3]}});
  };
  for (std::uint32_t i = 0; i + 1 < points.size(); ++i) {
    const std::uint32_t a = 4 * i, b = a + 4, left = 5 + 2 * i + 1, right = 5 + 2 * (i + 1);
    add_quad({a, b, b + 1, a + 1}, {left, right, right, left});  // front
    add_quad({a + 3, b + 3, b + 2, a + 2}, {0, 0, 0, 0});        // back
    add_quad({a + 2, b + 2, b, a}, {1, 1, 1, 1});                // bottom
    add_quad({a + 1, b + 1, b + 3, a + 3}, {2, 2, 2, 2});        // top
  }
  const auto end = static_cast<std::uint32_t>(mesh.vertices.size());
  add_quad({2, 0, 1, 3}, {3, 3, 3, 3});
  add_quad({end - 4, end - 2, end - 1, end - 3}, {4, 4, 4, 4});
  close_mesh(mesh);
  return body;
}

}  // namespace translucube

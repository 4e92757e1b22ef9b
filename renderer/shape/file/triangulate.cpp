#include <algorithm>
#include <cmath>
#include <numeric>

#include "renderer/shape/file/polygon_mesh.h"

namespace translucube {
namespace {

struct Point {
  double x, y;
};

/// Twice the area of a triangle, positive counter-clockwise.
double turn(Point a, Point b, Point c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// A polygon as seen along its normal (Newell's, Sutherland et al. 1974); nothing where it has no
/// area.
std::vector<Point> project(const PolygonMesh& mesh, std::span<const std::uint32_t> face) {
  const Vec3 origin = mesh.vertices[face[0]];
  Vec3 normal;
  for (std::size_t i = 0; i < face.size(); ++i)
    normal = normal + cross(mesh.vertices[face[i]] - origin,
                            mesh.vertices[face[(i + 1) % face.size()]] - origin);
  if (length_squared(normal) == 0) return {};
  const Frame frame(normalize(normal));
  std::vector<Point> points;
  points.reserve(face.size());
  for (const std::uint32_t v : face) {
    const Vec3 p = mesh.vertices[v] - origin;
    points.push_back({dot(p, frame.x), dot(p, frame.y)});
  }
  return points;
}

/// Cuts one triangle after the other off a polygon.
class EarClipper {
 public:
  EarClipper(std::vector<Point> points, std::vector<Triangle>& out)
      : points_(std::move(points)), out_(out) {
    left_.resize(points_.size());
    std::iota(left_.begin(), left_.end(), 0u);
  }

  /// False where the polygon crosses itself.
  bool clip() {
    if (crosses_itself()) return false;
    while (left_.size() > 3) {
      const std::size_t ear = find_ear();
      if (ear == left_.size()) return false;
      take(ear);
    }
    take(0);
    return true;
  }

 private:
  /// Whether two sides cross within both. Sides that touch or coincide, as at the bridge to a hole,
  /// do not.
  bool crosses_itself() const {
    const std::size_t n = points_.size();
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 2; j < n; ++j) {
        const Point a = points_[i], b = points_[i + 1], c = points_[j], d = points_[(j + 1) % n];
        if (turn(a, b, c) * turn(a, b, d) < 0 && turn(c, d, a) * turn(c, d, b) < 0) return true;
      }
    return false;
  }

  std::uint32_t corner(std::size_t i, std::size_t step) const {
    return left_[(i + step) % left_.size()];
  }

  /// Where the corner after the one found is an ear; of no area only where there is no other.
  std::size_t find_ear() const {
    std::size_t flat = left_.size();
    for (std::size_t i = 0; i < left_.size(); ++i) {
      const double size = turn(at(i, 0), at(i, 1), at(i, 2));
      if (size < 0 || blocked(i)) continue;
      if (size > 0) return i;
      flat = i;
    }
    return flat;
  }

  Point at(std::size_t i, std::size_t step) const { return points_[corner(i, step)]; }

  bool blocked(std::size_t i) const {
    const Point a = at(i, 0), b = at(i, 1), c = at(i, 2);
    const auto same = [](Point p, Point q) { return p.x == q.x && p.y == q.y; };
    for (std::size_t step = 3; step < left_.size(); ++step) {
      const Point p = at(i, step);
      // A bridge to a hole passes its corners twice.
      if (same(p, a) || same(p, b) || same(p, c)) continue;
      if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return true;
    }
    return false;
  }

  void take(std::size_t i) {
    out_.push_back({corner(i, 0), corner(i, 1), corner(i, 2)});
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>((i + 1) % left_.size()));
  }

  std::vector<Point> points_;
  std::vector<std::uint32_t> left_;
  std::vector<Triangle>& out_;
};

bool is_convex(std::span<const Point> points) {
  const std::size_t n = points.size();
  double around = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Point a = points[i], b = points[(i + 1) % n], c = points[(i + 2) % n];
    const double bend = turn(a, b, c);
    if (bend <= 0) return false;
    around += std::atan2(bend, (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y));
  }
  return around < 7;  // once around: 2 pi; a star goes around twice
}

/// Coordinates that were stored too coarsely are not those that somebody meant.
void check_rounding(const PolygonMesh& mesh) {
  constexpr double largest_share = 1e-5;
  Vec3 low = mesh.vertices[0], high = low;
  double largest = 0;
  for (const Vec3& v : mesh.vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
    largest = std::max({largest, std::fabs(v.x), std::fabs(v.y), std::fabs(v.z)});
  }
  const double extent = 0.5 * length(high - low);
  if (largest * mesh.rounding > largest_share * extent)
    throw MeshError("coordinates of up to " + std::to_string(largest) + " are stored in steps of " +
                    std::to_string(2 * largest * mesh.rounding) +
                    ", too coarse for a mesh of radius " + std::to_string(extent) +
                    ": move it to the origin, or store them in double precision");
}

}  // namespace

TriangleMesh triangulate(const PolygonMesh& polygons) {
  check_rounding(polygons);
  TriangleMesh mesh;
  mesh.vertices = polygons.vertices;
  mesh.normals = polygons.normals;
  std::vector<Triangle> ears;
  for (std::size_t f = 0; f < polygons.faces(); ++f) {
    const std::span<const std::uint32_t> face = polygons.face(f),
                                         normals = polygons.face_normals(f);
    const auto add = [&](const Triangle& t) {
      mesh.triangles.push_back({face[t[0]], face[t[1]], face[t[2]]});
      if (!normals.empty())
        mesh.corner_normals.push_back({normals[t[0]], normals[t[1]], normals[t[2]]});
    };
    std::vector<Point> points;
    if (face.size() > 3) points = project(polygons, face);
    // What has no area keeps its edges as a fan; what is convex is one anyway.
    if (points.empty() || is_convex(points)) {
      for (std::uint32_t i = 1; i + 1 < face.size(); ++i) add({0, i, i + 1});
      continue;
    }
    ears.clear();
    if (!EarClipper(std::move(points), ears).clip())
      throw MeshError(std::string(polygons.place) + " " + std::to_string(polygons.places[f]) +
                      ": the outline of the face crosses itself");
    for (const Triangle& ear : ears) add(ear);
  }
  return mesh;
}

}  // namespace translucube

#include "renderer/shape/mesh_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <sstream>

#include "renderer/shape/bounding_box.h"
#include "renderer/shape/mesh_collision.h"
#include "renderer/shape/triangle_pair.h"

namespace translucube {
namespace {

struct Part {
  std::vector<std::uint32_t> triangles;
  BoundingBox box;
  double volume = 0;
  int orientation = 1;                 ///< 1: normals outward
  std::vector<std::uint32_t> holders;  ///< the parts that it lies in
};

class Parts {
 public:
  explicit Parts(TriangleMesh& mesh) : mesh_(mesh) {}

  /// How many there are.
  std::size_t unite() {
    find();
    refuse_meetings();
    for (const Part& part : parts_)
      if (part.volume == 0)
        throw MeshError("part " + name(&part) + " of the mesh encloses no volume");
    if (parts_.size() == 1 && parts_[0].volume > 0) return 1;
    nest();
    std::vector<Triangle> boundary, normals;
    boundary.reserve(mesh_.triangles.size());
    normals.reserve(mesh_.corner_normals.size());
    for (const Part& part : parts_) keep(part, boundary, normals);
    mesh_.triangles = std::move(boundary);
    mesh_.corner_normals = std::move(normals);
    return parts_.size();
  }

 private:
  Corners corners(std::uint32_t t) const {
    const Triangle& v = mesh_.triangles[t];
    return {mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]]};
  }

  /// Triangles that share an edge are of one part.
  void find() {
    const auto count = static_cast<std::uint32_t>(mesh_.triangles.size());
    std::vector<std::uint32_t> parent(count);
    std::iota(parent.begin(), parent.end(), 0u);
    const auto root = [&](std::uint32_t i) {
      while (parent[i] != i) i = parent[i] = parent[parent[i]];
      return i;
    };
    struct Edge {
      std::uint32_t low, high, triangle;
    };
    std::vector<Edge> edges;
    edges.reserve(3 * std::size_t{count});
    for (std::uint32_t t = 0; t < count; ++t)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [low, high] =
            std::minmax(mesh_.triangles[t][i], mesh_.triangles[t][(i + 1) % 3]);
        edges.push_back({low, high, t});
      }
    std::ranges::sort(edges, {}, [](const Edge& e) { return std::pair(e.low, e.high); });
    for (std::size_t i = 1; i < edges.size(); ++i)
      if (edges[i].low == edges[i - 1].low && edges[i].high == edges[i - 1].high) {
        const std::uint32_t a = root(edges[i].triangle), b = root(edges[i - 1].triangle);
        parent[std::max(a, b)] = std::min(a, b);
      }
    part_of_.resize(count);
    for (std::uint32_t t = 0; t < count; ++t) {
      const std::uint32_t r = root(t);
      if (r == t) {
        part_of_[t] = static_cast<std::uint32_t>(parts_.size());
        parts_.emplace_back();
      } else {
        part_of_[t] = part_of_[r];  // the root is the first of its part
      }
      parts_[part_of_[t]].triangles.push_back(t);
    }
    for (Part& part : parts_) measure(part);
  }

  void measure(Part& part) const {
    double six = 0;
    const Vec3 origin = corners(part.triangles[0])[0];
    for (const std::uint32_t t : part.triangles) {
      const auto [a, b, c] = corners(t);
      for (const Vec3 p : {a, b, c}) part.box.add(p);
      six += dot(a - origin, cross(b - origin, c - origin));
    }
    part.volume = six / 6;
    part.orientation = part.volume < 0 ? -1 : 1;
  }

  std::string name(const Part* part) const {
    const Vec3 p = corners(part->triangles[0])[0];
    std::ostringstream text;
    text << part - parts_.data() + 1 << " (with the vertex " << p.x << " " << p.y << " " << p.z
         << ")";
    return text.str();
  }

  void refuse_meetings() const {
    const auto meeting = find_meeting(mesh_, part_of_);
    if (!meeting) return;
    const auto [first, second] = std::minmax(part_of_[meeting->first], part_of_[meeting->second]);
    std::ostringstream text;
    if (first == second)
      text << "the surface of the mesh crosses itself";
    else
      text << "parts " << name(&parts_[first]) << " and " << name(&parts_[second])
           << " of the mesh meet";
    const Vec3 p = meeting->place;
    text << " near " << p.x << " " << p.y << " " << p.z << ": "
         << (first == second ? "repair it" : "unite them") << " in the program that made "
         << (first == second ? "it" : "them");
    throw MeshError(text.str());
  }

  /// Which part lies in which. By x, so that parts far from each other never meet.
  void nest() {
    std::vector<std::uint32_t> order(parts_.size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, [&](std::uint32_t i) { return parts_[i].box.low.x; });
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t j = i + 1; j < order.size(); ++j) {
        Part &a = parts_[order[i]], &b = parts_[order[j]];
        if (b.box.low.x > a.box.high.x) break;
        if (!a.box.meets(b.box)) continue;
        if (a.box.holds(b.box) && holds(a, b)) b.holders.push_back(order[i]);
        if (b.box.holds(a.box) && holds(b, a)) a.holders.push_back(order[j]);
      }
  }

  /// Whether a vertex of a part, which touches the other nowhere, lies in it: by the solid angle
  /// (Van Oosterom and Strackee 1983).
  bool holds(const Part& outer, const Part& inner) const {
    const Vec3 p = corners(inner.triangles[0])[0];
    double solid_angle = 0;
    for (const std::uint32_t t : outer.triangles) {
      const auto [x, y, z] = corners(t);
      const Vec3 a = x - p, b = y - p, c = z - p;
      const double r = length(a), s = length(b), q = length(c);
      solid_angle += 2 * std::atan2(dot(a, cross(b, c)),
                                    r * s * q + dot(a, b) * q + dot(b, c) * r + dot(c, a) * s);
    }
    return std::fabs(solid_angle) > 2 * std::numbers::pi;
  }

  void keep(const Part& part, std::vector<Triangle>& boundary,
            std::vector<Triangle>& normals) const {
    // All that lies in one outermost part is oriented as that one is.
    int outermost = part.orientation;
    for (const std::uint32_t h : part.holders)
      if (parts_[h].holders.empty()) outermost = parts_[h].orientation;
    int around = 0;  // the winding number just outside
    for (const std::uint32_t h : part.holders) around += outermost * parts_[h].orientation;
    const int within = around + outermost * part.orientation;
    if ((around != 0) == (within != 0)) return;
    const bool outward = part.orientation > 0, wanted = within != 0;
    for (const std::uint32_t t : part.triangles) {
      Triangle v = mesh_.triangles[t];
      if (outward != wanted) std::swap(v[1], v[2]);
      boundary.push_back(v);
      if (mesh_.corner_normals.empty()) continue;
      Triangle n = mesh_.corner_normals[t];
      if (outward != wanted) std::swap(n[1], n[2]);
      normals.push_back(n);
    }
  }

  TriangleMesh& mesh_;
  std::vector<Part> parts_;
  std::vector<std::uint32_t> part_of_;  ///< of each triangle
};

}  // namespace

std::size_t unite_parts(TriangleMesh& mesh) { return Parts(mesh).unite(); }

}  // namespace translucube

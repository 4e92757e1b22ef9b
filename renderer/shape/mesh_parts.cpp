#include "renderer/shape/mesh_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <span>
#include <sstream>

namespace translucube {
namespace {

struct Box {
  Vec3 low{infinity, infinity, infinity}, high{-infinity, -infinity, -infinity};

  void add(Vec3 p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  void add(const Box& b) {
    add(b.low);
    add(b.high);
  }
  bool meets(const Box& b) const {
    return low.x <= b.high.x && b.low.x <= high.x && low.y <= b.high.y && b.low.y <= high.y &&
           low.z <= b.high.z && b.low.z <= high.z;
  }
  bool holds(const Box& b) const {
    return low.x <= b.low.x && b.high.x <= high.x && low.y <= b.low.y && b.high.y <= high.y &&
           low.z <= b.low.z && b.high.z <= high.z;
  }
  static constexpr double infinity = std::numeric_limits<double>::infinity();
};

struct Part {
  std::vector<std::uint32_t> triangles;
  Box box;
  double volume = 0;
  int orientation = 1;                 ///< 1: normals outward
  std::vector<std::uint32_t> holders;  ///< the parts that it lies in
};

class Parts {
 public:
  explicit Parts(TriangleMesh& mesh) : mesh_(mesh) {}

  std::size_t unite() {
    find();
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
  using Corners = std::array<Vec3, 3>;
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
    std::vector<std::uint32_t> part_of(count);
    for (std::uint32_t t = 0; t < count; ++t) {
      const std::uint32_t r = root(t);
      if (r == t) {
        part_of[t] = static_cast<std::uint32_t>(parts_.size());
        parts_.emplace_back();
      } else {
        part_of[t] = part_of[r];  // the root is the first of its part
      }
      parts_[part_of[t]].triangles.push_back(t);
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
    if (part.volume == 0)
      throw MeshError("part " + name(&part) + " of the mesh encloses no volume");
  }

  std::string name(const Part* part) const {
    const Vec3 p = corners(part->triangles[0])[0];
    std::ostringstream text;
    text << part - parts_.data() + 1 << " (with the vertex " << p.x << " " << p.y << " " << p.z
         << ")";
    return text.str();
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
        if (Collision(*this, a, b).found())
          throw MeshError("parts " + name(std::min(&a, &b)) + " and " + name(std::max(&a, &b)) +
                          " of the mesh meet: unite them in the program that made them");
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

  /// Whether the surfaces of two parts meet: both divided at once, as long as their boxes meet.
  class Collision {
   public:
    Collision(const Parts& parts, const Part& a, const Part& b) : parts_(parts) {
      std::vector<std::uint32_t> as, bs;
      for (const std::uint32_t t : a.triangles)
        if (box_of(t).meets(b.box)) as.push_back(t);
      for (const std::uint32_t t : b.triangles)
        if (box_of(t).meets(a.box)) bs.push_back(t);
      found_ = meet(as, bs, 0);
    }
    bool found() const { return found_; }

   private:
    Box box_of(std::uint32_t t) const {
      Box box;
      for (const Vec3 p : parts_.corners(t)) box.add(p);
      return box;
    }

    bool meet(std::vector<std::uint32_t> as, std::vector<std::uint32_t> bs, int depth) const {
      if (as.empty() || bs.empty()) return false;
      constexpr std::size_t few = 16;
      constexpr int deepest = 60;
      if (as.size() + bs.size() <= few || depth == deepest) return any_pair(as, bs);
      Box box;
      for (const std::uint32_t t : as.size() > bs.size() ? as : bs) box.add(box_of(t));
      const Vec3 size = box.high - box.low;
      const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
      const auto along = [axis](Vec3 p) { return axis == 0 ? p.x : axis == 1 ? p.y : p.z; };
      const double middle = 0.5 * (along(box.low) + along(box.high));
      std::array<std::vector<std::uint32_t>, 2> a_of, b_of;
      const auto sort_into = [&](const auto& from, auto& to) {
        for (const std::uint32_t t : from) {
          const Box b = box_of(t);
          if (along(b.low) <= middle) to[0].push_back(t);
          if (along(b.high) >= middle) to[1].push_back(t);
        }
      };
      sort_into(as, a_of);
      sort_into(bs, b_of);
      const auto shrinks = [&](int side) {
        return a_of[side].size() + b_of[side].size() < as.size() + bs.size();
      };
      if (!shrinks(0) && !shrinks(1)) return any_pair(as, bs);
      return meet(std::move(a_of[0]), std::move(b_of[0]), depth + 1) ||
             meet(std::move(a_of[1]), std::move(b_of[1]), depth + 1);
    }

    bool any_pair(std::span<const std::uint32_t> as, std::span<const std::uint32_t> bs) const {
      for (const std::uint32_t a : as)
        for (const std::uint32_t b : bs)
          if (box_of(a).meets(box_of(b)) && triangles_meet(parts_.corners(a), parts_.corners(b)))
            return true;
      return false;
    }

    /// By separating axes (Gottschalk 1996): both normals, the nine products of edges, and in a
    /// common plane the sides.
    static bool triangles_meet(const Corners& a, const Corners& b) {
      std::array<Vec3, 3> e{a[1] - a[0], a[2] - a[1], a[0] - a[2]},
          f{b[1] - b[0], b[2] - b[1], b[0] - b[2]};
      const Vec3 n = cross(e[0], e[1]), m = cross(f[0], f[1]);
      const auto apart = [&](Vec3 axis) {
        if (length_squared(axis) == 0) return false;
        double a_low = Box::infinity, a_high = -a_low, b_low = a_low, b_high = a_high;
        for (const Vec3& p : a) {
          const double x = dot(p - a[0], axis);
          a_low = std::min(a_low, x), a_high = std::max(a_high, x);
        }
        for (const Vec3& p : b) {
          const double x = dot(p - a[0], axis);
          b_low = std::min(b_low, x), b_high = std::max(b_high, x);
        }
        return a_high < b_low || b_high < a_low;
      };
      if (apart(n) || apart(m)) return false;
      for (const Vec3& x : e) {
        if (apart(cross(n, x))) return false;
        for (const Vec3& y : f)
          if (apart(cross(x, y))) return false;
      }
      for (const Vec3& y : f)
        if (apart(cross(m, y))) return false;
      return true;
    }

    const Parts& parts_;
    bool found_ = false;
  };

  TriangleMesh& mesh_;
  std::vector<Part> parts_;
};

}  // namespace

std::size_t unite_parts(TriangleMesh& mesh) { return Parts(mesh).unite(); }

}  // namespace translucube

#include "renderer/shape/mesh_collision.h"

#include <algorithm>
#include <numeric>
#include <vector>

#include "renderer/shape/bounding_box.h"
#include "renderer/shape/oriented_box.h"
#include "renderer/shape/triangle_pair.h"

namespace translucube {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

/// A vertex of more triangles is a hub: the boxes of its triangles all meet in it, and to look at
/// all pairs of them would take the square of their number.
constexpr std::uint32_t many = 256;

/// Of the directions in which a triangle lies from its corner: the arc from u to v, which is within
/// its chord and its tangents.
BoundingBox box_of_arc(Vec3 u, Vec3 v) {
  BoundingBox box;
  if (u == Vec3{} || v == Vec3{}) return box;
  u = direction_of(u);
  v = direction_of(v);
  for (const Vec3& p : {u, v}) box.add(p);
  const double cosine = dot(u, v);
  constexpr double nearly_opposite = -0.99;
  if (cosine < nearly_opposite) return {{-1, -1, -1}, {1, 1, 1}};
  box.add((u + v) * (1 / (1 + cosine)));
  return box;
}

/// Larger nodes have no oriented box: it takes a look at all their triangles, and tells little.
constexpr std::uint32_t most_oriented = 4096;

/// A binary tree of boxes over the triangles. Those of a hub are a tree of their own: against
/// others by their boxes, against each other by the boxes of their directions from the hub.
class Search {
 public:
  Search(const TriangleMesh& mesh, std::span<const std::uint32_t> part_of)
      : mesh_(mesh), part_of_(part_of), order_(mesh.triangles.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    boxes_.reserve(order_.size());
    for (std::uint32_t t = 0; t < order_.size(); ++t) boxes_.push_back(box_of(t));
    const std::vector<std::uint32_t> hubs = hubs_of_triangles();
    std::ranges::stable_sort(order_, {}, [&](std::uint32_t t) { return hubs[t]; });
    for (std::uint32_t begin = 0, end = 0; begin < order_.size(); begin = end) {
      const std::uint32_t hub = hubs[order_[begin]];
      while (end < order_.size() && hubs[order_[end]] == hub) ++end;
      roots_.push_back({build(begin, end), hub});
      orient(roots_.back().node);
    }
  }

  std::optional<Meeting> find() {
    for (std::size_t i = 0; i < roots_.size(); ++i) {
      if (roots_[i].hub == none && within(roots_[i].node)) return found_;
      for (std::size_t j = i + 1; j < roots_.size(); ++j)
        if (between(roots_[i].node, roots_[j].node)) return found_;
    }
    for (const auto& [node, hub] : roots_)
      if (hub != none && within(tree_of_directions(hub, nodes_[node].begin, nodes_[node].end)))
        return found_;
    return std::nullopt;
  }

 private:
  struct Node {
    BoundingBox box;
    std::uint32_t begin = 0, end = 0;         ///< in `order_`
    std::uint32_t left = none, right = none;  ///< none: a leaf
    std::optional<OrientedBox> oriented{};
    bool is_leaf() const { return left == none; }
  };
  struct Root {
    std::uint32_t node = 0, hub = none;  ///< that all its triangles share
  };

  Corners corners(std::uint32_t t) const {
    const Triangle& v = mesh_.triangles[t];
    return {mesh_.vertices[v[0]], mesh_.vertices[v[1]], mesh_.vertices[v[2]]};
  }

  std::vector<std::uint32_t> hubs_of_triangles() const {
    std::vector<std::uint32_t> uses(mesh_.vertices.size()), hubs(mesh_.triangles.size(), none);
    for (const Triangle& t : mesh_.triangles)
      for (const std::uint32_t v : t) ++uses[v];
    for (std::size_t t = 0; t < hubs.size(); ++t) {
      const std::uint32_t most =
          std::ranges::max(mesh_.triangles[t], {}, [&](std::uint32_t v) { return uses[v]; });
      if (uses[most] > many) hubs[t] = most;
    }
    return hubs;
  }

  std::uint32_t build(std::uint32_t begin, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back({{}, begin, end});
    BoundingBox box, centers;
    for (std::uint32_t i = begin; i < end; ++i) {
      box.add(boxes_[order_[i]]);
      centers.add(boxes_[order_[i]].center());
    }
    nodes_[index].box = box;
    constexpr std::uint32_t few = 4;
    if (end - begin <= few) return index;
    const Vec3 size = centers.high - centers.low;
    const auto axis = size.x >= size.y && size.x >= size.z ? &Vec3::x
                      : size.y >= size.z                   ? &Vec3::y
                                                           : &Vec3::z;
    const std::uint32_t middle = begin + (end - begin) / 2;
    std::ranges::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                             {}, [&](std::uint32_t t) { return boxes_[t].center().*axis; });
    const std::uint32_t left = build(begin, middle), right = build(middle, end);
    nodes_[index].left = left;
    nodes_[index].right = right;
    return index;
  }

  /// All nodes from one on, where they are not too large.
  void orient(std::uint32_t index) {
    Node& node = nodes_[index];
    if (node.end - node.begin <= most_oriented) {
      std::vector<Corners> triangles;
      triangles.reserve(node.end - node.begin);
      for (std::uint32_t i = node.begin; i < node.end; ++i) triangles.push_back(corners(order_[i]));
      node.oriented = OrientedBox::around(triangles);
    }
    if (node.is_leaf()) return;
    orient(node.left);
    orient(node.right);
  }

  std::uint32_t tree_of_directions(std::uint32_t hub, std::uint32_t begin, std::uint32_t end) {
    for (std::uint32_t i = begin; i < end; ++i) {
      const Triangle& t = mesh_.triangles[order_[i]];
      const std::size_t at = t[0] == hub ? 0 : t[1] == hub ? 1 : 2;
      const auto from_hub = [&](std::size_t step) {
        return mesh_.vertices[t[(at + step) % 3]] - mesh_.vertices[hub];
      };
      boxes_[order_[i]] = box_of_arc(from_hub(1), from_hub(2));
    }
    return build(begin, end);
  }

  bool within(std::uint32_t index) {
    const Node& node = nodes_[index];
    if (!node.is_leaf())
      return within(node.left) || within(node.right) || between(node.left, node.right);
    for (std::uint32_t i = node.begin; i < node.end; ++i)
      for (std::uint32_t j = i + 1; j < node.end; ++j)
        if (meet(order_[i], order_[j])) return true;
    return false;
  }

  bool between(std::uint32_t first, std::uint32_t second) {
    const Node &a = nodes_[first], &b = nodes_[second];
    if (!a.box.meets(b.box)) return false;
    if (a.oriented && b.oriented && a.oriented->apart(*b.oriented)) return false;
    if (a.is_leaf() && b.is_leaf()) {
      for (std::uint32_t i = a.begin; i < a.end; ++i)
        for (std::uint32_t j = b.begin; j < b.end; ++j)
          if (meet(order_[i], order_[j])) return true;
      return false;
    }
    if (b.is_leaf() || (!a.is_leaf() && a.end - a.begin >= b.end - b.begin))
      return between(a.left, second) || between(a.right, second);
    return between(first, b.left) || between(first, b.right);
  }

  bool meet(std::uint32_t s, std::uint32_t t) {
    if (!boxes_[s].meets(boxes_[t])) return false;
    const TrianglePair pair(corners(s), corners(t));
    if (part_of_[s] == part_of_[t] ? !pair.cross() : !pair.touch()) return false;
    found_ = {std::min(s, t), std::max(s, t), place_of(s, t)};
    return true;
  }

  BoundingBox box_of(std::uint32_t t) const {
    BoundingBox box;
    for (const Vec3& p : corners(t)) box.add(p);
    return box;
  }

  /// The middle of what their boxes have in common.
  Vec3 place_of(std::uint32_t s, std::uint32_t t) const {
    const BoundingBox a = box_of(s), b = box_of(t);
    const auto middle = [&](double Vec3::*x) {
      return 0.5 * std::max(a.low.*x, b.low.*x) + 0.5 * std::min(a.high.*x, b.high.*x);
    };
    return {middle(&Vec3::x), middle(&Vec3::y), middle(&Vec3::z)};
  }

  const TriangleMesh& mesh_;
  const std::span<const std::uint32_t> part_of_;
  std::vector<std::uint32_t> order_;  ///< triangles
  std::vector<BoundingBox> boxes_;
  std::vector<Node> nodes_;
  std::vector<Root> roots_;
  Meeting found_;
};

}  // namespace

std::optional<Meeting> find_meeting(const TriangleMesh& mesh,
                                    std::span<const std::uint32_t> part_of) {
  return Search(mesh, part_of).find();
}

}  // namespace translucube

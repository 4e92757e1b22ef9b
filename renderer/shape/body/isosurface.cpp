#include "renderer/shape/body/isosurface.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

namespace translucube {
namespace {

constexpr std::uint32_t block_cells = 4;

class Polygonizer {
 public:
  Polygonizer(const DistanceField& field, Vec3 low, double cell,
              const std::array<std::uint32_t, 3>& cells)
      : field_(field), low_(low), cell_(cell), cells_(cells) {
    values_.assign(std::size_t{cells[0] + 1} * (cells[1] + 1) * (cells[2] + 1), unknown);
  }

  TriangleMesh make() {
    std::uint32_t size = block_cells;
    while (size < std::ranges::max(cells_)) size *= 2;
    search({0, 0, 0}, size, field_.all());
    mesh_.corner_normals = mesh_.triangles;
    return std::move(mesh_);
  }

 private:
  using Place = std::array<std::uint32_t, 3>;
  static constexpr float unknown = std::numeric_limits<float>::infinity();

  Vec3 corner(const Place& p) const {
    return low_ + cell_ * Vec3{1.0 * p[0], 1.0 * p[1], 1.0 * p[2]};
  }
  std::uint32_t index(const Place& p) const {
    return p[0] + (cells_[0] + 1) * (p[1] + (cells_[1] + 1) * p[2]);
  }
  static Place shifted(const Place& p, std::uint32_t bits) {
    return {p[0] + (bits & 1), p[1] + (bits >> 1 & 1), p[2] + (bits >> 2 & 1)};
  }

  float value(const Place& p) {
    float& known = values_[index(p)];
    if (known == unknown) known = static_cast<float>(field_.at(corner(p), near_).value);
    return known;
  }

  /// Finds the surface in a cube of so many cells, by halves.
  void search(const Place& from, std::uint32_t size, const DistanceField::Selection& parts) {
    for (std::size_t i = 0; i < 3; ++i)
      if (from[i] >= cells_[i]) return;
    const double half = 0.5 * size * cell_, reach = std::sqrt(3.0) * half;
    const Vec3 center = corner(from) + half * Vec3{1, 1, 1};
    // Distances change by hardly more than the way gone.
    constexpr double safety = 1.2;
    if (std::fabs(field_.at(center, parts).value) > safety * reach) return;
    DistanceField::Selection nearer = field_.near(center, reach, parts);
    if (size == block_cells) {
      near_ = std::move(nearer);
      add_block(from);
      return;
    }
    for (std::uint32_t i = 0; i < 8; ++i)
      search({from[0] + (i & 1) * size / 2, from[1] + (i >> 1 & 1) * size / 2,
              from[2] + (i >> 2 & 1) * size / 2},
             size / 2, nearer);
  }

  void add_block(const Place& from) {
    Place to;
    for (std::size_t i = 0; i < 3; ++i) to[i] = std::min(from[i] + block_cells, cells_[i]);
    for (std::uint32_t z = from[2]; z < to[2]; ++z)
      for (std::uint32_t y = from[1]; y < to[1]; ++y)
        for (std::uint32_t x = from[0]; x < to[0]; ++x) add_cell({x, y, z});
  }

  void add_cell(const Place& place) {
    std::array<float, 8> values;
    unsigned within = 0;
    for (std::uint32_t i = 0; i < 8; ++i) {
      values[i] = value(shifted(place, i));
      within += values[i] < 0;
    }
    if (within == 0 || within == 8) return;
    // Along x, y, z in any order; the last two are exchanged where that turns the tetrahedron
    // round.
    constexpr std::uint32_t tetrahedra[6][4] = {{0, 1, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7},
                                                {0, 1, 7, 5}, {0, 2, 7, 3}, {0, 4, 7, 6}};
    for (const auto& tetrahedron : tetrahedra) add_tetrahedron(place, values, tetrahedron);
  }

  void add_tetrahedron(const Place& place, const std::array<float, 8>& values,
                       const std::uint32_t (&at)[4]) {
    unsigned inside = 0, count = 0;
    for (unsigned i = 0; i < 4; ++i)
      if (values[at[i]] < 0) inside |= 1u << i, ++count;
    if (count == 0 || count == 4) return;
    const auto vertex = [&](unsigned i, unsigned j) {
      return crossing(place, values, at[i], at[j]);
    };
    const auto add = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      mesh_.triangles.push_back({a, b, c});
    };
    if (count == 2) {
      // Even permutations that begin with the two that are inside.
      constexpr unsigned pairs[6][4] = {{0, 1, 2, 3}, {0, 2, 3, 1}, {0, 3, 1, 2},
                                        {1, 2, 0, 3}, {1, 3, 2, 0}, {2, 3, 0, 1}};
      for (const auto& [i, j, k, l] : pairs) {
        if (inside != (1u << i | 1u << j)) continue;
        const std::uint32_t jk = vertex(j, k), ik = vertex(i, k), il = vertex(i, l),
                            jl = vertex(j, l);
        add(jk, ik, il);
        add(jk, il, jl);
      }
      return;
    }
    const unsigned alone = count == 1 ? inside : ~inside & 15u;
    constexpr unsigned first[4][4] = {{0, 1, 2, 3}, {1, 0, 3, 2}, {2, 3, 0, 1}, {3, 2, 1, 0}};
    for (const auto& [i, j, k, l] : first) {
      if (alone != 1u << i) continue;
      const std::uint32_t a = vertex(i, j), b = vertex(i, k), c = vertex(i, l);
      if (count == 1)
        add(a, b, c);
      else
        add(a, c, b);
    }
  }

  /// The vertex on an edge between two corners of a cell; each of its tetrahedra gets the same.
  std::uint32_t crossing(const Place& place, const std::array<float, 8>& values, std::uint32_t i,
                         std::uint32_t j) {
    if (i > j) std::swap(i, j);
    const Place from = shifted(place, i), to = shifted(place, j);
    const std::uint64_t key = std::uint64_t{index(from)} << 32 | index(to);
    const auto [entry, fresh] =
        vertices_.try_emplace(key, static_cast<std::uint32_t>(mesh_.vertices.size()));
    if (fresh) add_vertex(corner(from), corner(to), values[i], values[j]);
    return entry->second;
  }

  /// Where the edge crosses the surface, by Newton's method between bounds. It stays on its edge,
  /// so that no two tetrahedra's triangles meet but where these do.
  void add_vertex(Vec3 from, Vec3 to, double at_from, double at_to) {
    constexpr double margin = 1e-3, near_enough = 1e-5;
    constexpr int most_steps = 8;
    double low = 0, high = 1, t = at_from / (at_from - at_to);
    Distance found{};
    for (int i = 0; i < most_steps; ++i) {
      found = field_.at((1 - t) * from + t * to, near_);
      if (std::fabs(found.value) < near_enough * cell_) break;
      ((found.value < 0) == (at_from < 0) ? low : high) = t;
      const double next = t - found.value / dot(found.gradient, to - from);
      t = next > low && next < high ? next : 0.5 * (low + high);
    }
    t = std::clamp(t, margin, 1 - margin);
    mesh_.vertices.push_back((1 - t) * from + t * to);
    mesh_.normals.push_back(unit_or_zero(found.gradient));
  }

  const DistanceField& field_;
  Vec3 low_;
  double cell_;
  std::array<std::uint32_t, 3> cells_;
  std::vector<float> values_;
  DistanceField::Selection near_;
  std::unordered_map<std::uint64_t, std::uint32_t> vertices_;
  TriangleMesh mesh_;
};

}  // namespace

TriangleMesh isosurface(const DistanceField& field, Vec3 low, double cell,
                        const std::array<std::uint32_t, 3>& cells) {
  return Polygonizer(field, low, cell, cells).make();
}

}  // namespace translucube

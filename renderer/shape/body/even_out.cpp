#include "renderer/shape/body/even_out.h"

#include <algorithm>

#include "renderer/shape/mesh_collision.h"

namespace translucube {
namespace {

class Evener {
 public:
  /// `fixed`: vertices whose triangles stay as they are.
  Evener(TriangleMesh& mesh, double shortest, const std::vector<bool>& fixed)
      : mesh_(mesh), shortest2_(shortest * shortest), fixed_(fixed), around_(mesh.vertices.size()) {
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
      for (const std::uint32_t v : mesh.triangles[t]) around_[v].push_back(t);
    gone_.assign(mesh.triangles.size(), false);
  }

  void run() {
    constexpr int rounds = 4;
    for (int round = 1; round <= rounds; ++round) {
      // The shortest first, roughly.
      collapse(shortest2_ * round * round / (rounds * rounds));
      flip();
      flip();
    }
    std::size_t kept = 0;
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      if (!gone_[t]) mesh_.triangles[kept++] = mesh_.triangles[t];
    mesh_.triangles.resize(kept);
    mesh_.corner_normals = mesh_.triangles;
  }

 private:
  void collapse(double longest2) {
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      for (int k = 0; k < 3 && !gone_[t]; ++k) {
        const std::uint32_t u = mesh_.triangles[t][k], v = mesh_.triangles[t][(k + 1) % 3];
        if (fixed_[u] || fixed_[v] || length_squared(at(u) - at(v)) > longest2 ||
            !shares_two_neighbours(u, v))
          continue;
        if (may_move(v, u))
          move(v, u);
        else if (may_move(u, v))
          move(u, v);
      }
  }

  void flip() {
    for (std::uint32_t t = 0; t < mesh_.triangles.size(); ++t)
      for (int k = 0; k < 3 && !gone_[t]; ++k) flip(t, k);
  }

  void flip(std::uint32_t t, int k) {
    const std::uint32_t a = mesh_.triangles[t][k], b = mesh_.triangles[t][(k + 1) % 3],
                        c = mesh_.triangles[t][(k + 2) % 3];
    if (fixed_[a] || fixed_[b]) return;
    const auto beyond = std::ranges::find_if(around_[a], [&](std::uint32_t other) {
      return other != t && has(mesh_.triangles[other], b);
    });
    const std::uint32_t other = *beyond;
    std::uint32_t d = a;
    for (const std::uint32_t v : mesh_.triangles[other])
      if (v != a && v != b) d = v;
    // The angles that look at the edge, beyond 180 degrees together.
    if (!(cotangent(a, c, b) + cotangent(a, d, b) < -1e-6)) return;
    if (around_[a].size() <= 3 || around_[b].size() <= 3) return;
    collect_neighbours(d, of_u_);
    if (std::ranges::binary_search(of_u_, c)) return;
    const Triangle one{a, d, c}, two{d, b, c};
    if (!faces_its_normals(one) || !faces_its_normals(two)) return;
    mesh_.triangles[t] = one;
    mesh_.triangles[other] = two;
    std::erase(around_[a], other);
    std::erase(around_[b], t);
    around_[d].push_back(t);
    around_[c].push_back(other);
  }

  Vec3 at(std::uint32_t v) const { return mesh_.vertices[v]; }
  Vec3 area(const Triangle& t) const { return cross(at(t[1]) - at(t[0]), at(t[2]) - at(t[0])); }
  double cotangent(std::uint32_t u, std::uint32_t corner, std::uint32_t v) const {
    const Vec3 p = at(u) - at(corner), q = at(v) - at(corner);
    return dot(p, q) / std::max(length(cross(p, q)), 1e-30);
  }
  bool faces_its_normals(const Triangle& t) const {
    constexpr double least_cosine = 0.5;
    const Vec3 area = this->area(t);
    const double size = length(area);
    return std::ranges::all_of(t, [&](std::uint32_t v) {
      return size > 0 && dot(mesh_.normals[v], area) >= least_cosine * size;
    });
  }

  void collect_neighbours(std::uint32_t v, std::vector<std::uint32_t>& out) const {
    out.clear();
    for (const std::uint32_t t : around_[v])
      for (const std::uint32_t w : mesh_.triangles[t])
        if (w != v) out.push_back(w);
    std::ranges::sort(out);
    out.erase(std::unique(out.begin(), out.end()), out.end());
  }

  bool shares_two_neighbours(std::uint32_t u, std::uint32_t v) {
    collect_neighbours(u, of_u_);
    collect_neighbours(v, of_v_);
    common_.clear();
    std::ranges::set_intersection(of_u_, of_v_, std::back_inserter(common_));
    return common_.size() == 2 && of_u_.size() > 3 && of_v_.size() > 3;
  }

  static bool has(const Triangle& t, std::uint32_t v) {
    return t[0] == v || t[1] == v || t[2] == v;
  }

  /// Whether all triangles stay fair; those that are not may go on, as long as they do not grow.
  bool may_move(std::uint32_t from, std::uint32_t to) const {
    return std::ranges::all_of(around_[from], [&](std::uint32_t t) {
      Triangle moved = mesh_.triangles[t];
      if (has(moved, to)) return true;
      std::ranges::replace(moved, from, to);
      const Triangle& now = mesh_.triangles[t];
      // One that folds back would cross its neighbours.
      return fair(moved) || (!fair(now) && longest_squared(moved) <= longest_squared(now) &&
                             (faces_its_normals(moved) || !faces_its_normals(now)) &&
                             dot(area(moved), area(now)) >= 0);
    });
  }
  double longest_squared(const Triangle& t) const {
    return std::max({length_squared(at(t[0]) - at(t[1])), length_squared(at(t[1]) - at(t[2])),
                     length_squared(at(t[2]) - at(t[0]))});
  }
  bool fair(const Triangle& t) const {
    constexpr double least_sine = 0.15;
    return length(area(t)) >= least_sine * longest_squared(t) && faces_its_normals(t);
  }

  void move(std::uint32_t from, std::uint32_t to) {
    for (const std::uint32_t t : around_[from]) {
      Triangle& corners = mesh_.triangles[t];
      if (has(corners, to)) {
        gone_[t] = true;
        for (const std::uint32_t v : corners)
          if (v != from) std::erase(around_[v], t);
      } else {
        std::ranges::replace(corners, from, to);
        around_[to].push_back(t);
      }
    }
    around_[from].clear();
  }

  TriangleMesh& mesh_;
  double shortest2_;
  const std::vector<bool>& fixed_;
  std::vector<std::vector<std::uint32_t>> around_;  ///< the triangles of each vertex
  std::vector<bool> gone_;
  std::vector<std::uint32_t> of_u_, of_v_, common_;
};

}  // namespace

void even_out(TriangleMesh& mesh, double length) {
  constexpr int most_tries = 24;
  const TriangleMesh given = mesh;
  std::vector<bool> fixed(given.vertices.size());
  double radius = 4 * length;
  for (int i = 0; i < most_tries; ++i, radius *= 1.3) {
    Evener(mesh, length, fixed).run();
    const std::vector<std::uint32_t> one_part(mesh.triangles.size());
    const auto meeting = find_meeting(mesh, one_part);
    if (!meeting) return;
    for (std::size_t v = 0; v < fixed.size(); ++v)
      if (length_squared(given.vertices[v] - meeting->place) < radius * radius) fixed[v] = true;
    mesh = given;
  }
}

}  // namespace translucube

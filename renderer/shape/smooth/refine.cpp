#include "renderer/shape/smooth/refine.h"

#include <algorithm>
#include <cmath>

#include "renderer/shape/mesh_parts.h"
#include "renderer/shape/smooth/division.h"
#include "renderer/shape/smooth/normals.h"
#include "renderer/shape/smooth/tessellate.h"

namespace translucube {
namespace {

/// An edge of the mesh, from the lower to the higher vertex.
struct Edge {
  Curve curve;
  std::uint32_t parts = 1;  ///< chords
  double counts = 1;        ///< how much of its second derivative; less where it is short
};

/// An edge as a triangle sees it.
struct Side {
  std::uint32_t edge;
  bool forward;
};

class Refiner {
 public:
  explicit Refiner(TriangleMesh& mesh) : mesh_(mesh), radius_(bounding_radius(mesh)) {
    find_edges();
  }

  Refinement refine(const Fineness& wish, std::uint64_t most) {
    Refinement done{mesh_.triangles.size(), 0, wish.chord_error, false};
    least_side_ = wish.least_side * radius_;
    while ((done.made = divide(done.chord_error * radius_)) > std::max(most, done.given)) {
      done.limited = true;
      constexpr double coarser = 1.25;
      done.chord_error *= std::max(coarser, 0.5 * double(done.made) / double(most));
    }
    if (done.made > done.given) tessellate(done.chord_error * radius_, done.made);
    mesh_.normals.clear();
    mesh_.corner_normals.clear();
    return done;
  }

 private:
  void find_edges() {
    struct HalfEdge {
      std::uint32_t low, high, triangle, side;
    };
    std::vector<HalfEdge> halves;
    const auto count = static_cast<std::uint32_t>(mesh_.triangles.size());
    halves.reserve(3 * std::size_t{count});
    for (std::uint32_t t = 0; t < count; ++t)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const auto [low, high] =
            std::minmax(mesh_.triangles[t][k], mesh_.triangles[t][next_corner(k)]);
        halves.push_back({low, high, t, k});
      }
    std::ranges::sort(halves, {}, [](const HalfEdge& h) { return std::pair(h.low, h.high); });
    sides_.resize(count);
    edges_.reserve(halves.size() / 2);
    for (std::size_t i = 0; i + 1 < halves.size(); i += 2) {
      const auto edge = static_cast<std::uint32_t>(edges_.size());
      // A triangle's normals at the lower and the higher end.
      const auto normals_of = [&](const HalfEdge& h) {
        const CornerNormals n = corner_normals(mesh_, h.triangle);
        const bool forward = mesh_.triangles[h.triangle][h.side] == h.low;
        sides_[h.triangle][h.side] = {edge, forward};
        const Vec3 from = n[h.side], to = n[next_corner(h.side)];
        return forward ? std::pair(from, to) : std::pair(to, from);
      };
      const auto [low_a, high_a] = normals_of(halves[i]);
      const auto [low_b, high_b] = normals_of(halves[i + 1]);
      const Vec3 low = mesh_.vertices[halves[i].low], high = mesh_.vertices[halves[i].high];
      edges_.push_back({{{low, control_point(low, high, low_a, low_b),
                          control_point(high, low, high_a, high_b), high}}});
    }
  }

  /// Divides the edges so that no chord is further off; how many triangles that makes.
  std::uint64_t divide(double error) {
    for (Edge& edge : edges_) {
      const auto& p = edge.curve.points;
      const double bend = edge.curve.most_bend();
      const double most = std::ceil(length(p[3] - p[0]) / least_side_);
      edge.counts = std::fmin(1, 8 * error * most * most / bend);
      edge.parts = parts_of(edge.counts * bend, error);
    }
    std::uint64_t made = 0;
    for (const auto& sides : sides_) {
      const auto parts = [&](int i) { return edges_[sides[i].edge].parts; };
      made += Division{{parts(0), parts(1), parts(2)}, bends(sides)}.triangles(error);
    }
    return made;
  }

  Three<Vec3> bends(const Three<Side>& sides) const {
    const auto bend = [&](std::size_t i) {
      const Edge& edge = edges_[sides[i].edge];
      return edge.counts * edge.curve.bend();
    };
    return {bend(0), bend(1), bend(2)};
  }

  void tessellate(double error, std::uint64_t made) {
    const std::vector<Triangle> given = std::move(mesh_.triangles);
    mesh_.triangles.clear();
    mesh_.triangles.reserve(made);
    mesh_.vertices.reserve(made / 2 + 2 * mesh_.vertices.size());
    std::vector<std::uint32_t> first;
    first.reserve(edges_.size());
    for (const Edge& edge : edges_) {
      first.push_back(static_cast<std::uint32_t>(mesh_.vertices.size()));
      for (std::uint32_t i = 1; i < edge.parts; ++i)
        mesh_.vertices.push_back(edge.curve.at(double(i) / edge.parts));
    }
    Tessellator tessellator(mesh_, error);
    for (std::size_t t = 0; t < given.size(); ++t) {
      Three<Curve> curves;
      Piece piece{given[t], {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}}, {}, bends(sides_[t])};
      for (std::size_t k = 0; k < 3; ++k) {
        const auto [e, forward] = sides_[t][k];
        curves[k] = forward ? edges_[e].curve : edges_[e].curve.reversed();
        const Run run{first[e], 0, edges_[e].parts};
        piece.sides[k] = forward ? run : run.reversed();
      }
      tessellator.fill(Patch(curves), piece);
    }
  }

  TriangleMesh& mesh_;
  double radius_, least_side_ = 0;
  std::vector<Edge> edges_;
  std::vector<Three<Side>> sides_;
};

}  // namespace

double bounding_radius(const TriangleMesh& mesh) {
  Vec3 low = mesh.vertices[0], high = low;
  for (const Vec3& v : mesh.vertices) {
    low = {std::min(low.x, v.x), std::min(low.y, v.y), std::min(low.z, v.z)};
    high = {std::max(high.x, v.x), std::max(high.y, v.y), std::max(high.z, v.z)};
  }
  return 0.5 * length(high - low);
}

Refinement refine(TriangleMesh& mesh, const Fineness& wish, std::uint64_t most_triangles) {
  return Refiner(mesh).refine(wish, most_triangles);
}

std::optional<Refinement> make_smooth(TriangleMesh& mesh, std::optional<bool> smooth) {
  const bool by_file = smooth.value_or(true) && has_smooth_normals(mesh);
  if (!by_file && smooth.value_or(false)) average_normals(mesh);
  if (!by_file && !smooth.value_or(false)) {
    mesh.normals.clear();
    mesh.corner_normals.clear();
    return std::nullopt;
  }
  const bool several = unite_parts(mesh) > 1;
  const Refinement done = refine(mesh);
  if (several) unite_parts(mesh);
  return done;
}

}  // namespace translucube

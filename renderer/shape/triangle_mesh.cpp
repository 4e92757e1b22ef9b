#include "renderer/shape/triangle_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <sstream>
#include <string>
#include <tuple>

#include "renderer/shape/mesh_parts.h"

namespace translucube {
namespace {

Vec3 area_vector(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3 a = mesh.vertices[t[0]];
  return 0.5 * cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
}

/// Names each vertex by `target`, and keeps the first of those that have the same name.
void rename_vertices(TriangleMesh& mesh, const std::vector<std::uint32_t>& target,
                     std::size_t count) {
  std::vector<Vec3> kept(count);
  for (std::size_t i = mesh.vertices.size(); i-- > 0;)
    if (target[i] < count) kept[target[i]] = mesh.vertices[i];
  mesh.vertices = std::move(kept);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = target[v];
}

/// Files repeat a vertex for each face or normal: a closed surface shares them. Exactly equal ones:
/// a tolerance would close what is open, and change what is fine.
std::size_t weld_vertices(TriangleMesh& mesh) {
  const auto count = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto place = [&](std::uint32_t i) {
    const Vec3& v = mesh.vertices[i];
    return std::tie(v.x, v.y, v.z);
  };
  std::vector<std::uint32_t> order(count), first(count), target(count);
  std::iota(order.begin(), order.end(), 0u);
  std::ranges::sort(order, [&](std::uint32_t i, std::uint32_t j) {
    return place(i) != place(j) ? place(i) < place(j) : i < j;
  });
  for (std::uint32_t i = 0; i < count; ++i)
    first[order[i]] =
        i > 0 && place(order[i]) == place(order[i - 1]) ? first[order[i - 1]] : order[i];
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < count; ++i) target[i] = first[i] == i ? kept++ : target[first[i]];
  rename_vertices(mesh, target, kept);
  return count - kept;
}

/// What is no corner must not be part of the bounding box either.
void drop_unused_vertices(TriangleMesh& mesh) {
  constexpr std::uint32_t unused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> target(mesh.vertices.size(), unused);
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) target[v] = 0;
  std::uint32_t kept = 0;
  for (std::uint32_t& v : target)
    if (v != unused) v = kept++;
  rename_vertices(mesh, target, kept);
}

std::size_t drop_degenerate(TriangleMesh& mesh) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const Triangle t = mesh.triangles[i];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    mesh.triangles[kept] = t;
    if (!mesh.corner_normals.empty()) mesh.corner_normals[kept] = mesh.corner_normals[i];
    ++kept;
  }
  const std::size_t dropped = mesh.triangles.size() - kept;
  mesh.triangles.resize(kept);
  if (!mesh.corner_normals.empty()) mesh.corner_normals.resize(kept);
  return dropped;
}

void check_closed(const TriangleMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) edges.emplace_back(t[i], t[(i + 1) % 3]);
  std::ranges::sort(edges);
  std::size_t open = 0, doubled = 0, first_open = 0, first_doubled = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i > 0 && edges[i] == edges[i - 1] && doubled++ == 0) first_doubled = i;
    if (!std::ranges::binary_search(edges, std::pair(edges[i].second, edges[i].first)) &&
        open++ == 0)
      first_open = i;
  }
  const auto example = [&](std::size_t edge) {
    std::ostringstream text;
    const Vec3 a = mesh.vertices[edges[edge].first], b = mesh.vertices[edges[edge].second];
    text << ", as that from " << a.x << " " << a.y << " " << a.z << " to " << b.x << " " << b.y
         << " " << b.z;
    return text.str();
  };
  if (open > 0)
    throw MeshError("the mesh is not closed: " + std::to_string(open) + " of its " +
                    std::to_string(edges.size()) + " half-edges have no partner" +
                    example(first_open));
  if (doubled > 0)
    throw MeshError("the mesh is not a closed surface: " + std::to_string(doubled) +
                    " edges are shared by more than two triangles" + example(first_doubled));
}

}  // namespace

MeshReport close_mesh(TriangleMesh& mesh) {
  for (const Vec3& v : mesh.vertices)
    if (!std::isfinite(v.x + v.y + v.z))
      throw MeshError("the mesh has a vertex that is not finite");
  MeshReport report;
  report.welded_vertices = weld_vertices(mesh);
  report.dropped_triangles = drop_degenerate(mesh);
  if (mesh.triangles.empty()) throw MeshError("the mesh has no triangle");
  check_closed(mesh);
  report.parts = unite_parts(mesh);
  drop_unused_vertices(mesh);
  report.vertices = mesh.vertices.size();
  report.triangles = mesh.triangles.size();
  return report;
}

double volume(const TriangleMesh& mesh) {
  double six = 0;
  const Vec3 origin = mesh.vertices.empty() ? Vec3{} : mesh.vertices[0];
  for (const Triangle& t : mesh.triangles)
    six += dot(mesh.vertices[t[0]] - origin, 2 * area_vector(mesh, t));
  return six / 6;
}

double surface_area(const TriangleMesh& mesh) {
  double sum = 0;
  for (const Triangle& t : mesh.triangles) sum += length(area_vector(mesh, t));
  return sum;
}

bool is_convex(const TriangleMesh& mesh) {
  Vec3 middle;
  for (const Vec3& v : mesh.vertices)
    middle = middle + v * (1 / static_cast<double>(mesh.vertices.size()));
  // Once around the middle: the surface covers every direction from there a single time, so it is
  // one body and meets itself nowhere.
  double solid_angle = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - middle, b = mesh.vertices[t[1]] - middle,
               c = mesh.vertices[t[2]] - middle;
    const double six_volumes = dot(a, cross(b, c)), p = length(a), q = length(b), r = length(c);
    if (six_volumes <= 0) return false;
    // Van Oosterom and Strackee (1983).
    solid_angle +=
        2 * std::atan2(six_volumes, p * q * r + dot(a, b) * r + dot(b, c) * p + dot(c, a) * q);
  }
  if (solid_angle > 5 * std::numbers::pi) return false;
  // And nowhere bent inwards: no vertex stands above the plane of a neighbouring face.
  struct Edge {
    std::uint32_t low, high, face, opposite;
  };
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t f = 0; f < mesh.triangles.size(); ++f)
    for (int i = 0; i < 3; ++i) {
      const Triangle& t = mesh.triangles[f];
      const auto [low, high] = std::minmax(t[i], t[(i + 1) % 3]);
      edges.push_back({low, high, f, t[(i + 2) % 3]});
    }
  std::ranges::sort(edges, {}, [](const Edge& e) { return std::pair(e.low, e.high); });
  for (std::size_t i = 0; i < edges.size(); i += 2) {
    const Vec3 normal = area_vector(mesh, mesh.triangles[edges[i].face]);
    const Vec3 beyond = mesh.vertices[edges[i + 1].opposite] - mesh.vertices[edges[i].low];
    constexpr double rounding = 1e-9;
    if (dot(beyond, normal) > rounding * length(beyond) * length(normal)) return false;
  }
  return true;
}

}  // namespace translucube

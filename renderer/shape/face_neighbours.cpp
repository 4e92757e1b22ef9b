#include "renderer/shape/face_neighbours.h"

#include <algorithm>
#include <numeric>

namespace translucube {

FaceNeighbours::FaceNeighbours(const TriangleMesh& mesh) {
  const std::vector<Triangle>& triangles = mesh.triangles;
  // The faces around each vertex: those of vertex i begin at first[i].
  std::vector<std::uint32_t> first(mesh.vertices.size() + 1), around(3 * triangles.size());
  for (const Triangle& t : triangles)
    for (const std::uint32_t v : t) ++first[v + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<std::uint32_t> next = first;
  for (std::uint32_t f = 0; f < triangles.size(); ++f)
    for (const std::uint32_t v : triangles[f]) around[next[v]++] = f;

  from_.reserve(triangles.size() + 1);
  from_.push_back(0);
  std::vector<std::uint32_t> found;
  for (std::uint32_t f = 0; f < triangles.size(); ++f) {
    found.clear();
    for (const std::uint32_t v : triangles[f])
      if (first[v + 1] - first[v] <= most_around_vertex)
        found.insert(found.end(), around.begin() + first[v], around.begin() + first[v + 1]);
    std::ranges::sort(found);
    const auto rest = std::ranges::unique(found);
    found.erase(rest.begin(), rest.end());
    std::erase(found, f);
    faces_.insert(faces_.end(), found.begin(), found.end());
    from_.push_back(static_cast<std::uint32_t>(faces_.size()));
  }
}

}  // namespace translucube

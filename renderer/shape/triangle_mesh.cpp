#include "renderer/shape/triangle_mesh.h"

#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <tuple>

namespace translucube {
namespace {

Vec3 area_vector(const TriangleMesh& mesh, const Triangle& t) {
  const Vec3 a = mesh.vertices[t[0]];
  return 0.5 * cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a);
}

/// Files repeat a vertex for each face or normal: a closed surface shares them.
void merge_vertices(TriangleMesh& mesh) {
  const auto less = [](Vec3 a, Vec3 b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  std::map<Vec3, std::uint32_t, decltype(less)> index(less);
  std::vector<Vec3> unique;
  std::vector<std::uint32_t> target(mesh.vertices.size());
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    const auto [entry, fresh] = index.try_emplace(mesh.vertices[i], unique.size());
    if (fresh) unique.push_back(mesh.vertices[i]);
    target[i] = entry->second;
  }
  mesh.vertices = std::move(unique);
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& v : t) v = target[v];
}

void check_closed(const TriangleMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const Triangle& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) edges.emplace_back(t[i], t[(i + 1) % 3]);
  std::ranges::sort(edges);
  std::size_t open = 0, doubled = 0;
  for (std::size_t i = 0; i < edges.size(); ++i) {
    if (i > 0 && edges[i] == edges[i - 1]) ++doubled;
    if (!std::ranges::binary_search(edges, std::pair(edges[i].second, edges[i].first))) ++open;
  }
  if (open > 0)
    throw MeshError("the mesh is not closed: " + std::to_string(open) + " of its " +
                    std::to_string(edges.size()) + " half-edges have no partner");
  if (doubled > 0)
    throw MeshError("the mesh is not a closed surface: " + std::to_string(doubled) +
                    " edges are shared by more than two triangles");
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& file) {
  Assimp::Importer importer;
  std::string extension = file.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return std::tolower(c); });
  if (extension != ".obj" && extension != ".ply")
    throw MeshError("a mesh must be an .obj or .ply file");
  // Keep only positions and faces: materials of a file may name other files.
  importer.SetPropertyInteger(AI_CONFIG_PP_RVC_FLAGS, ~(aiComponent_MESHES)&0xfff);
  const aiScene* scene =
      importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_RemoveComponent |
                                           aiProcess_PreTransformVertices);
  if (scene == nullptr) throw MeshError("the mesh cannot be read");
  TriangleMesh mesh;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) {
    const aiMesh& part = *scene->mMeshes[m];
    const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
    for (unsigned v = 0; v < part.mNumVertices; ++v) {
      const aiVector3D& p = part.mVertices[v];
      mesh.vertices.push_back({p.x, p.y, p.z});
    }
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices == 3)
        mesh.triangles.push_back(
            {base + face.mIndices[0], base + face.mIndices[1], base + face.mIndices[2]});
    }
  }
  if (mesh.triangles.empty()) throw MeshError("the mesh has no triangle");
  return mesh;
}

void close_mesh(TriangleMesh& mesh) {
  for (const Vec3& v : mesh.vertices)
    if (!std::isfinite(v.x + v.y + v.z))
      throw MeshError("the mesh has a vertex that is not finite");
  merge_vertices(mesh);
  std::erase_if(mesh.triangles,
                [](const Triangle& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  if (mesh.triangles.empty()) throw MeshError("the mesh has no triangle");
  check_closed(mesh);
  const double v = volume(mesh);
  if (v == 0) throw MeshError("the mesh encloses no volume");
  if (v < 0)
    for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
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

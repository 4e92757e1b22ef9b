// Files of meshes: any bytes are refused or become the closed boundary of one body, which may be
// made smooth.

#include <algorithm>
#include <string_view>

#include "renderer/shape/file/mesh_format.h"
#include "renderer/shape/smooth/normals.h"
#include "renderer/shape/smooth/refine.h"
#include "tests/fuzz/requests.h"

using namespace translucube;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    auto [mesh, report] = parse_mesh(bytes);
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t)
        fuzz::require(v < mesh.vertices.size(), "a corner is a vertex");
    const std::size_t triangles = mesh.triangles.size();
    fuzz::require(report.triangles == triangles, "what is told is what there is");
    close_mesh(mesh);
    fuzz::require(mesh.triangles.size() == triangles, "what is closed stays as it is");
    fuzz::require(mesh.corner_normals.empty() || mesh.corner_normals.size() == triangles,
                  "all corners have normals, or none");
    constexpr std::uint64_t most = 10'000;
    if (mesh.corner_normals.empty()) average_normals(mesh);
    const Refinement done = refine(mesh, {1e-3, 1e-3}, most);
    fuzz::require(done.made == mesh.triangles.size(), "as many triangles as are told");
    fuzz::require(done.made <= std::max<std::uint64_t>(most, triangles), "not too many");
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t)
        fuzz::require(v < mesh.vertices.size(), "a corner of what is smooth is a vertex");
  } catch (const MeshError& error) {
    fuzz::require(*error.what() != '\0', "a refusal says why");
  }
  return 0;
}

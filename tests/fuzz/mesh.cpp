// Files of meshes: any bytes are refused or become the closed boundary of one body.

#include <string_view>

#include "renderer/shape/file/mesh_format.h"
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
  } catch (const MeshError& error) {
    fuzz::require(*error.what() != '\0', "a refusal says why");
  }
  return 0;
}

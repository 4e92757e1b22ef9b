#include "renderer/shape/file/mesh_format.h"

#include "renderer/shape/file/polygon_mesh.h"

namespace translucube {

TriangleMesh parse_mesh(MeshFormat format, std::string_view bytes) {
  TriangleMesh mesh = triangulate(format == MeshFormat::obj ? parse_obj(bytes) : parse_ply(bytes));
  close_mesh(mesh);
  return mesh;
}

}  // namespace translucube

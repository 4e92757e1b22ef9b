#include "renderer/shape/file/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "picture/sandbox/answer.h"
#include "picture/sandbox/sandbox.h"
#include "renderer/shape/file/mesh_format.h"

namespace translucube {

ClosedMesh unpack_mesh(std::span<const std::byte> bytes) {
  AnswerReader reader(bytes);
  const auto vertices = reader.value<std::uint64_t>(), triangles = reader.value<std::uint64_t>();
  if (vertices > reader.remains() / sizeof(Vec3) ||
      triangles > reader.remains() / sizeof(Triangle) || triangles == 0)
    throw AnswerError("an answer of another size");
  ClosedMesh closed;
  closed.report = reader.value<MeshReport>();
  TriangleMesh& mesh = closed.mesh;
  mesh.vertices.resize(vertices);
  mesh.triangles.resize(triangles);
  reader.values(std::span(mesh.vertices));
  reader.values(std::span(mesh.triangles));
  reader.expect_end();
  for (const Vec3& v : mesh.vertices)
    if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
      throw AnswerError("a vertex that is not finite");
  for (const Triangle& t : mesh.triangles)
    if (std::ranges::max(t) >= vertices) throw AnswerError("a vertex that is not there");
  return closed;
}

ClosedMesh read_mesh(const std::filesystem::path& file) {
  try {
    const SandboxAnswer answer = read_in_sandbox(mesh_kind, file);
    return unpack_mesh(open_answer(answer.bytes()));
  } catch (const FileRefused& error) {
    throw MeshError(error.what());
  } catch (const FileUnavailable& error) {
    throw MeshUnavailable(error.what());
  } catch (const AnswerError& error) {
    throw MeshError(std::string("its reader gave ") + error.what());
  }
}

}  // namespace translucube

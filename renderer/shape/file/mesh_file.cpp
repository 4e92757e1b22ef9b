#include "renderer/shape/file/mesh_file.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "picture/sandbox/answer.h"
#include "picture/sandbox/sandbox.h"
#include "renderer/shape/file/mesh_format.h"

namespace translucube {

namespace {

template <class T>
void read_all(AnswerReader& reader, std::vector<T>& values) {
  const auto count = reader.value<std::uint64_t>();
  if (count > reader.remains() / sizeof(T)) throw AnswerError("an answer of another size");
  values.resize(count);
  reader.values(std::span(values));
}

}  // namespace

ClosedMesh unpack_mesh(std::span<const std::byte> bytes) {
  AnswerReader reader(bytes);
  ClosedMesh closed;
  closed.report = reader.value<MeshReport>();
  TriangleMesh& mesh = closed.mesh;
  read_all(reader, mesh.vertices);
  read_all(reader, mesh.triangles);
  read_all(reader, mesh.normals);
  read_all(reader, mesh.corner_normals);
  reader.expect_end();
  if (mesh.triangles.empty()) throw AnswerError("no triangle");
  if (!mesh.corner_normals.empty() && mesh.corner_normals.size() != mesh.triangles.size())
    throw AnswerError("normals of other triangles");
  for (const auto* vectors : {&mesh.vertices, &mesh.normals})
    for (const Vec3& v : *vectors)
      if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z))
        throw AnswerError("a vertex that is not finite");
  for (const Triangle& t : mesh.triangles)
    if (std::ranges::max(t) >= mesh.vertices.size())
      throw AnswerError("a vertex that is not there");
  for (const Triangle& t : mesh.corner_normals)
    for (const std::uint32_t n : t)
      if (n != no_normal && n >= mesh.normals.size())
        throw AnswerError("a normal that is not there");
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

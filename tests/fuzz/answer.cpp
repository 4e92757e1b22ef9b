// The answers of the process that reads files of strangers: believed in nothing.

#include "picture/sandbox/answer.h"

#include <span>

#include "picture/sandbox/sandbox.h"
#include "renderer/shape/file/mesh_file.h"
#include "tests/fuzz/requests.h"

using namespace translucube;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto bytes = std::as_bytes(std::span(data, size));
  try {
    const TriangleMesh mesh = unpack_mesh(open_answer(bytes)).mesh;
    for (const Triangle& t : mesh.triangles)
      for (const std::uint32_t v : t)
        fuzz::require(v < mesh.vertices.size(), "a corner is a vertex");
  } catch (const AnswerError&) {
  } catch (const FileRefused& refusal) {
    for (const char* c = refusal.what(); *c; ++c) fuzz::require(*c >= 32, "a reason is text");
  }
  return 0;
}

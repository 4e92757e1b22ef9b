// translucube_reader KIND: the program that parses files of strangers, in the sandbox
// (picture/sandbox). It finds the file open, and leaves its answer where it was told to. Not for
// people: the service and the command line start it.

#include <array>
#include <string_view>

#include "picture/light/decode.h"
#include "picture/oiio/codecs.h"
#include "picture/sandbox/confine.h"
#include "renderer/shape/file/mesh_format.h"

namespace {

using namespace translucube;

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

using Answer = std::function<void(const AnswerPieces&)>;

void read_light(std::span<const char> bytes, const Answer& answer) {
  const Image image = decode_light(bytes);
  const std::int32_t width = image.width, height = image.height;
  answer({bytes_of(width), bytes_of(height), std::as_bytes(std::span(image.pixels))});
}

void load_codecs(std::span<const char> bytes) {
  switch (light_format(bytes)) {
    case LightFormat::png:
    case LightFormat::jpeg:
    case LightFormat::tiff:
      image_codecs().prepare_stored();
      break;
    default:
      break;
  }
}

void read_mesh(std::span<const char> bytes, const Answer& answer) {
  const auto [mesh, report] = parse_mesh({bytes.data(), bytes.size()});
  const std::array<std::uint64_t, 4> counts{mesh.vertices.size(), mesh.triangles.size(),
                                            mesh.normals.size(), mesh.corner_normals.size()};
  answer({bytes_of(report), bytes_of(counts[0]), std::as_bytes(std::span(mesh.vertices)),
          bytes_of(counts[1]), std::as_bytes(std::span(mesh.triangles)), bytes_of(counts[2]),
          std::as_bytes(std::span(mesh.normals)), bytes_of(counts[3]),
          std::as_bytes(std::span(mesh.corner_normals))});
}

}  // namespace

int main(int count, char** words) {
  const std::string_view kind = count == 2 ? words[1] : "";
  if (kind == "light") return run_confined(load_codecs, read_light);
  if (kind == mesh_kind) return run_confined([](auto) {}, read_mesh);
  return sandbox_no_answer;
}

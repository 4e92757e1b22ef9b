#include "renderer/transport/transport.h"

#include "renderer/transport/trace_body.h"

namespace translucube {

void trace_tile(const Scene& scene, std::uint32_t pass_index, std::uint32_t first,
                std::uint32_t count, Tile& tile, std::string* log) {
  std::visit(
      [&](const auto& shape) { trace_body(shape, scene, pass_index, first, count, tile, log); },
      scene.shape);
}

}  // namespace translucube

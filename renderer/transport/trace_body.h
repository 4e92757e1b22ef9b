#pragma once

#include "renderer/transport/transport.h"

namespace translucube {

/// trace_tile() for the shape of the scene; compiled for each shape in transport_*.cpp.
template <class Shape>
void trace_body(const Shape& shape, const Scene& scene, std::uint32_t pass_index,
                std::uint32_t first, std::uint32_t count, Tile& tile, std::string* log);

}  // namespace translucube

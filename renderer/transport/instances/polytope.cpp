#include "renderer/transport/tracer.h"

namespace translucube {

template void trace_body(const Polytope&, const Scene&, std::uint32_t, std::uint32_t, std::uint32_t,
                         Tile&, std::string*);

}  // namespace translucube

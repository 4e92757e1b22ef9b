#include "renderer/transport/tracer.h"

template void translucube::trace_body(const Polytope&, const Scene&, const SampleRange&, Tile&,
                                      const Patience&, std::string*);

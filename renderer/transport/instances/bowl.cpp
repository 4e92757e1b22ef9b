#include "renderer/transport/tracer.h"

template void translucube::trace_body(const Bowl&, const Scene&, const SampleRange&, Tile&,
                                      const Patience&, std::string*);

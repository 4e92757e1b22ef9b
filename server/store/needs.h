#pragma once

// What a request will take, told before it is accepted: estimates from above.

#include <cstdint>
#include <span>

#include "api/request/request.h"

namespace translucube::server {

/// Memory while it is traced [bytes]: its film, a pass of it, and the film as the bytes of a
/// checkpoint. `lanes`: absorptions that are developed from it.
std::uint64_t memory_of(const api::RenderRequest& request, std::uint64_t lanes);

/// The pictures of so many lanes on the disk [bytes], and the path lengths of an explorable one.
std::uint64_t picture_bytes(const api::RenderRequest& request, std::uint64_t lanes);

}  // namespace translucube::server

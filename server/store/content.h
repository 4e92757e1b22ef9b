#pragma once

// A picture is known by all that it depends on: whoever asks for the same gets the same bits, so
// that what was made once need not be made again.

#include <string>
#include <string_view>

#include "api/request/catalog.h"

namespace translucube::server {

/// SHA-256 over the engine's version, the canonical request and the resources that it names
/// (absorber: its values; files: size and time of change; uploads: the hash that names them), as 64
/// hexadecimal digits. `traced_with`:
/// the canonical request of another picture that decided how many samples this one took.
std::string content_key(const api::RenderRequest& request, std::string_view canonical,
                        const api::Catalog& catalog, std::string_view traced_with = {});

/// True for the form of a content key.
bool is_content_key(std::string_view text);

}  // namespace translucube::server

#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace translucube::gltf {

/// The bytes of "data:TYPE;base64,..." (RFC 2397, RFC 4648); empty where it is no such text.
std::optional<std::string> bytes_of_data_uri(std::string_view uri);

}  // namespace translucube::gltf

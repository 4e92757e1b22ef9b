#pragma once

#include <array>
#include <string_view>

namespace translucube::server {

using Sha256 = std::array<unsigned char, 32>;

/// FIPS 180-4. Throws std::runtime_error if the library cannot.
Sha256 sha256(std::string_view bytes);

}  // namespace translucube::server

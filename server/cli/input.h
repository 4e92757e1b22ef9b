#pragma once

#include <cstdint>
#include <string>

namespace translucube::server {

/// The bytes of a file, or of standard input for "-"; no more than one byte above the limit, so
/// that it is the parser that refuses. Throws Refusal.
std::string read_input(const std::string& name, std::uint64_t limit);

}  // namespace translucube::server

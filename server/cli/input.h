#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace translucube::server {

/// A document that the command line names cannot be read.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The bytes of a file, or of standard input for "-"; no more than one byte above the limit, so
/// that it is the parser that refuses. Throws InputError.
std::string read_input(const std::string& name, std::uint64_t limit);

}  // namespace translucube::server

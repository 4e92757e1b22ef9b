#pragma once

#include <stdexcept>
#include <string>

namespace translucube::server {

/// The queue could not be written or read.
struct StoreError : std::runtime_error {
  enum class Kind { unavailable, full, corrupt };
  Kind kind;
  StoreError(Kind k, const std::string& what) : std::runtime_error(what), kind(k) {}
};

}  // namespace translucube::server

#pragma once

#include <cstddef>
#include <optional>
#include <string_view>

#include "api/base/problem.h"

namespace translucube::server {

/// Looks for the end of a request's head in bytes as they come, each once, and refuses at the first
/// one that no head may have: readers who pass over it would differ on where a line or the head
/// ends.
class HeadScan {
 public:
  static constexpr std::size_t largest_head = 1 << 16;
  static constexpr std::size_t longest_line = 1 << 13;

  enum class State { begun, whole, faulty };
  /// `received`: all that has come from the first byte of the head on, at least as much as the last
  /// time. Once whole or faulty it stays so.
  State scan(std::string_view received);

  /// Bytes of the whole head, with the empty line that ends it.
  std::size_t size() const { return at_; }
  const api::Problem& fault() const { return *fault_; }

 private:
  State refuse(api::ProblemCode code, const char* detail);

  std::size_t at_ = 0, line_ = 0, lines_ = 0;
  bool whole_ = false;
  std::optional<api::Problem> fault_;
};

}  // namespace translucube::server

#pragma once

#include <string>
#include <vector>

namespace translucube::test {

/// A body that no service may accept, and what it must be answered.
struct MalformedBody {
  std::string name;
  std::string text;
  int status = 0;               ///< HTTP status of the problem
  std::string pointer;          ///< of one of its faults; "" where the whole document is at fault
  bool one_fault = false;       ///< it says one thing wrong
  bool several_faults = false;  ///< it says several things wrong
};

/// The lines of tests/api/malformed.jsonl, whose bodies are strings or, where those are not UTF-8,
/// bytes in hexadecimal digits; and bodies that are too large to keep. Expectations hold for
/// config/service.json as it is shipped. Throws std::runtime_error where the corpus cannot be read.
std::vector<MalformedBody> malformed_bodies();

}  // namespace translucube::test

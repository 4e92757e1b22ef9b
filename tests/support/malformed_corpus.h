#pragma once

#include <string>
#include <vector>

namespace translucube::test {

/// A body that no service may accept, and what it must be answered.
struct MalformedBody {
  std::string name;
  std::string text;
  int status = 0;       ///< HTTP status of the problem
  std::string pointer;  ///< of one of its faults; "" where only the whole document is at fault
};

/// The files of tests/api/malformed with its index, and those that are too large to keep as files.
/// Expectations hold for config/service.json as it is shipped. Throws std::runtime_error where the
/// corpus cannot be read.
std::vector<MalformedBody> malformed_bodies();

}  // namespace translucube::test

#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "api/base/problem.h"

namespace translucube::api {

/// The faults found in one document, in the order they were found.
class Faults {
 public:
  /// Past this many, faults are counted but not kept: a client can use no more of them, and an
  /// answer must not grow with a hostile document.
  static constexpr std::size_t most = 100;

  void add(std::string pointer, std::string detail);
  bool empty() const { return count_ == 0; }
  std::size_t count() const { return count_; }

  /// Those that were kept, and one for the whole document that says how many more there are.
  std::vector<Fault> list() const;

 private:
  std::vector<Fault> kept_;
  std::size_t count_ = 0;
};

/// The 422 that tells all faults of a document.
Problem invalid_request(const Faults& faults);

/// The 422 that tells the faults of query parameters, whose pointers are "?name".
Problem invalid_query(std::vector<Fault> faults);

/// One token of a JSON pointer, escaped (RFC 6901, section 4). A key of more than 64 bytes is cut,
/// at a character, and ends in "...": keys come from the client.
std::string pointer_token(std::string_view key);

}  // namespace translucube::api

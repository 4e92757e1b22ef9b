#pragma once

// The head of a request (RFC 9112), read strictly: what two readers could take differently is
// refused, so that no request hides another from a proxy before us. Pure functions over bytes.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "api/base/result.h"

namespace translucube::server {

/// A field line, its name in lower case, its value without the white space around it.
struct Field {
  std::string name, value;
};

/// Where the body ends (RFC 9112, 6).
struct Framing {
  bool chunked = false;
  std::uint64_t length = 0;  ///< where it is not chunked
  bool has_body() const { return chunked || length > 0; }
};

struct RequestHead {
  std::string method;
  std::string path;  ///< percent-decoded but for "/" and NUL; "*" where that was the target
  std::vector<std::pair<std::string, std::string>> query;
  int minor = 1;              ///< of HTTP/1.x
  std::vector<Field> fields;  ///< the authority of the target stands for the Host field's
  Framing framing;
  bool keep_alive = true;         ///< the client lets the connection be used again
  bool expects_continue = false;  ///< "Expect: 100-continue"
  bool expects_more = false;      ///< another expectation

  /// The value of a field, repeated ones joined by ", " (RFC 9110, 5.3); empty where it is not
  /// there.
  std::optional<std::string> value(std::string_view lower_case_name) const;
};

/// Reads a head that a HeadScan has found whole.
api::Result<RequestHead> read_request_head(std::string_view head);

/// A field line without its CR LF.
std::optional<Field> read_field_line(std::string_view line);

}  // namespace translucube::server

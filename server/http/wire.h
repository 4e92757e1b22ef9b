#pragma once

// Between HTTP's wire form and ours; templates over the library's request, which only server.cpp,
// exchange.* and socket_server.* know.

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "api/base/text.h"

namespace translucube::server {

/// Text of a client for a log line: no control characters, no more than it needs.
inline std::string printable(std::string_view text) {
  std::string result(text.substr(0, 200));
  std::ranges::replace_if(
      result, [](unsigned char c) { return c < 32 || c > 126; }, '?');
  return result;
}

/// What the headers say of a request's body.
struct BodyAnnouncement {
  enum class Kind { none, present, malformed };
  Kind kind = Kind::none;
  std::uint64_t length = 0;  ///< 0 where it comes in chunks
};

/// RFC 9112, 6.3. Strict where two readers could differ on where the body ends: both a length and a
/// transfer coding, several lengths, a length that is no number, a coding that is not `chunked`.
template <typename Request>
BodyAnnouncement announced_body(const Request& request) {
  const auto lengths = request.get_header_value_count("Content-Length");
  const auto codings = request.get_header_value_count("Transfer-Encoding");
  if (lengths == 0 && codings == 0) return {};
  const BodyAnnouncement malformed{BodyAnnouncement::Kind::malformed, 0};
  if (lengths + codings > 1) return malformed;
  if (codings == 1) {
    if (request.get_header_value("Transfer-Encoding") != "chunked") return malformed;
    return {BodyAnnouncement::Kind::present, 0};
  }
  const std::string text = request.get_header_value("Content-Length");
  const auto length = api::number_of<std::uint64_t>(text);
  if (!length) return malformed;
  return {*length > 0 ? BodyAnnouncement::Kind::present : BodyAnnouncement::Kind::none, *length};
}

}  // namespace translucube::server

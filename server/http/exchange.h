#pragma once

#include "server/http/socket_server.h"

namespace translucube::server {

/// Puts an answer of ours into the library's. `close`: the connection ends after it, because its
/// stream cannot be read on (a body was left in it).
void put_answer(HttpResponse answer, const std::string& request_id, const SocketServer& server,
                httplib::Response& response, bool close = false);

struct Upload {
  std::string body;
  bool whole = false, too_large = false;
};

/// What a client may be made to send of a body that is refused, so that it gets to read the answer;
/// a body that announces more than this is left unread.
inline constexpr std::uint64_t longest_drain = std::uint64_t(1) << 30;

/// Reads a body of at most `limit` bytes, as sent: no decoding, which could blow it up.
Upload receive(httplib::Request& request, const httplib::ContentReader& reader,
               std::uint64_t limit);

}  // namespace translucube::server

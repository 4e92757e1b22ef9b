#pragma once

// HTTP requests and answers as plain values, so that everything but the socket can be tried by
// hand.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "api/base/problem.h"
#include "server/base/file.h"

namespace translucube::server {

class ReceivedFile;

struct HttpRequest {
  std::string method, path;  ///< the path is decoded, without the query
  std::vector<std::pair<std::string, std::string>> query;
  std::map<std::string, std::string> headers;  ///< by lower-case name; repeated ones joined by ", "
  std::string body;
  /// Where the body goes instead, as it comes: set by what admits the request (server.h).
  std::shared_ptr<ReceivedFile> body_file = {};
  std::string id = {};      ///< of the request: the client's or a new one, for the log
  std::string client = {};  ///< name of the token it carries, "" where none is needed
  /// A call that waits says so before, so that others are answered meanwhile.
  std::function<void()> give_way = [] {};

  std::string_view header(const std::string& lower_case_name) const {
    const auto it = headers.find(lower_case_name);
    return it == headers.end() ? std::string_view() : std::string_view(it->second);
  }
  /// The value of a query parameter; the first, should it be there twice.
  std::optional<std::string> parameter(std::string_view name) const {
    for (const auto& [key, value] : query)
      if (key == name) return value;
    return std::nullopt;
  }
};

/// A part of a file, sent without reading it whole.
struct FileSlice {
  std::shared_ptr<const OpenFile> file;
  std::uint64_t offset = 0, length = 0;
};

/// Server-sent events as they come, sent with status 200 and no end that is known before; to HEAD
/// only the headers are.
struct EventStream {
  /// The next bytes to send. Waits for a second at most: "" says that there is nothing yet, nullopt
  /// that the stream is over. Called by one thread at a time; destroyed as soon as the client has
  /// hung up or the service stops.
  std::function<std::optional<std::string>()> next;
};

struct HttpResponse {
  int status = 200;
  std::vector<std::pair<std::string, std::string>> headers;
  std::string content_type;
  std::variant<std::string, FileSlice, EventStream> body;
};

/// The answer that carries a problem, with the headers that its status asks for.
HttpResponse problem_response(const api::Problem& problem);

/// Text of a client for a log line: no control characters, no more than it needs.
std::string printable(std::string_view text);

}  // namespace translucube::server

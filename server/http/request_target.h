#pragma once

// The target of a request in its four forms (RFC 9112, 3.2; RFC 3986), and the host that it, or the
// Host field, names.

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace translucube::server {

struct RequestTarget {
  std::string path;
  std::vector<std::pair<std::string, std::string>> query;
  std::optional<std::string> authority;  ///< host[:port] of the absolute form and of CONNECT
};

/// Empty where it is none for this method.
std::optional<RequestTarget> read_target(std::string_view method, std::string_view target);

/// uri-host [":" port] (RFC 9110, 7.2), which may be empty; no user before it.
bool is_host(std::string_view text);

}  // namespace translucube::server

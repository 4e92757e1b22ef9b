#pragma once

// Who may ask, from where, and for which host: decided from a request's headers alone.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/base/result.h"
#include "server/base/server_config.h"
#include "server/calls/tokens.h"
#include "server/http/message.h"

namespace translucube::server {

struct AccessPolicy {
  bool loopback = true;              ///< only this machine can connect
  std::vector<Token> tokens;         ///< none: no token is needed
  std::vector<std::string> hosts;    ///< host[:port], lower case
  std::vector<std::string> origins;  ///< scheme://host[:port], lower case
};

/// Reads the tokens that the config names. Throws TokensError, also where others than this machine
/// could connect and there are none.
AccessPolicy access_policy(const ServerConfig& config);

/// True for the addresses that only this machine can connect to: 127.0.0.0/8, ::1, localhost.
bool is_loopback(std::string_view host);

/// /livez and /readyz, which whoever watches the service asks for.
bool is_probe(std::string_view path);

struct Admitted {
  std::string client;  ///< the token's name, "" where none was needed
};

/// Checks, for all but the probes /livez and /readyz:
/// - Host (421): the service's own, so that a web page whose name was made to point here ("DNS
///   rebinding") is no page of ours. On loopback, or where the policy names hosts: localhost,
///   127.0.0.1 and [::1] on any port, and those hosts, on any port unless they name one.
/// - Origin and Sec-Fetch-Site (403), unless the method is GET, HEAD or OPTIONS: a page of another
///   site may not post here on its reader's behalf.
/// - Authorization: Bearer (401; RFC 6750, 2.1), where the policy has tokens.
api::Result<Admitted> admit(const AccessPolicy& policy, const HttpRequest& request);

}  // namespace translucube::server

#include "server/calls/access.h"

#include <algorithm>
#include <array>

#include "api/base/text.h"

namespace translucube::server {
namespace {

using api::lower_case;
using api::Problem;
using api::ProblemCode;
using api::Result;

constexpr std::array<std::string_view, 3> own_names{"localhost", "127.0.0.1", "[::1]"};

/// The host without ":port", which may follow a name, an IPv4 address or a bracketed IPv6 one.
std::string_view without_port(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  if (colon == host.npos || host.find(']', colon) != host.npos) return host;
  const std::string_view port = host.substr(colon + 1);
  if (port.find_first_not_of("0123456789") != port.npos) return host;
  return host.substr(0, colon);
}

bool is_our_host(const AccessPolicy& policy, std::string_view given) {
  if (!policy.loopback && policy.hosts.empty()) return true;
  const std::string host = lower_case(given);
  const std::string_view name = without_port(host);
  const auto is_it = [&](std::string_view own) { return own == host || own == name; };
  return std::ranges::find(own_names, name) != own_names.end() ||
         std::ranges::any_of(policy.hosts, is_it);
}

/// Whether a page of ours asks, or no page: browsers send an Origin with each POST of theirs.
bool is_our_origin(const AccessPolicy& policy, const HttpRequest& request) {
  if (request.headers.contains("origin")) {
    const std::string origin = lower_case(request.header("origin"));
    const std::string host = lower_case(request.header("host"));
    return origin == "http://" + host || origin == "https://" + host ||
           std::ranges::find(policy.origins, origin) != policy.origins.end();
  }
  return lower_case(request.header("sec-fetch-site")) != "cross-site";
}

/// The web explorer, which a browser asks for without a token. It holds nothing but itself.
bool is_page(std::string_view path) { return path == "/" || path.starts_with("/web/"); }

/// The token of `Authorization: Bearer token`; the scheme has no case (RFC 9110, 11.1).
std::string_view bearer_token(const HttpRequest& request) {
  constexpr std::string_view scheme = "bearer ";
  std::string_view credentials = request.header("authorization");
  if (lower_case(credentials.substr(0, scheme.size())) != scheme) return {};
  credentials.remove_prefix(scheme.size());
  while (credentials.starts_with(' ')) credentials.remove_prefix(1);
  return credentials;
}

}  // namespace

bool is_loopback(std::string_view host) {
  const bool ipv4 = host.starts_with("127.") && host.size() <= 15 &&
                    host.find_first_not_of("0123456789.") == host.npos;
  return ipv4 || host == "::1" || lower_case(host) == "localhost";
}

AccessPolicy access_policy(const ServerConfig& config) {
  AccessPolicy policy{is_loopback(config.host), {}, config.hosts, config.origins};
  if (config.tokens_file)
    policy.tokens = load_tokens(*config.tokens_file);
  else if (!policy.loopback)
    throw TokensError("to listen on " + config.host +
                      ", where others can connect, the config must name a server.tokens_file "
                      "(`translucube token --name NAME` makes an entry)");
  return policy;
}

bool is_probe(std::string_view path) { return path == "/livez" || path == "/readyz"; }

Result<Admitted> admit(const AccessPolicy& policy, const HttpRequest& request) {
  if (is_probe(request.path)) return Admitted{};
  if (!is_our_host(policy, request.header("host")))
    return Problem{ProblemCode::misdirected,
                   "The Host header names another host; server.hosts can allow it.",
                   {}};
  const std::string& method = request.method;
  const bool changes_nothing = method == "GET" || method == "HEAD" || method == "OPTIONS";
  if (!changes_nothing && !is_our_origin(policy, request))
    return Problem{
        ProblemCode::forbidden, "A page of another origin asks; server.origins can allow it.", {}};
  if (policy.tokens.empty() || (changes_nothing && is_page(request.path))) return Admitted{};
  const std::string_view token = bearer_token(request);
  const std::string_view name = token.empty() ? token : name_of(policy.tokens, token);
  if (name.empty())
    return Problem{
        ProblemCode::unauthorized, "Send a known token: Authorization: Bearer TOKEN.", {}};
  return Admitted{std::string(name)};
}

}  // namespace translucube::server

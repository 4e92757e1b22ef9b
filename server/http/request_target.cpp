#include "server/http/request_target.h"

#include <algorithm>
#include <array>

#include "api/base/text.h"
#include "server/http/grammar.h"

namespace translucube::server {
namespace {

/// Text of URI characters, `more` and whole percent-encodings.
bool is_uri_text(std::string_view text, std::string_view more) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (is_plain_uri_character(text[i]) || more.find(text[i]) != more.npos) continue;
    if (text[i] != '%' || i + 2 >= text.size()) return false;
    if (!is_hex_digit(text[i + 1]) || !is_hex_digit(text[i + 2])) return false;
    i += 2;
  }
  return true;
}

/// `kept` stays as it is written: a decoded "/" would make another path of it.
std::string decoded(std::string_view text, std::string_view kept) {
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char byte =
        text[i] == '%'
            ? static_cast<char>(*api::number_of<unsigned char>(text.substr(i + 1, 2), 16))
            : '\0';
    const bool decode = text[i] == '%' && kept.find(byte) == kept.npos;
    plain += decode ? byte : text[i];
    if (decode) i += 2;
  }
  return plain;
}

/// As forms write it (WHATWG URL, 5.1): "+" is a space.
std::string form_decoded(std::string_view text) {
  std::string spaced(text);
  std::ranges::replace(spaced, '+', ' ');
  return decoded(spaced, "");
}

/// An absolute path with its query.
std::optional<RequestTarget> read_origin_form(std::string_view target) {
  const bool has_query = target.find('?') != target.npos;
  const std::string_view path = take_until(target, "?");
  if (!path.starts_with('/') || !is_uri_text(path, ":@/") || !is_uri_text(target, ":@/?"))
    return std::nullopt;
  constexpr std::string_view kept("/\0", 2);
  RequestTarget read{decoded(path, kept), {}, {}};
  while (has_query && !target.empty()) {
    std::string_view pair = take_until(target, "&");
    if (pair.empty()) continue;
    const std::string_view name = take_until(pair, "=");
    read.query.emplace_back(form_decoded(name), form_decoded(pair));
  }
  return read;
}

/// http[s]://host[:port][path][?query]
std::optional<RequestTarget> read_absolute_form(std::string_view target) {
  const std::string scheme = api::lower_case(take_until(target, "://"));
  if (scheme != "http" && scheme != "https") return std::nullopt;
  const std::string_view authority = target.substr(0, target.find_first_of("/?"));
  target.remove_prefix(authority.size());
  if (authority.empty() || authority.front() == ':' || !is_host(authority)) return std::nullopt;
  // RFC 9110, 4.2.3: an empty path is "/".
  auto read =
      read_origin_form(target.starts_with('/') ? std::string(target) : '/' + std::string(target));
  if (read) read->authority = std::string(authority);
  return read;
}

/// host:port
std::optional<RequestTarget> read_authority_form(std::string_view target) {
  const std::size_t colon = target.rfind(':');
  if (colon == target.npos || colon == 0 || !is_host(target) ||
      !is_digits(target.substr(colon + 1)))
    return std::nullopt;
  return RequestTarget{std::string(target), {}, std::string(target)};
}

bool is_ip_literal(std::string_view text) {
  if (text.size() < 4 || text.front() != '[' || text.back() != ']') return false;
  text = text.substr(1, text.size() - 2);
  // IPv6, or a form of the future: "v1.…".
  return std::ranges::all_of(text, [](char c) { return is_plain_uri_character(c) || c == ':'; });
}

}  // namespace

bool is_host(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  if (colon != text.npos && text.find(']', colon) == text.npos) {
    const std::string_view port = text.substr(colon + 1);
    constexpr std::size_t longest_port = 5;
    if (port.size() > longest_port || (!port.empty() && !is_digits(port))) return false;
    text = text.substr(0, colon);
  }
  return is_ip_literal(text) || is_uri_text(text, "");
}

std::optional<RequestTarget> read_target(std::string_view method, std::string_view target) {
  if (method == "CONNECT") return read_authority_form(target);
  if (target == "*")
    return method == "OPTIONS" ? std::optional(RequestTarget{"*", {}, {}}) : std::nullopt;
  if (target.starts_with('/')) return read_origin_form(target);
  auto read = read_absolute_form(target);
  // RFC 9112, 3.2.4: then the last proxy was to ask for "*".
  if (read && method == "OPTIONS" &&
      target.find_first_of("/?", target.find("://") + 3) == target.npos)
    read->path = "*";
  return read;
}

}  // namespace translucube::server

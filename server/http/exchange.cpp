#include "server/http/exchange.h"

#include <algorithm>
#include <random>
#include <span>

#include "server/base/ids.h"
#include "server/http/grammar.h"

namespace translucube::server {
namespace {

bool is_request_id(std::string_view text) {
  return !text.empty() && text.size() <= 64 && std::ranges::all_of(text, [](char c) {
    return is_digit(c) || is_letter(c) || c == '-' || c == '_' || c == '.';
  });
}

/// The request without its body.
HttpRequest request_of(RequestHead& head) {
  HttpRequest request;
  request.method = std::move(head.method);
  request.path = std::move(head.path);
  request.query = std::move(head.query);
  for (Field& field : head.fields) {
    const auto [it, fresh] = request.headers.try_emplace(std::move(field.name), field.value);
    if (!fresh) it->second += ", " + field.value;
  }
  head.fields.clear();
  // HTTP/1.0 knows no Host: it is for whom it was sent to (RFC 9112, 3.3). Browsers send one.
  request.headers.try_emplace("host", "localhost");
  const std::string_view given = request.header("x-request-id");
  request.id = is_request_id(given) ? std::string(given) : new_request_id();
  return request;
}

}  // namespace

Exchange::Exchange(RequestHead&& its_head, std::uint64_t limit)
    : head(std::move(its_head)), request(request_of(head)), body(head.framing, limit) {}

std::string new_request_id() {
  thread_local std::mt19937_64 numbers{std::random_device()()};
  const std::uint64_t number = numbers();
  return hex(std::span(reinterpret_cast<const unsigned char*>(&number), sizeof number));
}

}  // namespace translucube::server

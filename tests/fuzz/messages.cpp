// What is read of a connection's bytes, held against a second reader, Boost.Beast's: what we accept
// it accepts, and takes for the same. We may be stricter (RFC 9112's choices), never looser. And
// however the bytes are cut, we read the same.

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>
#include <limits>
#include <map>

#include "api/base/text.h"
#include "server/http/body_reader.h"
#include "server/http/head_scan.h"
#include "server/http/request_head.h"
#include "server/http/request_target.h"
#include "tests/fuzz/requests.h"

using namespace translucube;
using namespace translucube::server;
using fuzz::require;
namespace http = boost::beast::http;

namespace {

constexpr std::uint64_t limit = 1 << 20;

struct Message {
  RequestHead head;
  std::string body;
  std::size_t size = 0;  ///< where the next one begins
};

/// The first message of the bytes, fed in pieces of so many; empty where it is refused or not
/// whole.
std::optional<Message> ours(std::string_view bytes, std::size_t step) {
  HeadScan scan;
  HeadScan::State state = HeadScan::State::begun;
  for (std::size_t given = 0; given < bytes.size() && state == HeadScan::State::begun;) {
    given = std::min(bytes.size(), given + step);
    state = scan.scan(bytes.substr(0, given));
  }
  if (state != HeadScan::State::whole) return std::nullopt;
  auto head = read_request_head(bytes.substr(0, scan.size()));
  if (!head) return std::nullopt;
  BodyReader body(head->framing, limit);
  std::size_t at = scan.size();
  while (!body.whole() && !body.fault() && at < bytes.size()) {
    std::string_view piece = bytes.substr(at, step);
    const std::size_t size = piece.size();
    body.take(piece);
    at += size - piece.size();
  }
  if (!body.whole()) return std::nullopt;
  return Message{*std::move(head), body.release(), at};
}

struct Other {
  http::request<http::string_body> message;
  http::fields fields;  ///< those of its head
};

/// The message, if Beast accepts it and sees its end where these bytes end.
std::optional<Other> beast(std::string_view bytes) {
  http::request_parser<http::string_body> parser;
  parser.header_limit(std::numeric_limits<std::uint32_t>::max());
  parser.body_limit(std::numeric_limits<std::uint64_t>::max());
  std::size_t used = 0;
  http::fields fields;
  while (!parser.is_done()) {
    if (parser.is_header_done() && !parser.eager()) {
      fields = parser.get().base();
      parser.eager(true);
    }
    boost::system::error_code error;
    const std::size_t took =
        parser.put(boost::asio::buffer(bytes.data() + used, bytes.size() - used), error);
    used += took;
    if (error || took == 0) return std::nullopt;
  }
  if (!parser.eager()) fields = parser.get().base();
  require(used == bytes.size(), "both see the same end");
  return Other{parser.release(), std::move(fields)};
}

std::string_view std_view(boost::beast::string_view text) { return {text.data(), text.size()}; }

/// A message in chunks without its trailers, which Beast reads as if they were headers.
std::string without_trailers(std::string_view message) {
  message.remove_suffix(2);
  while (true) {
    const std::size_t line = message.rfind("\r\n", message.size() - 3) + 2;
    if (!read_field_line(message.substr(line, message.size() - 2 - line))) break;
    message = message.substr(0, line);
  }
  return std::string(message) + "\r\n";
}

using Fields = std::multimap<std::string, std::string>;

void compare(const Message& mine, const Other& other) {
  const auto& [message, fields] = other;
  require(mine.body == message.body(), "both see the same body");
  require(mine.head.method == std_view(message.method_string()), "the same method");
  const auto target = read_target(mine.head.method, std_view(message.target()));
  require(target && (target->path == mine.head.path) && target->query == mine.head.query,
          "the same target");
  require(mine.head.minor == (message.version() == 10 ? 0 : 1), "the same version");
  Fields my_fields, its_fields;
  for (const Field& field : mine.head.fields) my_fields.emplace(field.name, field.value);
  for (const auto& field : fields)
    its_fields.emplace(api::lower_case(std_view(field.name_string())),
                       std::string(std_view(field.value())));
  if (target->authority) {
    require(my_fields.find("host")->second == *target->authority, "the authority is the host");
    my_fields.erase("host");
    its_fields.erase("host");
  }
  require(my_fields == its_fields, "the same fields");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  std::string_view bytes(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::size_t step = 1 + data[0] % 32;
  while (!bytes.empty()) {
    while (bytes.starts_with("\r\n")) bytes.remove_prefix(2);
    const auto mine = ours(bytes, bytes.size());
    const auto in_pieces = ours(bytes, step);
    require(mine.has_value() == in_pieces.has_value(), "cut or not, it is accepted or not");
    if (!mine) return 0;
    require(mine->size == in_pieces->size && mine->body == in_pieces->body, "cut or not, the same");
    const std::string_view message = bytes.substr(0, mine->size);
    const auto other =
        beast(mine->head.framing.chunked ? without_trailers(message) : std::string(message));
    // Beast knows no later minor version.
    const std::string_view line = bytes.substr(0, bytes.find('\r'));
    const bool later = !line.ends_with("HTTP/1.0") && !line.ends_with("HTTP/1.1");
    require(other.has_value() || later, "what we accept is accepted");
    if (other) compare(*mine, *other);
    bytes.remove_prefix(mine->size);
  }
  return 0;
}

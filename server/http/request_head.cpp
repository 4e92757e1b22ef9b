#include "server/http/request_head.h"

#include <algorithm>
#include <limits>

#include "api/base/text.h"
#include "server/http/grammar.h"
#include "server/http/request_target.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;
using api::Result;

constexpr std::size_t most_fields = 100;

Problem malformed(const char* detail) { return {ProblemCode::malformed_http, detail, {}}; }

struct RequestLine {
  std::string_view method, target;
  int minor;
};

/// RFC 9112, 3: single spaces; the version has a case.
Result<RequestLine> read_request_line(std::string_view line) {
  RequestLine read{};
  read.method = take_until(line, " ");
  read.target = take_until(line, " ");
  const bool has_version = line.size() == 8 && line.starts_with("HTTP/") && is_digit(line[5]) &&
                           line[6] == '.' && is_digit(line[7]);
  if (!is_token(read.method) || read.target.empty() || !has_version)
    return malformed("The request line is not that of HTTP/1.1.");
  if (line[5] != '1')
    return Problem{
        ProblemCode::version_not_supported, "Only HTTP/1.1 and 1.0 are spoken here.", {}};
  // RFC 9110, 6.2: a later minor version is read as the latest that is known.
  read.minor = line[7] == '0' ? 0 : 1;
  return read;
}

/// The elements of a list (RFC 9110, 5.6.1) in all fields of the name, in lower case, empty ones
/// too.
std::vector<std::string> elements(const RequestHead& head, std::string_view name) {
  std::vector<std::string> all;
  for (const Field& field : head.fields) {
    if (field.name != name) continue;
    const std::string_view value = field.value;
    for (std::size_t start = 0, end = 0; end != value.npos; start = end + 1) {
      end = value.find(',', start);
      all.push_back(api::lower_case(trimmed(value.substr(start, end - start))));
    }
  }
  return all;
}

/// Connection (RFC 9110, 7.6.1; RFC 9112, 9.3). False where it is no list of options.
bool read_connection(RequestHead& head) {
  const std::vector<std::string> options = elements(head, "connection");
  const auto has = [&](const char* option) {
    return std::ranges::find(options, option) != options.end();
  };
  head.keep_alive = !has("close") && (head.minor > 0 || has("keep-alive"));
  return std::ranges::all_of(
      options, [](const std::string& option) { return option.empty() || is_token(option); });
}

auto count(const RequestHead& head, std::string_view name) {
  return std::ranges::count(head.fields, name, &Field::name);
}

/// Transfer-Encoding (RFC 9112, 6.1): nothing but "chunked" is known, and it must be the last.
std::optional<Problem> coding_problem(const RequestHead& head) {
  const std::vector<std::string> codings = elements(head, "transfer-encoding");
  if (head.minor == 0) return malformed("HTTP/1.0 has no Transfer-Encoding.");
  if (count(head, "content-length") > 0)
    return malformed("The body has both a Content-Length and a Transfer-Encoding.");
  if (codings.back() != "chunked" || std::ranges::count(codings, "chunked") != 1 ||
      !std::ranges::all_of(codings, is_token))
    return malformed("The Transfer-Encoding does not say where the body ends.");
  if (codings.size() > 1)
    return Problem{
        ProblemCode::not_implemented, "No transfer coding but chunked is understood.", {}};
  return std::nullopt;
}

/// RFC 9112, 6.3. Several lengths, though the same, are refused.
Result<Framing> read_framing(const RequestHead& head) {
  if (count(head, "transfer-encoding") > 0) {
    if (auto problem = coding_problem(head)) return *std::move(problem);
    return Framing{true, 0};
  }
  const auto lengths = count(head, "content-length");
  if (lengths == 0) return Framing{};
  const std::string text = *head.value("content-length");
  if (lengths > 1 || !is_digits(text)) return malformed("The Content-Length is no number.");
  // A number too large to be held is one too large to be taken.
  return Framing{false, api::number_of<std::uint64_t>(text).value_or(
                            std::numeric_limits<std::uint64_t>::max())};
}

/// RFC 9112, 3.2: one Host field with a right value, which HTTP/1.0 may do without.
bool has_right_host(const RequestHead& head) {
  const auto hosts = count(head, "host");
  return hosts == 1 ? is_host(*head.value("host")) : hosts == 0 && head.minor == 0;
}

/// Expect (RFC 9110, 10.1.1), which HTTP/1.0 has not.
void read_expectation(RequestHead& head) {
  if (head.minor == 0) return;
  for (const std::string& expectation : elements(head, "expect")) {
    if (expectation == "100-continue")
      head.expects_continue = true;
    else if (!expectation.empty())
      head.expects_more = true;
  }
}

void put_authority(RequestHead& head, const std::string& authority) {
  std::erase_if(head.fields, [](const Field& field) { return field.name == "host"; });
  head.fields.push_back({"host", authority});
}

/// Field lines up to the empty one.
std::optional<Problem> fields_problem(std::string_view lines, std::vector<Field>& fields) {
  while (!lines.starts_with("\r\n")) {
    auto field = read_field_line(take_until(lines, "\r\n"));
    if (!field) return malformed("A header is not \"name: value\".");
    if (fields.size() == most_fields)
      return Problem{ProblemCode::headers_too_large, "There are more than 100 headers.", {}};
    fields.push_back(*std::move(field));
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> RequestHead::value(std::string_view lower_case_name) const {
  std::optional<std::string> joined;
  for (const Field& field : fields) {
    if (field.name != lower_case_name) continue;
    joined = joined ? *joined + ", " + field.value : field.value;
  }
  return joined;
}

std::optional<Field> read_field_line(std::string_view line) {
  const std::size_t colon = line.find(':');
  if (colon == line.npos) return std::nullopt;
  // White space before the colon, or a fold at the line's start, is in no token (RFC 9112, 5.1 and
  // 5.2).
  const std::string_view name = line.substr(0, colon), value = trimmed(line.substr(colon + 1));
  const auto is_text = [](char c) { return (c >= ' ' || c < 0 || c == '\t') && c != 0x7f; };
  if (!is_token(name) || !std::ranges::all_of(value, is_text)) return std::nullopt;
  return Field{api::lower_case(name), std::string(value)};
}

Result<RequestHead> read_request_head(std::string_view bytes) {
  const auto line = read_request_line(take_until(bytes, "\r\n"));
  if (!line) return line.problem();
  RequestHead head;
  head.method = line->method;
  head.minor = line->minor;
  if (auto problem = fields_problem(bytes, head.fields)) return *std::move(problem);
  if (!has_right_host(head)) return malformed("There must be one Host header, host or host:port.");
  auto target = read_target(head.method, line->target);
  if (!target) return malformed("The target of the request is none of this method.");
  head.path = std::move(target->path);
  head.query = std::move(target->query);
  // RFC 9112, 3.2.2: the target's authority is the host, whatever the Host field says.
  if (target->authority) put_authority(head, *target->authority);
  const auto framing = read_framing(head);
  if (!framing) return framing.problem();
  head.framing = *framing;
  if (!read_connection(head)) return malformed("The Connection header is no list of options.");
  read_expectation(head);
  return head;
}

}  // namespace translucube::server

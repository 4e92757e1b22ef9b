#include "api/base/problem.h"

#include <array>
#include <cstddef>
#include <nlohmann/json.hpp>

namespace translucube::api {
namespace {

/// A pointer may hold a client's key: nothing of it may drive a terminal. Control characters are
/// ASCII's and U+0080 to U+009F, in UTF-8 a byte C2 and one below A0.
std::string printable(std::string text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool c1 =
        byte == 0xC2 && i + 1 < text.size() && static_cast<unsigned char>(text[i + 1]) < 0xA0;
    if (c1) text.erase(i, 1);
    if (c1 || byte < 0x20 || byte == 0x7F) text[i] = '?';
  }
  return text;
}

/// In the order of ProblemCode.
constexpr std::array kinds = [] {
  using enum ProblemCode;
  return std::array{
      ProblemKind{malformed_http, "urn:translucube:problem:malformed-http", 400,
                  "The message is not HTTP"},
      ProblemKind{malformed_json, "urn:translucube:problem:malformed-json", 400,
                  "The document is not JSON"},
      ProblemKind{invalid_request, "urn:translucube:problem:invalid-request", 422,
                  "The request is not valid"},
      ProblemKind{idempotency_mismatch, "urn:translucube:problem:idempotency-mismatch", 422,
                  "The idempotency key was used with another request"},
      ProblemKind{unauthorized, "urn:translucube:problem:unauthorized", 401, "A token is needed"},
      ProblemKind{forbidden, "urn:translucube:problem:forbidden", 403,
                  "This is not for pages of other origins"},
      ProblemKind{not_found, "urn:translucube:problem:not-found", 404,
                  "There is no such thing here"},
      ProblemKind{gone, "urn:translucube:problem:gone", 410, "It is no longer here"},
      ProblemKind{method_not_allowed, "urn:translucube:problem:method-not-allowed", 405,
                  "The method is not allowed here"},
      ProblemKind{not_implemented, "urn:translucube:problem:not-implemented", 501,
                  "The service has no such thing"},
      ProblemKind{version_not_supported, "urn:translucube:problem:version-not-supported", 505,
                  "The version of HTTP is not spoken here"},
      ProblemKind{expectation_failed, "urn:translucube:problem:expectation-failed", 417,
                  "The expectation cannot be met"},
      ProblemKind{precondition_failed, "urn:translucube:problem:precondition-failed", 412,
                  "The resource is not in the state that was asked for"},
      ProblemKind{not_acceptable, "urn:translucube:problem:not-acceptable", 406,
                  "There is no such representation"},
      ProblemKind{request_timeout, "urn:translucube:problem:request-timeout", 408,
                  "The request took too long to arrive"},
      ProblemKind{conflict, "urn:translucube:problem:conflict", 409,
                  "The state of the resource does not allow this"},
      ProblemKind{not_ready, "urn:translucube:problem:not-ready", 409,
                  "The render is not finished"},
      ProblemKind{payload_too_large, "urn:translucube:problem:payload-too-large", 413,
                  "The body is too large"},
      ProblemKind{uri_too_long, "urn:translucube:problem:uri-too-long", 414, "The URI is too long"},
      ProblemKind{unsupported_media_type, "urn:translucube:problem:unsupported-media-type", 415,
                  "The body must be application/json"},
      ProblemKind{range_not_satisfiable, "urn:translucube:problem:range-not-satisfiable", 416,
                  "The range is not in the file"},
      ProblemKind{queue_full, "urn:translucube:problem:queue-full", 429, "The queue is full"},
      ProblemKind{misdirected, "urn:translucube:problem:misdirected", 421,
                  "The request is for another host"},
      ProblemKind{headers_too_large, "urn:translucube:problem:headers-too-large", 431,
                  "The headers are too large"},
      ProblemKind{overloaded, "urn:translucube:problem:overloaded", 503, "The service is busy"},
      ProblemKind{storage_failure, "urn:translucube:problem:storage-failure", 507,
                  "The service cannot store"},
      ProblemKind{internal, "urn:translucube:problem:internal", 500, "The service failed"}};
}();
static_assert(kinds.size() == static_cast<std::size_t>(ProblemCode::internal) + 1);
static_assert([] {
  for (std::size_t i = 0; i < kinds.size(); ++i)
    if (kinds[i].code != static_cast<ProblemCode>(i)) return false;
  return true;
}());

}  // namespace

const ProblemKind& kind(ProblemCode code) { return kinds[static_cast<std::size_t>(code)]; }

std::string to_json(const Problem& problem) {
  const ProblemKind& what = kind(problem.code);
  nlohmann::json document{{"type", what.type},
                          {"title", what.title},
                          {"status", what.status},
                          {"detail", problem.detail}};
  if (!problem.faults.empty()) {
    nlohmann::json& errors = document["errors"] = nlohmann::json::array();
    for (const Fault& fault : problem.faults)
      errors.push_back({{"pointer", fault.pointer}, {"detail", fault.detail}});
  }
  // A detail may hold a library's message: bytes that are not UTF-8 must not become an exception.
  return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string to_text(const Problem& problem) {
  std::string text = kind(problem.code).title;
  if (!problem.detail.empty()) text += ": " + printable(problem.detail);
  text += '\n';
  for (const Fault& fault : problem.faults) {
    const std::string where = fault.pointer.empty() ? "(document)" : printable(fault.pointer);
    text += "  " + where + ": " + printable(fault.detail) + '\n';
  }
  return text;
}

}  // namespace translucube::api

#include "api/base/problem.h"

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

}  // namespace

const ProblemKind& kind(ProblemCode code) {
  static constexpr ProblemKind malformed_http{"urn:translucube:problem:malformed-http", 400,
                                              "The message is not HTTP"};
  static constexpr ProblemKind malformed_json{"urn:translucube:problem:malformed-json", 400,
                                              "The document is not JSON"};
  static constexpr ProblemKind invalid_request{"urn:translucube:problem:invalid-request", 422,
                                               "The request is not valid"};
  static constexpr ProblemKind idempotency_mismatch{
      "urn:translucube:problem:idempotency-mismatch", 422,
      "The idempotency key was used with another request"};
  static constexpr ProblemKind unauthorized{"urn:translucube:problem:unauthorized", 401,
                                            "A token is needed"};
  static constexpr ProblemKind forbidden{"urn:translucube:problem:forbidden", 403,
                                         "This is not for pages of other origins"};
  static constexpr ProblemKind not_found{"urn:translucube:problem:not-found", 404,
                                         "There is no such thing here"};
  static constexpr ProblemKind gone{"urn:translucube:problem:gone", 410, "It is no longer here"};
  static constexpr ProblemKind method_not_allowed{"urn:translucube:problem:method-not-allowed", 405,
                                                  "The method is not allowed here"};
  static constexpr ProblemKind not_acceptable{"urn:translucube:problem:not-acceptable", 406,
                                              "There is no such representation"};
  static constexpr ProblemKind request_timeout{"urn:translucube:problem:request-timeout", 408,
                                               "The request took too long to arrive"};
  static constexpr ProblemKind conflict{"urn:translucube:problem:conflict", 409,
                                        "The state of the resource does not allow this"};
  static constexpr ProblemKind not_ready{"urn:translucube:problem:not-ready", 409,
                                         "The render is not finished"};
  static constexpr ProblemKind payload_too_large{"urn:translucube:problem:payload-too-large", 413,
                                                 "The body is too large"};
  static constexpr ProblemKind uri_too_long{"urn:translucube:problem:uri-too-long", 414,
                                            "The URI is too long"};
  static constexpr ProblemKind unsupported_media_type{
      "urn:translucube:problem:unsupported-media-type", 415, "The body must be application/json"};
  static constexpr ProblemKind range_not_satisfiable{
      "urn:translucube:problem:range-not-satisfiable", 416, "The range is not in the file"};
  static constexpr ProblemKind queue_full{"urn:translucube:problem:queue-full", 429,
                                          "The queue is full"};
  static constexpr ProblemKind misdirected{"urn:translucube:problem:misdirected", 421,
                                           "The request is for another host"};
  static constexpr ProblemKind headers_too_large{"urn:translucube:problem:headers-too-large", 431,
                                                 "The headers are too large"};
  static constexpr ProblemKind overloaded{"urn:translucube:problem:overloaded", 503,
                                          "The service is busy"};
  static constexpr ProblemKind storage_failure{"urn:translucube:problem:storage-failure", 507,
                                               "The service cannot store"};
  static constexpr ProblemKind internal{"urn:translucube:problem:internal", 500,
                                        "The service failed"};
  switch (code) {
    case ProblemCode::malformed_http:
      return malformed_http;
    case ProblemCode::malformed_json:
      return malformed_json;
    case ProblemCode::invalid_request:
      return invalid_request;
    case ProblemCode::idempotency_mismatch:
      return idempotency_mismatch;
    case ProblemCode::unauthorized:
      return unauthorized;
    case ProblemCode::forbidden:
      return forbidden;
    case ProblemCode::not_found:
      return not_found;
    case ProblemCode::gone:
      return gone;
    case ProblemCode::method_not_allowed:
      return method_not_allowed;
    case ProblemCode::not_acceptable:
      return not_acceptable;
    case ProblemCode::request_timeout:
      return request_timeout;
    case ProblemCode::conflict:
      return conflict;
    case ProblemCode::not_ready:
      return not_ready;
    case ProblemCode::payload_too_large:
      return payload_too_large;
    case ProblemCode::uri_too_long:
      return uri_too_long;
    case ProblemCode::unsupported_media_type:
      return unsupported_media_type;
    case ProblemCode::range_not_satisfiable:
      return range_not_satisfiable;
    case ProblemCode::queue_full:
      return queue_full;
    case ProblemCode::misdirected:
      return misdirected;
    case ProblemCode::headers_too_large:
      return headers_too_large;
    case ProblemCode::overloaded:
      return overloaded;
    case ProblemCode::storage_failure:
      return storage_failure;
    case ProblemCode::internal:
      return internal;
  }
  return internal;
}

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

#pragma once

// The room of what all documents share: they are read strictly (json_reader.h, field_reader.h),
// what is wrong is told with its place (faults.h), and a refusal is a Problem. It knows nothing of
// what a document is about.

#include <string>
#include <vector>

namespace translucube::api {

/// One fault of a document: where (RFC 6901 JSON pointer, "" for the whole) and what.
struct Fault {
  std::string pointer;
  std::string detail;
  friend bool operator==(const Fault&, const Fault&) = default;
};

/// Every way in which the service refuses. One table (problem.cpp) has for each a stable type URI,
/// an HTTP status and a title; internal is the last.
enum class ProblemCode {
  malformed_http,  // the message is not HTTP, or its body has no clear end
  malformed_json,
  invalid_request,
  idempotency_mismatch,
  unauthorized,  // no token, or none that the service knows
  forbidden,     // a web page of another origin
  not_found,
  gone,  // removed to make room
  method_not_allowed,
  not_implemented,  // a method or a transfer coding that the service has not
  version_not_supported,
  expectation_failed,
  precondition_failed,  // If-Match or If-None-Match
  not_acceptable,
  request_timeout,  // the head of the request did not come in time
  conflict,         // the state does not allow it (image of a failed render, ...)
  not_ready,        // the image of a render that is still queued or running
  payload_too_large,
  uri_too_long,
  unsupported_media_type,
  range_not_satisfiable,
  queue_full,
  misdirected,  // for a host that the service is not
  headers_too_large,
  overloaded,
  storage_failure,  // full disk, store not writable
  internal,
};

struct ProblemKind {
  ProblemCode code;
  const char* type;  ///< stable, e.g. "urn:translucube:problem:invalid-request"
  int status;
  const char* title;
};
const ProblemKind& kind(ProblemCode code);

/// An RFC 9457 problem: what `application/problem+json` carries.
struct Problem {
  ProblemCode code = ProblemCode::internal;
  std::string detail;
  std::vector<Fault> faults;
};
/// The JSON text. Never echoes a client's document.
std::string to_json(const Problem& problem);
/// The text for a terminal: title, detail, then a line "pointer: detail" for each fault.
std::string to_text(const Problem& problem);

}  // namespace translucube::api

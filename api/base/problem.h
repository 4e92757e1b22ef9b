#pragma once

#include <string>
#include <vector>

namespace translucube::api {

/// One fault of a document: where (RFC 6901 JSON pointer, "" for the whole) and what.
struct Fault {
  std::string pointer;
  std::string detail;
  friend bool operator==(const Fault&, const Fault&) = default;
};

/// Every way in which the service refuses, in one table (problem.cpp): code -> stable type URI,
/// HTTP status, title.
enum class ProblemCode {
  malformed_http,          // 400: the message is not HTTP, or its body has no clear end
  malformed_json,          // 400
  invalid_request,         // 422
  idempotency_mismatch,    // 422
  unauthorized,            // 401: no token, or none that the service knows
  forbidden,               // 403: a web page of another origin
  not_found,               // 404
  gone,                    // 410: removed to make room
  method_not_allowed,      // 405
  not_acceptable,          // 406
  request_timeout,         // 408: the head of the request did not come in time
  conflict,                // 409: the state does not allow it (image of a failed render, ...)
  not_ready,               // 409: the image of a render that is still queued or running
  payload_too_large,       // 413
  uri_too_long,            // 414
  unsupported_media_type,  // 415
  range_not_satisfiable,   // 416
  queue_full,              // 429
  misdirected,             // 421: for a host that the service is not
  headers_too_large,       // 431
  overloaded,              // 503
  storage_failure,         // 507: full disk, store not writable
  internal,                // 500
};

struct ProblemKind {
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
/// The same for a terminal: title, detail, then a line "pointer: detail" for each fault.
std::string to_text(const Problem& problem);

}  // namespace translucube::api

#pragma once

#include <chrono>

#include "server/http/body_reader.h"
#include "server/http/message.h"
#include "server/http/request_head.h"

namespace translucube::server {

/// A request whose head was read, until its answer is sent.
struct Exchange {
  /// `limit`: of the body [bytes].
  Exchange(RequestHead&& its_head, std::uint64_t limit);

  RequestHead head;  ///< without what `request` has of it
  HttpRequest request;
  BodyReader body;
  std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
};

/// Names a request in log and answer; it need not be hard to guess.
std::string new_request_id();

}  // namespace translucube::server

#pragma once

// The calls of the service (design.md, section 3) over plain requests and answers.

#include <atomic>
#include <string>
#include <string_view>
#include <vector>

#include "api/base/problem.h"
#include "api/request/catalog.h"
#include "picture/color.h"
#include "server/http/message.h"
#include "server/service/job_service.h"

namespace translucube::server {

struct Endpoints {
  JobService& service;
  const api::Catalog& catalog;
  const ColorConfig& colors;
  /// Each request that waits and each event stream holds a thread: past so many, a wait is not
  /// honoured and a stream is refused, so that probes and statuses keep answering.
  std::atomic<int> waiting = 0, streams = 0;
};

/// The answer to any request; a failure of ours that is not foreseen passes as an exception.
HttpResponse respond(Endpoints& endpoints, const HttpRequest& request);

struct Call {
  std::string_view method, pattern;     ///< "GET", "/v1/renders/{id}"
  std::vector<std::string_view> query;  ///< the parameters it knows
};
/// Every call that `respond` knows.
std::vector<Call> calls();

HttpResponse problem_response(const api::Problem& problem);

}  // namespace translucube::server

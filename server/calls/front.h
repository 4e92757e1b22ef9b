#pragma once

#include <string>
#include <string_view>

#include "server/base/metrics.h"
#include "server/base/places.h"
#include "server/calls/access.h"
#include "server/http/server.h"

namespace translucube::server {

/// What stands before the calls: access, /metrics, the log and the counts of every request.
/// Outlives the server that has its handlers.
class Front {
 public:
  using Respond = std::function<HttpResponse(const HttpRequest&)>;
  /// Of what was admitted, once its headers are known (HttpHandlers::admit).
  using Receive = std::function<std::optional<HttpResponse>(HttpRequest&)>;

  Front(
      AccessPolicy policy, Metrics& metrics, Respond respond,
      Receive receive = [](HttpRequest&) { return std::nullopt; });

  HttpHandlers handlers();

 private:
  std::optional<HttpResponse> admit(HttpRequest& request) const;
  HttpResponse respond(const HttpRequest& request) const;
  HttpResponse metrics_response(const HttpRequest& request) const;
  void done(const RequestRecord& record) const;

  const AccessPolicy policy_;
  Metrics& metrics_;
  const Respond respond_;
  const Receive receive_;
  mutable Places scrapes_{4};  ///< of the metrics, at once
};

/// The pattern of a path (/v1/renders/{id}/image) for log and metrics, "other" if it has none: a
/// client cannot make up values.
std::string_view route_of(std::string_view path);

}  // namespace translucube::server

#pragma once

// The calls over a service in a folder of its own, without a socket.

#include "server/calls/router.h"
#include "tests/server/fixture.h"

namespace translucube::server::test {

struct CallsUnderTest {
  using Query = std::vector<std::pair<std::string, std::string>>;
  using Headers = std::map<std::string, std::string>;

  /// Over the renderer that is not there.
  explicit CallsUnderTest(int workers = 1, StoreOptions store = {})
      : CallsUnderTest(ServiceOptions{workers, std::move(store)}) {}
  explicit CallsUnderTest(ServiceOptions options)
      : service(folder.path(), renderer.engine(), std::move(options)) {}
  explicit CallsUnderTest(Engine engine) : service(folder.path(), std::move(engine)) {}

  HttpResponse get(const std::string& path, Query query = {}, Headers headers = {}) {
    return respond(context, {"GET", path, std::move(query), std::move(headers), {}});
  }
  HttpResponse get_image(const std::string& id, Query query = {}) {
    return get("/v1/renders/" + id + "/image", std::move(query));
  }
  /// The events of a render, after those that the client has.
  HttpResponse listen(const std::string& id, const std::string& last = {}) {
    return get("/v1/renders/" + id + "/events", {},
               last.empty() ? Headers{} : Headers{{"last-event-id", last}});
  }

  TempFolder folder;
  FakeRenderer renderer;
  TestService service;
  CallContext context{service.service, service.uploads, service.catalog, service.colors,
                      service.config};
};

inline std::string header(const HttpResponse& response, const std::string& name) {
  for (const auto& [key, value] : response.headers)
    if (key == name) return value;
  return {};
}

}  // namespace translucube::server::test

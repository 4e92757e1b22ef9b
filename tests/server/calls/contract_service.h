#pragma once

// The service as it is served, socket and all, but for its renderer; and a client that holds every
// answer against the OpenAPI document.

#include "server/calls/front.h"
#include "tests/server/calls/calls_under_test.h"
#include "tests/server/calls/contract.h"

namespace translucube::server::test {

/// An id that no service ever gave.
inline const std::string no_such_id = "01ARZ3NDEKTSV4RRFFQ69G5FAV";

/// The pattern with an id, the point 0 and a file of the explorer in its places.
inline std::string path_of(std::string pattern, const std::string& id) {
  for (const auto& [place, text] : {std::pair<std::string, std::string>{"{id}", id},
                                    {"{point}", "0"},
                                    {"{file}", "style.css"},
                                    {"{sha256}", id == no_such_id ? std::string(64, '0') : id}})
    if (const auto at = pattern.find(place); at != pattern.npos)
      pattern.replace(at, place.size(), text);
  return pattern;
}

/// Answers over a socket, by any means.
class Served {
 public:
  explicit Served(
      Front::Respond respond, AccessPolicy policy = {},
      Front::Receive receive = [](HttpRequest&) { return std::nullopt; })
      : front_(std::move(policy), metrics_, std::move(respond), std::move(receive)),
        server_(front_.handlers(), {}) {
    thread_ = std::jthread([this] { server_.run(); });
    while (!server_.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ~Served() { server_.stop(); }

  int port() const { return server_.port(); }

 private:
  Metrics metrics_;
  Front front_;
  HttpServer server_;
  std::jthread thread_;
};

class Caller {
 public:
  Caller(Contract& contract, int port) : contract_(contract), client_("127.0.0.1", port) {
    client_.set_read_timeout(120);
    for (Operation& operation : contract.operations()) operations_[operation.id] = operation;
  }

  /// Any request; the answer is not looked at.
  Answer send(const std::string& method, const std::string& path,
              const httplib::Headers& headers = {}, const std::string& body = {}) {
    httplib::Request request;
    request.method = method;
    request.path = path;
    request.headers = headers;
    request.body = body;
    if (!body.empty() && headers.count("Content-Type") == 0)
      request.set_header("Content-Type", "application/json");
    const httplib::Result result = client_.send(request);
    if (!result) {
      ADD_FAILURE() << method << ' ' << path << ": " << httplib::to_string(result.error());
      return {};
    }
    return {result->status, {result->headers.begin(), result->headers.end()}, result->body};
  }

  /// An operation of the document, by its id, and what is to come of it. `rest` follows the path.
  Answer call(const std::string& operation_id, int status, const std::string& id = no_such_id,
              const std::string& rest = {}, const httplib::Headers& headers = {},
              const std::string& body = {}) {
    SCOPED_TRACE(operation_id + rest);
    const Operation& operation = operations_.at(operation_id);
    const Answer answer =
        send(operation.method, path_of(operation.pattern, id) + rest, headers, body);
    EXPECT_EQ(answer.status, status) << answer.body;
    contract_.check(operation, answer);
    return answer;
  }

 private:
  Contract& contract_;
  httplib::Client client_;
  std::map<std::string, Operation> operations_;
};

/// A service of its own folder. Without workers, what it takes stays queued.
struct Live : CallsUnderTest {
  Live(Contract& contract, int workers, StoreOptions store = {})
      : Live(contract, ServiceOptions{workers, std::move(store)}) {}
  Live(Contract& contract, ServiceOptions options)
      : CallsUnderTest(std::move(options)),
        served([this](const HttpRequest& request) { return respond(context, request); }, {},
               [this](HttpRequest& request) { return receive(context, request); }),
        caller(contract, served.port()) {}

  Served served;
  Caller caller;
};

}  // namespace translucube::server::test

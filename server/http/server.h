#pragma once

// The room of HTTP: sockets to plain requests, plain answers to sockets, whatever clients send.
// Bytes go one way: Listener -> Lobby, where a Connection waits without a thread until HeadScan and
// BodyReader have all of a request -> ThreadPool -> handlers -> write_answer. What a request means
// is told in server/calls.

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>

#include "server/http/message.h"

namespace translucube::server {

struct ListenError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct HttpOptions {
  std::string host = "127.0.0.1";
  int port = 0;  ///< 0: any free one
  std::uint64_t body_bytes = 1 << 20;
  /// Requests that are under way at once, those that wait, stream or transfer included; threads for
  /// those in line, and one for what is urgent, come on top.
  int threads = 64;
  int answering = 16;     ///< of them, those that are answered: that did not give way
  int in_line = 64;       ///< that may stand in line for it; of more, each gets 503 at once
  int transfers = 32;     ///< threads that may wait for clients that read slowly at once
  int connections = 512;  ///< open at once; of more, the one idle for longest is closed
  std::chrono::milliseconds header_timeout{10'000}, idle_timeout{60'000}, transfer_timeout{20'000};
};

/// A request that was answered, for log and metrics.
struct RequestRecord {
  std::string id, client;
  std::string method, path;  ///< "" where none could be read
  int status = 0;
  double seconds = 0;       ///< from its head to the last byte of its answer
  std::uint64_t bytes = 0;  ///< sent, headers included
};

/// What the server calls for each request, from many threads.
struct HttpHandlers {
  /// Called with the headers, before a body is read. Sets `client` and, where the body is not for
  /// memory, `body_file`; or refuses.
  std::function<std::optional<HttpResponse>(HttpRequest&)> admit = [](HttpRequest&) {
    return std::nullopt;
  };
  /// The answer. An exception becomes a 500 that says nothing of it.
  std::function<HttpResponse(const HttpRequest&)> respond;
  /// What is answered at once, whatever else there is to do; it must not take long.
  std::function<bool(const HttpRequest&)> urgent = [](const HttpRequest&) { return false; };
  std::function<void(const RequestRecord&)> done = [](const RequestRecord&) {};
};

/// HTTP on a TCP port.
class HttpServer {
 public:
  /// Binds; connections queue up from here on. Throws ListenError if the port cannot be had.
  HttpServer(HttpHandlers handlers, const HttpOptions& options);
  ~HttpServer();

  int port() const;
  void run();               ///< answers requests until stopped; waits for those under way
  void stop();              ///< from any thread, also before or after run; streams end
  bool is_running() const;  ///< the accepting loop has begun

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace translucube::server

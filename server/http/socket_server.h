#pragma once

// The library's server over our connections: it parses requests and writes answers, while who is
// waited for, and for how long, is decided here. It would give each connection a thread for as
// long as it stays open.

#include <httplib.h>

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "api/base/problem.h"
#include "server/http/lobby.h"
#include "server/http/server.h"
#include "server/http/thread_pool.h"

namespace translucube::server {

class SocketServer : public httplib::Server {
 public:
  /// `refusal` gives the bytes for a connection that is closed before its request is read.
  SocketServer(const HttpOptions& options, std::function<std::string(api::ProblemCode)> refusal);

  /// The library listens with a queue of five connections.
  void deepen_queue();

  ~SocketServer() override { close_all(); }

  /// From here on nobody waits for clients, and streams end.
  void begin_stop() { stopping_ = true; }
  bool stopping() const { return stopping_; }

  /// The connection that this thread serves.
  static Connection& connection();

 private:
  bool process_and_close_socket(socket_t socket) override;
  void serve(std::unique_ptr<Connection> connection);
  void close_all();

  const std::function<std::string(api::ProblemCode)> refusal_;
  std::atomic<bool> stopping_ = false;
  Places connections_, transfers_;
  ConnectionRules rules_;
  Lobby lobby_;
  ThreadPool pool_;
};

}  // namespace translucube::server

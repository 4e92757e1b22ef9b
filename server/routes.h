#pragma once

#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "server/endpoints.h"

namespace translucube::server {

struct ListenError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct HttpOptions {
  std::string host = "127.0.0.1";
  int port = 0;  ///< 0: any free one
  int threads = 16;
  std::uint64_t body_bytes = 1 << 20;
};

/// The endpoints on a TCP port. routes.cpp is the only file that includes httplib.
class HttpServer {
 public:
  /// Binds; connections queue up from here on. Throws ListenError if the port cannot be had.
  HttpServer(Endpoints& endpoints, const HttpOptions& options);
  ~HttpServer();

  int port() const;
  void run();               ///< answers requests until stopped; waits for those under way
  void stop();              ///< from any thread, also before or after run
  bool is_running() const;  ///< the accepting loop has begun

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace translucube::server

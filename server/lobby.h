#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "api/problem.h"
#include "server/connection.h"

namespace translucube::server {

struct LobbyTimes {
  std::chrono::milliseconds head;  ///< for the headers of a request, from its first byte on
  std::chrono::milliseconds idle;  ///< until the first byte of a further request
};

/// Holds the connections that are between requests, or whose next request has not come whole: one
/// thread for all of them, so that neither idle clients nor those that send a byte a second
/// ("Slowloris") take one from a client that is served.
class Lobby {
 public:
  /// `ready` takes a connection that has the headers of a request. `refusal` is what a connection
  /// gets to read before it is closed for a reason.
  Lobby(LobbyTimes times, std::function<void(std::unique_ptr<Connection>)> ready,
        std::function<std::string(api::ProblemCode)> refusal);
  ~Lobby();

  void enter(std::unique_ptr<Connection> connection);   ///< a new one
  void wait(std::unique_ptr<Connection> connection);    ///< answered, kept alive
  void linger(std::unique_ptr<Connection> connection);  ///< answered, to be closed
  /// Closes the connection that has been here longest; false where there is none.
  bool evict();
  /// Closes all, and each that comes later.
  void close();

 private:
  using Time = std::chrono::steady_clock::time_point;
  enum class Awaits { head, request, close };
  struct Guest {
    std::unique_ptr<Connection> connection;
    Awaits awaits;
    Time since, deadline;
  };

  void add(std::unique_ptr<Connection> connection, Awaits awaits, std::chrono::milliseconds time);
  void run(const std::stop_token& stop);
  void look_after(int socket);
  void close_overdue();
  void refuse(std::unique_ptr<Connection> connection, api::ProblemCode code);
  std::unique_ptr<Connection> take(int socket);

  const LobbyTimes times_;
  const std::function<void(std::unique_ptr<Connection>)> ready_;
  const std::function<std::string(api::ProblemCode)> refusal_;
  FileDescriptor epoll_;
  std::mutex mutex_;
  bool closed_ = false;
  std::map<int, Guest> guests_;  ///< by socket
  std::jthread thread_;          ///< last: ends before what it uses
};

}  // namespace translucube::server

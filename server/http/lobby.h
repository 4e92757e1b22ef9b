#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "api/base/problem.h"
#include "server/http/connection.h"

namespace translucube::server {

struct LobbyTimes {
  std::chrono::milliseconds head;  ///< for the headers of a request, from its first byte on
  std::chrono::milliseconds idle;  ///< until the first byte of a further request
};

/// Holds the connections that are between requests, or whose next request has not come whole, so
/// that neither idle clients nor those that send a byte a second ("Slowloris") take a thread from a
/// client that is served.
class Lobby {
 public:
  /// `refusal` is what a connection gets to read before it is closed for a reason.
  Lobby(LobbyTimes times, std::function<std::string(api::ProblemCode)> refusal);
  ~Lobby();

  /// Waits for a connection that has the headers of a request, which the thread that waited then
  /// serves: no thread is woken for another. Null once the lobby is closed.
  std::unique_ptr<Connection> next();

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
  void add(Guest guest);
  std::unique_ptr<Connection> look_after(Guest guest);
  void keep_time(const std::stop_token& stop);
  void close_overdue();
  void refuse(std::unique_ptr<Connection> connection, api::ProblemCode code);

  const LobbyTimes times_;
  const std::function<std::string(api::ProblemCode)> refusal_;
  FileDescriptor epoll_, bell_;  ///< the bell rings once the lobby is closed
  std::mutex mutex_;
  bool closed_ = false;
  std::map<int, Guest> guests_;  ///< by socket
  std::jthread thread_;          ///< last: ends before what it uses
};

}  // namespace translucube::server

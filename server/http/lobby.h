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

/// Holds the connections that are between requests, or whose request has not come whole, head or
/// body, so that neither idle clients nor those that send a byte a second ("Slowloris") take a
/// thread from a client that is served.
class Lobby {
 public:
  /// What a connection gets to read before it is closed for a problem; it may have an exchange.
  using Refusal = std::function<std::string(const api::Problem&, const Connection&)>;

  /// `most_held`: bytes of bodies that have come in part, of all connections.
  Lobby(LobbyTimes times, std::size_t most_held, Refusal refusal);
  ~Lobby();

  /// Waits for a connection that has the head of a request, or all that will come of its body,
  /// which the thread that waited then serves: no thread is woken for another. Null once the lobby
  /// is closed.
  std::unique_ptr<Connection> next();

  void enter(std::unique_ptr<Connection> connection);       ///< a new one
  void await_body(std::unique_ptr<Connection> connection);  ///< its exchange has begun
  void wait(std::unique_ptr<Connection> connection);        ///< answered, kept alive
  /// Answered that it should come later: not looked at for a moment, so that clients that ask again
  /// at once do not keep the others from being answered.
  void rest(std::unique_ptr<Connection> connection);
  void linger(std::unique_ptr<Connection> connection);  ///< answered, to be closed
  /// Closes the connection that has been here longest, of those that send a body only if there is
  /// no other; false where there is none at all.
  bool evict();
  /// Closes all, and each that comes later.
  void close();

 private:
  using Time = std::chrono::steady_clock::time_point;
  enum class Awaits { head, body, request, time, close };
  struct Guest {
    std::unique_ptr<Connection> connection;
    Awaits awaits;
    Time since, deadline;
    std::size_t held = 0;  ///< bytes of a body that has come in part
  };
  using Guests = std::map<int, Guest>;

  void add(std::unique_ptr<Connection> connection, Awaits awaits, std::chrono::milliseconds time);
  void add(Guest guest);
  Guest take_out(Guests::iterator guest);
  template <typename Such>
  Guests::iterator oldest_of(Such such);
  std::unique_ptr<Connection> look_after(Guest guest);
  void keep_within_memory();
  void keep_time(const std::stop_token& stop);
  void close_overdue();
  void refuse(std::unique_ptr<Connection> connection, const api::Problem& problem);
  void refuse_fault(std::unique_ptr<Connection> connection);

  const LobbyTimes times_;
  const std::size_t most_held_;
  const Refusal refusal_;
  FileDescriptor epoll_, bell_;  ///< the bell rings once the lobby is closed
  std::mutex mutex_;
  bool closed_ = false;
  Guests guests_;  ///< by socket
  std::size_t held_ = 0;
  std::jthread thread_;  ///< last: ends before what it uses
};

}  // namespace translucube::server

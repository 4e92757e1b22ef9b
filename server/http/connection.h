#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

#include "server/base/file.h"
#include "server/base/places.h"

namespace translucube::server {

/// What all connections of a service share.
struct ConnectionRules {
  /// Bounds the threads that wait for slow clients: a thread that must wait for its client's next
  /// bytes, or for room to send, takes a place and keeps it to the end of the request.
  Places& transfers;
  /// How long a request may keep its thread waiting: at a time, and in all, where each 16 KiB moved
  /// earn a second more.
  std::chrono::milliseconds patience;
  const std::atomic<bool>& stopping;  ///< then nobody waits for a client any more
};

/// A client's TCP connection. Between requests it belongs to the Lobby, which only looks at what
/// has come (`receive_head`); during one to a thread, which may wait (`read`, `write`).
class Connection {
 public:
  static constexpr std::size_t largest_head = 1 << 16;

  Connection(FileDescriptor socket, Places::Place place, const ConnectionRules& rules);

  enum class Head { missing, begun, whole, too_large, closed };
  Head head() const;  ///< of the next request, in what was taken in
  /// Takes in what has come, without waiting, up to the end of a request's headers.
  Head receive_head();
  /// Drops some of what has come, without waiting. False once the client has closed.
  bool drop_received();

  /// Up to `size` bytes, at least one; 0 at the end of the stream, -1 on failure or when the
  /// client was waited for too long.
  ssize_t read(char* buffer, std::size_t size);
  /// Small pieces are gathered; `flush` sends them, as does a read that must wait for the client.
  ssize_t write(const char* bytes, std::size_t size);
  bool flush();
  /// False once the client has closed its side or the connection is broken.
  bool client_listens() const;
  /// The last failure was for want of a place for slow clients.
  bool crowded() const { return crowded_; }
  std::uint64_t sent() const { return sent_; }  ///< bytes in this request
  /// The next request could not be told from what is left of this one.
  void end_after_request() { ends_ = true; }
  bool ends() const { return ends_; }
  /// Gives back the place for slow clients; the counts begin anew.
  void end_request();

  /// Sends what fits at once, for refusals.
  void write_at_once(std::string_view bytes);
  /// Ends our side only: the client still gets what was sent (RFC 9112, 9.6).
  void end_sending();

  int socket() const { return socket_.get(); }

 private:
  bool wait(short events);
  ssize_t fill();
  ssize_t send(const char* bytes, std::size_t size);

  FileDescriptor socket_;
  Places::Place place_, transfer_;
  ConnectionRules rules_;
  std::string buffer_;  ///< received, from `read_` on not yet read
  std::size_t read_ = 0;
  std::string unsent_;
  std::uint64_t sent_ = 0, moved_ = 0;
  std::chrono::nanoseconds waited_{0};
  bool crowded_ = false, ends_ = false;
};

}  // namespace translucube::server

#pragma once

#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

#include "server/base/file.h"
#include "server/base/places.h"
#include "server/http/exchange.h"
#include "server/http/head_scan.h"

namespace translucube::server {

/// What all connections of a service share.
struct ConnectionRules {
  /// Bounds the threads that wait for clients that read slowly: a thread that must wait for room to
  /// send takes a place and keeps it to the end of the answer.
  Places& transfers;
  /// How long a client may keep a request waiting for its bytes, or for room to send: at a time,
  /// and in all, where each 16 KiB moved earn a second more.
  std::chrono::milliseconds patience;
  const std::atomic<bool>& stopping;  ///< then nobody waits for a client any more
};

/// A client's TCP connection. While a request comes it belongs to the Lobby, which only looks at
/// what is there (`receive`); while one is answered to a thread, which may wait (`write`).
class Connection {
 public:
  using Time = std::chrono::steady_clock::time_point;

  Connection(FileDescriptor socket, Places::Place place, const ConnectionRules& rules);

  /// What there is of a request: of its head, and of its body once the exchange has begun.
  enum class Receipt { missing, begun, whole, faulty, closed };
  /// Takes in what has come, without waiting, up to the end of the head or the body.
  Receipt receive();
  /// Of what was taken in before.
  Receipt received();
  const api::Problem& fault() const;  ///< of what is faulty
  bool has_unread() const { return read_ < buffer_.size(); }
  /// Drops some of what has come, without waiting. False once the client has closed.
  bool drop_received();

  std::string_view head() const;  ///< the bytes of a head that is whole
  /// The head was read: what follows is the body.
  void begin(std::unique_ptr<Exchange> exchange);
  Exchange* exchange() const { return exchange_.get(); }
  void end_exchange();
  std::size_t held() const;  ///< bytes in memory
  /// When the body must have come, or some more of it.
  Time body_deadline() const;
  /// A client may wait for the acknowledgement of a request's head before it sends the body
  /// (Nagle's algorithm, RFC 896), and the kernel for 40 ms before it acknowledges.
  void acknowledge();

  /// From here on, to the end of the exchange, a client that does not read is not waited for.
  void hurry() { hurries_ = true; }
  /// Small pieces are gathered; `flush` sends them. False where the client was waited for too long
  /// or is gone.
  bool write(std::string_view bytes);
  bool flush();
  /// All that there was is sent: a client that was slow gives back the thread's place, and its time
  /// begins anew.
  void catch_up();
  /// False once the client has closed its side or the connection is broken.
  bool client_listens() const;
  std::uint64_t sent() const { return sent_; }  ///< bytes in this exchange

  /// Sends what fits at once, for refusals.
  void write_at_once(std::string_view bytes);
  /// Ends our side only: the client still gets what was sent (RFC 9112, 9.6).
  void end_sending();

  int socket() const { return socket_.get(); }

 private:
  std::string_view unread() const { return std::string_view(buffer_).substr(read_); }
  bool skip_empty_lines();
  Receipt received_of_body();
  ssize_t fill();
  bool wait_for_room();
  ssize_t send(std::string_view bytes);

  FileDescriptor socket_;
  Places::Place place_, transfer_;
  ConnectionRules rules_;
  std::string buffer_;  ///< received, from `read_` on not yet read
  std::size_t read_ = 0, skipped_ = 0;
  HeadScan scan_;
  std::unique_ptr<Exchange> exchange_;
  std::string unsent_;
  std::uint64_t sent_ = 0, moved_ = 0;
  Time body_begun_{}, body_moved_{};
  std::chrono::nanoseconds waited_{0};
  bool hurries_ = false;
};

}  // namespace translucube::server

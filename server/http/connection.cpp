#include "server/http/connection.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace translucube::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::size_t chunk = 1 << 14;
// An answer up to this size leaves in one piece, which wakes its client once.
constexpr std::size_t gathered = 1 << 16;
// How soon a thread that waits sees that the service stops.
constexpr milliseconds glance(200);

}  // namespace

Connection::Connection(FileDescriptor socket, Places::Place place, const ConnectionRules& rules)
    : socket_(std::move(socket)), place_(std::move(place)), rules_(rules) {}

ssize_t Connection::fill() {
  if (read_ == buffer_.size()) {
    buffer_.clear();
    read_ = 0;
  }
  std::array<char, chunk> bytes;
  ssize_t got;
  do {
    got = ::recv(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
  } while (got < 0 && errno == EINTR);
  if (got > 0) buffer_.append(bytes.data(), static_cast<std::size_t>(got));
  return got;
}

Connection::Head Connection::head() const {
  const std::string_view received = std::string_view(buffer_).substr(read_);
  if (received.find("\r\n\r\n") != received.npos) return Head::whole;
  if (received.size() > largest_head) return Head::too_large;
  return received.empty() ? Head::missing : Head::begun;
}

Connection::Head Connection::receive_head() {
  for (;;) {
    const Head now = head();
    if (now == Head::whole || now == Head::too_large) return now;
    const ssize_t got = fill();
    if (got == 0) return Head::closed;
    if (got < 0) return errno == EAGAIN || errno == EWOULDBLOCK ? now : Head::closed;
  }
}

bool Connection::drop_received() {
  ssize_t got = 1;
  for (std::size_t dropped = 0; got > 0 && dropped < largest_head; dropped += chunk) {
    read_ = buffer_.size();
    got = fill();
  }
  return got > 0 || (got < 0 && (errno == EAGAIN || errno == EWOULDBLOCK));
}

void Connection::end_request() {
  transfer_.reset();
  unsent_.clear();
  sent_ = moved_ = 0;
  waited_ = {};
  crowded_ = false;
}

bool Connection::wait(short events) {
  if (!transfer_) transfer_ = rules_.transfers.take();
  crowded_ = !transfer_;
  if (crowded_) return false;
  const auto earned = milliseconds(moved_ * 1000 / chunk);
  const auto start = steady_clock::now();
  const auto end = start + std::min<std::chrono::nanoseconds>(rules_.patience,
                                                              rules_.patience + earned - waited_);
  int ready = 0;
  for (auto now = start; ready == 0 && now < end && !rules_.stopping; now = steady_clock::now()) {
    const auto left = std::chrono::ceil<milliseconds>(end - now);
    pollfd poll{socket_.get(), events, 0};
    ready = ::poll(&poll, 1, static_cast<int>(std::min(left, glance).count()));
    if (ready < 0 && errno == EINTR) ready = 0;
  }
  waited_ += steady_clock::now() - start;
  return ready > 0;
}

ssize_t Connection::read(char* out, std::size_t size) {
  while (read_ == buffer_.size()) {
    const ssize_t got = fill();
    if (got > 0) {
      moved_ += static_cast<std::uint64_t>(got);
      break;
    }
    if (got == 0) return 0;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return -1;
    if (!flush()) return -1;
    // A client may wait for the acknowledgement of a request's head before it sends the body
    // (Nagle's algorithm, RFC 896), and the kernel for 40 ms before it acknowledges.
    constexpr int yes = 1;
    ::setsockopt(socket_.get(), IPPROTO_TCP, TCP_QUICKACK, &yes, sizeof yes);
    if (!wait(POLLIN)) return -1;
  }
  size = std::min(size, buffer_.size() - read_);
  std::memcpy(out, buffer_.data() + read_, size);
  read_ += size;
  return static_cast<ssize_t>(size);
}

ssize_t Connection::write(const char* bytes, std::size_t size) {
  if (unsent_.size() + size > gathered) {
    if (!flush()) return -1;
    return send(bytes, size);
  }
  unsent_.append(bytes, size);
  sent_ += size;
  return static_cast<ssize_t>(size);
}

bool Connection::flush() {
  std::size_t done = 0;
  const std::uint64_t sent = sent_;
  while (done < unsent_.size()) {
    const ssize_t wrote = send(unsent_.data() + done, unsent_.size() - done);
    if (wrote < 0) break;
    done += static_cast<std::size_t>(wrote);
  }
  const bool all = done == unsent_.size();
  sent_ = sent;
  unsent_.clear();
  return all;
}

ssize_t Connection::send(const char* bytes, std::size_t size) {
  for (;;) {
    const ssize_t wrote = ::send(socket_.get(), bytes, size, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (wrote >= 0) {
      sent_ += static_cast<std::uint64_t>(wrote);
      moved_ += static_cast<std::uint64_t>(wrote);
      return wrote;
    }
    if (errno == EINTR) continue;
    if (errno != EAGAIN && errno != EWOULDBLOCK) return -1;
    if (!wait(POLLOUT)) return -1;
  }
}

bool Connection::client_listens() const {
  pollfd poll{socket_.get(), POLLRDHUP, 0};
  return ::poll(&poll, 1, 0) == 0;
}

void Connection::write_at_once(std::string_view bytes) {
  (void)::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
}

void Connection::end_sending() { ::shutdown(socket_.get(), SHUT_WR); }

}  // namespace translucube::server

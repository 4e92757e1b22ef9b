#include "server/http/connection.h"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <utility>

namespace translucube::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr std::size_t chunk = 1 << 14;
// What is taken in of a body before others have their turn.
constexpr std::size_t at_a_time = 1 << 20;
// An answer up to this size leaves in one piece, which wakes its client once.
constexpr std::size_t gathered = 1 << 16;
// How soon a thread that waits sees that the service stops.
constexpr milliseconds glance(200);
constexpr std::chrono::seconds longest_body(60), longest_file(3600);
// RFC 9112, 2.2: an empty line before a request is ignored; clients of old send one after a body.
constexpr std::size_t most_empty_lines = 64;

const api::Problem too_many_empty_lines{
    api::ProblemCode::malformed_http, "There are only empty lines.", {}};

bool would_block() { return errno == EAGAIN || errno == EWOULDBLOCK; }

}  // namespace

Connection::Connection(FileDescriptor socket, Places::Place place, const ConnectionRules& rules)
    : socket_(std::move(socket)), place_(std::move(place)), rules_(rules) {}

ssize_t Connection::fill() {
  buffer_.erase(0, std::exchange(read_, 0));
  std::array<char, chunk> bytes;
  ssize_t got;
  do {
    got = ::recv(socket_.get(), bytes.data(), bytes.size(), MSG_DONTWAIT);
  } while (got < 0 && errno == EINTR);
  if (got > 0) buffer_.append(bytes.data(), static_cast<std::size_t>(got));
  return got;
}

/// False where there are too many.
bool Connection::skip_empty_lines() {
  for (; unread().starts_with("\r\n"); read_ += 2) ++skipped_;
  return skipped_ <= most_empty_lines;
}

Connection::Receipt Connection::received() {
  if (exchange_) return received_of_body();
  if (!skip_empty_lines()) return Receipt::faulty;
  const std::string_view bytes = unread();
  if (bytes.empty() || bytes == "\r") return Receipt::missing;
  switch (scan_.scan(bytes)) {
    case HeadScan::State::begun:
      return Receipt::begun;
    case HeadScan::State::whole:
      return Receipt::whole;
    case HeadScan::State::faulty:
      break;
  }
  return Receipt::faulty;
}

Connection::Receipt Connection::received_of_body() {
  std::string_view bytes = unread();
  if (!bytes.empty()) body_moved_ = steady_clock::now();
  exchange_->body.take(bytes);
  read_ = buffer_.size() - bytes.size();
  if (exchange_->body.fault()) return Receipt::faulty;
  return exchange_->body.whole() ? Receipt::whole : Receipt::begun;
}

Connection::Receipt Connection::receive() {
  for (std::size_t taken = 0;;) {
    const Receipt now = received();
    if (now == Receipt::whole || now == Receipt::faulty || taken >= at_a_time) return now;
    const ssize_t got = fill();
    if (got == 0) return Receipt::closed;
    if (got < 0) return would_block() ? now : Receipt::closed;
    taken += static_cast<std::size_t>(got);
    if (exchange_) moved_ += static_cast<std::uint64_t>(got);
  }
}

const api::Problem& Connection::fault() const {
  if (exchange_) return *exchange_->body.fault();
  return skipped_ > most_empty_lines ? too_many_empty_lines : scan_.fault();
}

bool Connection::drop_received() {
  ssize_t got = 1;
  for (std::size_t dropped = 0; got > 0 && dropped < at_a_time; dropped += chunk) {
    read_ = buffer_.size();
    got = fill();
  }
  return got > 0 || (got < 0 && would_block());
}

std::string_view Connection::head() const { return unread().substr(0, scan_.size()); }

void Connection::begin(std::unique_ptr<Exchange> exchange) {
  read_ += scan_.size();
  scan_ = {};
  skipped_ = 0;
  exchange_ = std::move(exchange);
  body_begun_ = body_moved_ = steady_clock::now();
}

void Connection::end_exchange() {
  exchange_.reset();
  transfer_.reset();
  unsent_.clear();
  sent_ = moved_ = 0;
  waited_ = {};
  hurries_ = false;
}

std::size_t Connection::held() const {
  return buffer_.capacity() + (exchange_ ? exchange_->body.held() : 0);
}

Connection::Time Connection::body_deadline() const {
  const auto earned = milliseconds(moved_ * 1000 / chunk);
  const milliseconds longest = exchange_->request.body_file ? longest_file : longest_body;
  return std::min({body_moved_ + rules_.patience, body_begun_ + rules_.patience + earned,
                   body_begun_ + std::max(longest, rules_.patience)});
}

void Connection::acknowledge() {
  constexpr int yes = 1;
  ::setsockopt(socket_.get(), IPPROTO_TCP, TCP_QUICKACK, &yes, sizeof yes);
}

bool Connection::wait_for_room() {
  if (hurries_) return false;
  if (!transfer_) transfer_ = rules_.transfers.take();
  if (!transfer_) return false;
  const auto earned = milliseconds(moved_ * 1000 / chunk);
  const auto start = steady_clock::now();
  const auto end = start + std::min<std::chrono::nanoseconds>(rules_.patience,
                                                              rules_.patience + earned - waited_);
  int ready = 0;
  for (auto now = start; ready == 0 && now < end && !rules_.stopping; now = steady_clock::now()) {
    const auto left = std::chrono::ceil<milliseconds>(end - now);
    pollfd poll{socket_.get(), POLLOUT, 0};
    ready = ::poll(&poll, 1, static_cast<int>(std::min(left, glance).count()));
    if (ready < 0 && errno == EINTR) ready = 0;
  }
  waited_ += steady_clock::now() - start;
  return ready > 0;
}

bool Connection::write(std::string_view bytes) {
  if (unsent_.size() + bytes.size() <= gathered) {
    unsent_ += bytes;
    return true;
  }
  if (!flush()) return false;
  while (!bytes.empty()) {
    const ssize_t wrote = send(bytes);
    if (wrote < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(wrote));
  }
  return true;
}

bool Connection::flush() {
  std::string_view bytes = unsent_;
  while (!bytes.empty()) {
    const ssize_t wrote = send(bytes);
    if (wrote < 0) break;
    bytes.remove_prefix(static_cast<std::size_t>(wrote));
  }
  const bool all = bytes.empty();
  unsent_.clear();
  return all;
}

ssize_t Connection::send(std::string_view bytes) {
  for (;;) {
    const ssize_t wrote =
        ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (wrote >= 0) {
      sent_ += static_cast<std::uint64_t>(wrote);
      moved_ += static_cast<std::uint64_t>(wrote);
      return wrote;
    }
    if (errno == EINTR) continue;
    if (!would_block() || !wait_for_room()) return -1;
  }
}

void Connection::catch_up() {
  transfer_.reset();
  waited_ = {};
}

bool Connection::client_listens() const {
  pollfd poll{socket_.get(), POLLRDHUP, 0};
  return ::poll(&poll, 1, 0) == 0;
}

void Connection::write_at_once(std::string_view bytes) {
  const ssize_t wrote =
      ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  if (wrote > 0) sent_ += static_cast<std::uint64_t>(wrote);
}

void Connection::end_sending() { ::shutdown(socket_.get(), SHUT_WR); }

}  // namespace translucube::server

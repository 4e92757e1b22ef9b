#include "server/http/lobby.h"

#include <spdlog/spdlog.h>
#include <sys/epoll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <iterator>
#include <optional>
#include <system_error>
#include <vector>

namespace translucube::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds deadline_check(100);  // how late a deadline may be seen
constexpr milliseconds longest_farewell(2000);
constexpr milliseconds rest_time(200);

const api::Problem too_slow{
    api::ProblemCode::request_timeout, "The request did not come whole in time.", {}};
const api::Problem too_much{
    api::ProblemCode::overloaded, "Too many clients send large bodies slowly.", {}};
const api::Problem not_served{
    api::ProblemCode::overloaded, "There was no thread for the request in time.", {}};

}  // namespace

Lobby::Lobby(LobbyTimes times, std::size_t most_held, Refusal refusal)
    : times_(times),
      most_held_(most_held),
      refusal_(std::move(refusal)),
      epoll_(::epoll_create1(EPOLL_CLOEXEC)),
      bell_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  epoll_event event{};
  event.events = EPOLLIN;
  event.data.fd = bell_.get();
  if (!epoll_ || !bell_ || ::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, bell_.get(), &event) != 0)
    throw std::system_error(errno, std::generic_category(), "epoll");
  thread_ = std::jthread([this](const std::stop_token& stop) { keep_time(stop); });
}

Lobby::~Lobby() { close(); }

void Lobby::enter(std::unique_ptr<Connection> connection) {
  add(std::move(connection), Awaits::head, times_.head);
}

void Lobby::await_body(std::unique_ptr<Connection> connection) {
  connection->acknowledge();
  const Time deadline = connection->body_deadline();
  add({std::move(connection), Awaits::body, steady_clock::now(), deadline});
  keep_within_memory();
}

void Lobby::wait(std::unique_ptr<Connection> connection) {
  add(std::move(connection), Awaits::request, times_.idle);
}

void Lobby::rest(std::unique_ptr<Connection> connection) {
  add(std::move(connection), Awaits::time, rest_time);
}

void Lobby::linger(std::unique_ptr<Connection> connection) {
  connection->end_sending();
  add(std::move(connection), Awaits::close, longest_farewell);
}

void Lobby::add(std::unique_ptr<Connection> connection, Awaits awaits, milliseconds time) {
  const Time now = steady_clock::now();
  add({std::move(connection), awaits, now, now + time});
}

void Lobby::add(Guest guest) {
  const int socket = guest.connection->socket();
  epoll_event event{};
  // Once, so that one thread gets it.
  event.events = EPOLLIN | EPOLLONESHOT;
  // A further request may have come along with the last one, of which the socket would not tell.
  if (guest.awaits == Awaits::request) {
    const Connection::Receipt now = guest.connection->received();
    if (now == Connection::Receipt::whole || now == Connection::Receipt::faulty)
      event.events |= EPOLLOUT;
  }
  event.data.fd = socket;
  guest.held = guest.awaits == Awaits::body ? guest.connection->held() : 0;
  const std::lock_guard lock(mutex_);
  if (closed_) return;
  if (guest.awaits != Awaits::time &&
      ::epoll_ctl(epoll_.get(), EPOLL_CTL_MOD, socket, &event) != 0 &&
      ::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, socket, &event) != 0)
    return;
  held_ += guest.held;
  guests_[socket] = std::move(guest);
}

/// Under the lock.
Lobby::Guest Lobby::take_out(Guests::iterator guest) {
  held_ -= guest->second.held;
  return std::move(guests_.extract(guest).mapped());
}

std::unique_ptr<Connection> Lobby::next() {
  for (;;) {
    epoll_event event;
    const int count = ::epoll_wait(epoll_.get(), &event, 1, -1);
    if (count < 0 && errno == EINTR) continue;
    if (count != 1 || event.data.fd == bell_.get()) return nullptr;
    std::optional<Guest> guest;
    {
      const std::lock_guard lock(mutex_);
      if (const auto found = guests_.find(event.data.fd); found != guests_.end())
        guest = take_out(found);
    }
    if (!guest) continue;  // its time was over meanwhile
    if (auto connection = look_after(*std::move(guest))) return connection;
  }
}

/// The connection, if it can be served.
std::unique_ptr<Connection> Lobby::look_after(Guest guest) {
  if (guest.awaits == Awaits::close) {
    if (guest.connection->drop_received()) add(std::move(guest));
    return nullptr;
  }
  const Connection::Receipt now = guest.connection->receive();
  if (guest.awaits == Awaits::body) {
    if (now != Connection::Receipt::begun) return std::move(guest.connection);
    guest.deadline = guest.connection->body_deadline();
    add(std::move(guest));
    keep_within_memory();
    return nullptr;
  }
  switch (now) {
    case Connection::Receipt::begun:
      if (guest.awaits == Awaits::request) {
        guest.awaits = Awaits::head;
        guest.deadline = steady_clock::now() + times_.head;
      }
      [[fallthrough]];
    case Connection::Receipt::missing:
      add(std::move(guest));
      return nullptr;
    case Connection::Receipt::whole:
      return std::move(guest.connection);
    case Connection::Receipt::faulty:
      refuse_fault(std::move(guest.connection));
      return nullptr;
    case Connection::Receipt::closed:
      break;
  }
  return nullptr;
}

void Lobby::close_overdue() {
  std::vector<Guest> late;
  {
    const std::lock_guard lock(mutex_);
    const Time now = steady_clock::now();
    for (auto guest = guests_.begin(); guest != guests_.end();) {
      const auto next = std::next(guest);
      if (guest->second.deadline <= now) late.push_back(take_out(guest));
      guest = next;
    }
  }
  for (auto& [connection, awaits, since, deadline, held] : late) {
    if (awaits == Awaits::close) continue;
    if (awaits == Awaits::time) {
      wait(std::move(connection));
      continue;
    }
    const Connection::Receipt now = connection->receive();
    if (now == Connection::Receipt::whole)
      refuse(std::move(connection), not_served);
    else if (now == Connection::Receipt::begun)
      refuse(std::move(connection), too_slow);
    else if (now == Connection::Receipt::faulty)
      refuse_fault(std::move(connection));
    // One that never sent anything has not asked.
  }
}

/// Lets those go that have been sending a body for longest.
void Lobby::keep_within_memory() {
  std::vector<Guest> leaving;
  {
    const std::lock_guard lock(mutex_);
    while (held_ > most_held_) {
      const auto oldest = oldest_of([](Awaits awaits) { return awaits == Awaits::body; });
      if (oldest == guests_.end()) break;
      leaving.push_back(take_out(oldest));
    }
  }
  for (Guest& guest : leaving) refuse(std::move(guest.connection), too_much);
}

void Lobby::refuse_fault(std::unique_ptr<Connection> connection) {
  const api::Problem fault = connection->fault();
  refuse(std::move(connection), fault);
}

void Lobby::refuse(std::unique_ptr<Connection> connection, const api::Problem& problem) {
  connection->write_at_once(refusal_(problem, *connection));
  connection->end_exchange();
  linger(std::move(connection));
}

/// Of those that await such a thing, the one that has been here longest. Under the lock.
template <typename Such>
Lobby::Guests::iterator Lobby::oldest_of(Such such) {
  auto oldest = guests_.end();
  for (auto guest = guests_.begin(); guest != guests_.end(); ++guest)
    if (such(guest->second.awaits) &&
        (oldest == guests_.end() || guest->second.since < oldest->second.since))
      oldest = guest;
  return oldest;
}

bool Lobby::evict() {
  std::optional<Guest> leaving;  // closed after the lock
  const std::lock_guard lock(mutex_);
  auto oldest = oldest_of([](Awaits awaits) { return awaits != Awaits::body; });
  if (oldest == guests_.end()) oldest = oldest_of([](Awaits) { return true; });
  if (oldest == guests_.end()) return false;
  leaving = take_out(oldest);
  return true;
}

void Lobby::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    guests_.clear();
    held_ = 0;
  }
  ::eventfd_write(bell_.get(), 1);
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void Lobby::keep_time(const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  while (!never.wait_for(lock, stop, deadline_check, [&] { return stop.stop_requested(); })) try {
      close_overdue();
    } catch (const std::exception& error) {
      spdlog::error("a connection failed: {}", error.what());
    }
}

}  // namespace translucube::server

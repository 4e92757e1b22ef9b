#include "server/http/lobby.h"

#include <sys/epoll.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <cerrno>
#include <condition_variable>
#include <system_error>
#include <vector>

namespace translucube::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds deadline_check(100);  // how late a deadline may be seen
constexpr milliseconds longest_farewell(2000);

}  // namespace

Lobby::Lobby(LobbyTimes times, std::function<std::string(api::ProblemCode)> refusal)
    : times_(times),
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

void Lobby::wait(std::unique_ptr<Connection> connection) {
  add(std::move(connection), Awaits::request, times_.idle);
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
  if (guest.awaits == Awaits::request && guest.connection->head() == Connection::Head::whole)
    event.events |= EPOLLOUT;
  event.data.fd = socket;
  const std::lock_guard lock(mutex_);
  if (closed_) return;
  if (::epoll_ctl(epoll_.get(), EPOLL_CTL_MOD, socket, &event) != 0 &&
      ::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, socket, &event) != 0)
    return;
  guests_[socket] = std::move(guest);
}

std::unique_ptr<Connection> Lobby::next() {
  for (;;) {
    epoll_event event;
    const int count = ::epoll_wait(epoll_.get(), &event, 1, -1);
    if (count < 0 && errno == EINTR) continue;
    if (count != 1 || event.data.fd == bell_.get()) return nullptr;
    std::map<int, Guest>::node_type guest;
    {
      const std::lock_guard lock(mutex_);
      guest = guests_.extract(event.data.fd);
    }
    if (guest.empty()) continue;  // its time was over meanwhile
    if (auto connection = look_after(std::move(guest.mapped()))) return connection;
  }
}

/// The connection, if it can be served.
std::unique_ptr<Connection> Lobby::look_after(Guest guest) {
  if (guest.awaits == Awaits::close) {
    if (guest.connection->drop_received()) add(std::move(guest));
    return nullptr;
  }
  switch (guest.connection->receive_head()) {
    case Connection::Head::begun:
      if (guest.awaits == Awaits::request) {
        guest.awaits = Awaits::head;
        guest.deadline = steady_clock::now() + times_.head;
      }
      [[fallthrough]];
    case Connection::Head::missing:
      add(std::move(guest));
      return nullptr;
    case Connection::Head::whole:
      return std::move(guest.connection);
    case Connection::Head::too_large:
      refuse(std::move(guest.connection), api::ProblemCode::headers_too_large);
      return nullptr;
    case Connection::Head::closed:
      break;
  }
  return nullptr;
}

void Lobby::close_overdue() {
  std::vector<std::unique_ptr<Connection>> late;
  {
    const std::lock_guard lock(mutex_);
    const Time now = steady_clock::now();
    std::vector<int> overdue;
    for (const auto& [socket, guest] : guests_)
      if (guest.deadline <= now) overdue.push_back(socket);
    for (const int socket : overdue) {
      Guest guest = std::move(guests_.extract(socket).mapped());
      // One that never sent anything has not asked.
      if (guest.awaits == Awaits::head &&
          guest.connection->receive_head() == Connection::Head::begun)
        late.push_back(std::move(guest.connection));
    }
  }
  for (auto& connection : late) refuse(std::move(connection), api::ProblemCode::request_timeout);
}

void Lobby::refuse(std::unique_ptr<Connection> connection, api::ProblemCode code) {
  connection->write_at_once(refusal_(code));
  linger(std::move(connection));
}

bool Lobby::evict() {
  const std::lock_guard lock(mutex_);
  const auto oldest =
      std::ranges::min_element(guests_, {}, [](const auto& guest) { return guest.second.since; });
  if (oldest == guests_.end()) return false;
  guests_.erase(oldest);
  return true;
}

void Lobby::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    guests_.clear();
  }
  ::eventfd_write(bell_.get(), 1);
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void Lobby::keep_time(const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  while (!never.wait_for(lock, stop, deadline_check, [&] { return stop.stop_requested(); }))
    close_overdue();
}

}  // namespace translucube::server

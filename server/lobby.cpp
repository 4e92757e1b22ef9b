#include "server/lobby.h"

#include <sys/epoll.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>
#include <vector>

namespace translucube::server {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds glance(100);  // how late a deadline may be seen
constexpr milliseconds longest_farewell(2000);

}  // namespace

Lobby::Lobby(LobbyTimes times, std::function<void(std::unique_ptr<Connection>)> ready,
             std::function<std::string(api::ProblemCode)> refusal)
    : times_(times),
      ready_(std::move(ready)),
      refusal_(std::move(refusal)),
      epoll_(::epoll_create1(EPOLL_CLOEXEC)) {
  if (!epoll_) throw std::system_error(errno, std::generic_category(), "epoll_create1");
  thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
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
  const int socket = connection->socket();
  {
    const std::lock_guard lock(mutex_);
    if (closed_) return;
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.fd = socket;
    if (::epoll_ctl(epoll_.get(), EPOLL_CTL_ADD, socket, &event) != 0) return;
    const Time now = steady_clock::now();
    guests_[socket] = {std::move(connection), awaits, now, now + time};
  }
  // A further request may have come along with the last one: epoll would not tell.
  if (awaits == Awaits::request) look_after(socket);
}

std::unique_ptr<Connection> Lobby::take(int socket) {
  const auto guest = guests_.find(socket);
  auto connection = std::move(guest->second.connection);
  guests_.erase(guest);
  ::epoll_ctl(epoll_.get(), EPOLL_CTL_DEL, socket, nullptr);
  return connection;
}

void Lobby::look_after(int socket) {
  std::unique_ptr<Connection> ready, refused;
  {
    const std::lock_guard lock(mutex_);
    const auto it = guests_.find(socket);
    if (it == guests_.end()) return;
    Guest& guest = it->second;
    if (guest.awaits == Awaits::close) {
      if (!guest.connection->drop_received()) take(socket);
      return;
    }
    switch (guest.connection->receive_head()) {
      case Connection::Head::missing:
        return;
      case Connection::Head::begun:
        if (guest.awaits == Awaits::request) {
          guest.awaits = Awaits::head;
          guest.deadline = steady_clock::now() + times_.head;
        }
        return;
      case Connection::Head::whole:
        ready = take(socket);
        break;
      case Connection::Head::too_large:
        refused = take(socket);
        break;
      case Connection::Head::closed:
        take(socket);
        return;
    }
  }
  if (ready) ready_(std::move(ready));
  if (refused) refuse(std::move(refused), api::ProblemCode::headers_too_large);
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
      const bool owes_head = guests_.at(socket).awaits == Awaits::head;
      auto connection = take(socket);
      // One that never sent anything has not asked.
      if (owes_head && connection->receive_head() == Connection::Head::begun)
        late.push_back(std::move(connection));
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
  take(oldest->first);
  return true;
}

void Lobby::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    guests_.clear();
  }
  thread_.request_stop();
  if (thread_.joinable()) thread_.join();
}

void Lobby::run(const std::stop_token& stop) {
  std::array<epoll_event, 64> events;
  auto looked = steady_clock::now();
  while (!stop.stop_requested()) {
    const int count = ::epoll_wait(epoll_.get(), events.data(), static_cast<int>(events.size()),
                                   static_cast<int>(glance.count()));
    for (int i = 0; i < count; ++i) look_after(events[static_cast<std::size_t>(i)].data.fd);
    if (steady_clock::now() - looked < glance) continue;
    looked = steady_clock::now();
    close_overdue();
  }
}

}  // namespace translucube::server

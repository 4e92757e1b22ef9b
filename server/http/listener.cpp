#include "server/http/listener.h"

#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <cerrno>
#include <cstring>
#include <memory>

#include "server/http/server.h"

namespace translucube::server {
namespace {

constexpr int yes = 1;

FileDescriptor listening(const addrinfo& address) {
  FileDescriptor socket(
      ::socket(address.ai_family, address.ai_socktype | SOCK_CLOEXEC, address.ai_protocol));
  if (!socket) return socket;
  // Not SO_REUSEPORT: a second service would share the port in silence.
  ::setsockopt(socket.get(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (::bind(socket.get(), address.ai_addr, address.ai_addrlen) != 0 ||
      ::listen(socket.get(), SOMAXCONN) != 0)
    return FileDescriptor();
  return socket;
}

FileDescriptor listening(const std::string& host, int port) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* first = nullptr;
  const int failure = ::getaddrinfo(host.c_str(), std::to_string(port).c_str(), &hints, &first);
  const std::unique_ptr<addrinfo, decltype(&::freeaddrinfo)> addresses(first, ::freeaddrinfo);
  int reason = 0;
  for (const addrinfo* address = first; failure == 0 && address; address = address->ai_next) {
    if (auto socket = listening(*address)) return socket;
    reason = errno;
  }
  throw ListenError("cannot listen on " + host + ':' + std::to_string(port) + ": " +
                    (reason != 0 ? std::strerror(reason) : "no such host"));
}

bool out_of_descriptors(int error) {
  return error == EMFILE || error == ENFILE || error == ENOBUFS || error == ENOMEM;
}

}  // namespace

Listener::Listener(const std::string& host, int port)
    : socket_(listening(host, port)), bell_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (!bell_) throw ListenError(std::string("eventfd: ") + std::strerror(errno));
}

int Listener::port() const {
  sockaddr_storage address{};
  socklen_t size = sizeof address;
  ::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&address), &size);
  const auto port = address.ss_family == AF_INET6
                        ? reinterpret_cast<const sockaddr_in6&>(address).sin6_port
                        : reinterpret_cast<const sockaddr_in&>(address).sin_port;
  return ntohs(port);
}

bool Listener::rings_within(int milliseconds) const {
  pollfd poll{bell_.get(), POLLIN, 0};
  return ::poll(&poll, 1, milliseconds) > 0;
}

FileDescriptor Listener::next(const std::function<bool()>& make_room) {
  constexpr int pause_ms = 20;
  while (true) {
    pollfd poll[2]{{socket_.get(), POLLIN, 0}, {bell_.get(), POLLIN, 0}};
    ::poll(poll, 2, -1);
    if (rings_within(0)) return FileDescriptor();
    if ((poll[0].revents & POLLIN) == 0) continue;
    FileDescriptor client(::accept4(socket_.get(), nullptr, nullptr, SOCK_CLOEXEC));
    if (client) {
      ::setsockopt(client.get(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
      return client;
    }
    const int error = errno;
    if (out_of_descriptors(error) && make_room()) continue;
    if (error == EINTR || error == ECONNABORTED || error == EAGAIN) continue;
    spdlog::warn("accept: {}", std::strerror(error));
    if (rings_within(pause_ms)) return FileDescriptor();
  }
}

void Listener::stop() { ::eventfd_write(bell_.get(), 1); }

}  // namespace translucube::server

#pragma once

// Raw bytes over a socket, for what no HTTP client would send.

#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>
#include <string_view>

#include "server/base/file.h"

namespace translucube::server::test {

class Wire {
 public:
  explicit Wire(int port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    connected_ =
        ::connect(socket_.get(), reinterpret_cast<sockaddr*>(&address), sizeof address) == 0;
  }

  /// False where the other side hung up.
  bool send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return false;
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
    return connected_;
  }

  /// What fits at once.
  void send_some(std::string_view bytes) {
    (void)::send(socket_.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
  }

  void end_sending() { ::shutdown(socket_.get(), SHUT_WR); }

  /// One answer, headers and body; what came of it by the end of the connection or of the time.
  std::string receive(int milliseconds = 15'000) {
    std::string text;
    while (!whole(text)) {
      const std::string some = receive_some(milliseconds);
      if (some.empty()) break;
      text += some;
    }
    return text;
  }

  /// The next bytes; "" at the end of the connection or of the time.
  std::string receive_some(int milliseconds = 15'000) {
    pollfd wait{socket_.get(), POLLIN, 0};
    if (::poll(&wait, 1, milliseconds) <= 0) return {};
    char buffer[4096];
    const ssize_t got = ::recv(socket_.get(), buffer, sizeof buffer, 0);
    return got <= 0 ? std::string() : std::string(buffer, static_cast<std::size_t>(got));
  }

  /// True if the other side closes the connection in time.
  bool closed(int milliseconds = 10'000) {
    pollfd wait{socket_.get(), POLLIN, 0};
    if (::poll(&wait, 1, milliseconds) <= 0) return false;
    char byte;
    return ::recv(socket_.get(), &byte, 1, 0) <= 0;
  }

 private:
  static bool whole(const std::string& text) {
    const auto head = text.find("\r\n\r\n");
    if (head == text.npos) return false;
    const std::string name = "Content-Length: ";
    const auto at = text.find(name);
    const std::size_t length =
        at < head ? std::stoul(text.substr(at + name.size(), 20)) : std::size_t(0);
    return text.size() >= head + 4 + length;
  }

  FileDescriptor socket_;
  bool connected_ = false;
};

}  // namespace translucube::server::test

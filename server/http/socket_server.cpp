#include "server/http/socket_server.h"

#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

namespace translucube::server {
namespace {

thread_local Connection* serving = nullptr;

class ConnectionStream : public httplib::Stream {
 public:
  explicit ConnectionStream(Connection& connection) : connection_(connection) {}
  bool is_readable() const override { return true; }
  bool is_writable() const override { return connection_.client_listens(); }
  ssize_t read(char* buffer, size_t size) override { return connection_.read(buffer, size); }
  ssize_t write(const char* bytes, size_t size) override { return connection_.write(bytes, size); }
  void get_remote_ip_and_port(std::string&, int& port) const override { port = 0; }
  void get_local_ip_and_port(std::string&, int& port) const override { port = 0; }
  // Asked for only to refuse what select(2) could not take; here is no select.
  socket_t socket() const override { return 0; }

 private:
  Connection& connection_;
};

/// The library's accepting loop hands each new connection to such a queue.
struct AtOnce : httplib::TaskQueue {
  explicit AtOnce(std::function<void()> at_shutdown) : end(std::move(at_shutdown)) {}
  void enqueue(std::function<void()> task) override { task(); }
  void shutdown() override { end(); }
  std::function<void()> end;
};

}  // namespace

SocketServer::SocketServer(const HttpOptions& options,
                           std::function<std::string(api::ProblemCode)> refusal)
    : refusal_(std::move(refusal)),
      connections_(options.connections),
      transfers_(options.transfers),
      rules_{transfers_, options.transfer_timeout, stopping_},
      lobby_({options.header_timeout, options.idle_timeout}, refusal_),
      pool_(
          options.threads, [this] { return lobby_.next(); },
          [this](auto connection) { serve(std::move(connection)); }) {
  // The server deletes it.
  new_task_queue = [this] {
    return new AtOnce([this] { close_all(); });  // NOLINT(cppcoreguidelines-owning-memory)
  };
}

void SocketServer::deepen_queue() { ::listen(svr_sock_, SOMAXCONN); }

Connection& SocketServer::connection() { return *serving; }

bool SocketServer::process_and_close_socket(socket_t socket) {
  ::fcntl(socket, F_SETFD, FD_CLOEXEC);
  FileDescriptor owned(socket);
  Places::Place place = connections_.take();
  while (!place && lobby_.evict()) place = connections_.take();
  auto connection = std::make_unique<Connection>(std::move(owned), place, rules_);
  if (place) {
    lobby_.enter(std::move(connection));
  } else {
    connection->write_at_once(refusal_(api::ProblemCode::overloaded));
    lobby_.linger(std::move(connection));
  }
  return true;
}

void SocketServer::serve(std::unique_ptr<Connection> connection) {
  serving = connection.get();
  ConnectionStream stream(*connection);
  bool ends = false;
  bool whole = false;
  try {
    whole = process_request(stream, stopping_, ends, nullptr);
    whole = connection->flush() && whole;
  } catch (const std::exception& error) {
    spdlog::error("a connection failed: {}", error.what());
  }
  serving = nullptr;
  connection->end_request();
  if (whole && !ends && !connection->ends() && !stopping_)
    lobby_.wait(std::move(connection));
  else
    lobby_.linger(std::move(connection));
}

void SocketServer::close_all() {
  stopping_ = true;
  lobby_.close();
  pool_.close();
}

}  // namespace translucube::server

#pragma once

// A server with everything but the service behind it: calls of a few lines.

#include <gmock/gmock.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>

#include "server/calls/front.h"
#include "tests/server/fixture.h"
#include "tests/server/http/wire.h"

namespace translucube::server::test {

using std::chrono::milliseconds;
using std::chrono::seconds;
using std::chrono::steady_clock;
using testing::HasSubstr;
using testing::StartsWith;

inline const std::string get = "GET /small HTTP/1.1\r\nHost: localhost\r\n\r\n";

/// What a test's event stream says and what becomes of it.
struct FakeStream {
  std::mutex mutex;
  std::condition_variable changed;
  std::string pending;
  bool over = false;
  std::atomic<int> alive = 0, calls = 0;

  EventStream open() {
    ++alive;
    const std::shared_ptr<void> guard(this,
                                      [](void* self) { --static_cast<FakeStream*>(self)->alive; });
    return {[this, guard]() -> std::optional<std::string> {
      ++calls;
      std::unique_lock lock(mutex);
      changed.wait_for(lock, milliseconds(50), [this] { return over || !pending.empty(); });
      if (over && pending.empty()) return std::nullopt;
      return std::exchange(pending, {});
    }};
  }
  void say(const std::string& text, bool last = false) {
    const std::lock_guard lock(mutex);
    pending += text;
    over = last;
    changed.notify_all();
  }
};

/// Holds up who waits at it until it is opened.
struct Gate {
  std::atomic<bool> is_open = false;
  std::atomic<int> waiting = 0;

  void wait() {
    ++waiting;
    is_open.wait(false);
    --waiting;
  }
  void open() {
    is_open = true;
    is_open.notify_all();
  }
};

struct Sockets {
  explicit Sockets(HttpOptions options = {}, AccessPolicy policy = {})
      : front(std::move(policy), metrics,
              [this](const HttpRequest& request) { return answer(request); }),
        server(front.handlers(), options),
        thread([this] { server.run(); }) {
    while (!server.is_running()) std::this_thread::sleep_for(milliseconds(1));
  }
  ~Sockets() {
    gate.open();
    server.stop();
  }

  HttpResponse answer(const HttpRequest& request) {
    ++answered;
    if (request.path == "/events") return {200, {}, {}, stream.open()};
    if (request.path == "/slow") gate.wait();
    if (request.path == "/waiting") {
      request.give_way();
      gate.wait();
    }
    if (request.path == "/large") return {200, {}, "text/plain", std::string(16 << 20, 'x')};
    return {200, {}, "text/plain", "body of " + std::to_string(request.body.size())};
  }

  /// An answer to a small request in good time.
  void expect_service() {
    const auto start = steady_clock::now();
    std::string answer;
    do {  // a place is free a moment after its client has its answer
      Wire wire(server.port());
      EXPECT_TRUE(wire.send(get));
      answer = wire.receive();
    } while (answer.starts_with("HTTP/1.1 503") && steady_clock::now() - start < seconds(5));
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 200"));
    EXPECT_LT(steady_clock::now() - start, seconds(5));
  }

  std::atomic<int> answered = 0;
  FakeStream stream;
  Gate gate;
  Metrics metrics;
  Front front;
  HttpServer server;
  std::jthread thread;
};

}  // namespace translucube::server::test

// Clients that stay, stall and trickle, over a real socket.

#include "tests/server/http/sockets.h"

namespace translucube::server::test {
namespace {

TEST(SocketsTest, IdleConnectionsHoldNoThread) {
  HttpOptions options;
  options.threads = 2;
  Sockets sockets(options);
  std::vector<std::unique_ptr<Wire>> idle;
  for (int i = 0; i < 100; ++i) {
    idle.push_back(std::make_unique<Wire>(sockets.server.port()));
    if (i % 2 == 0) continue;
    ASSERT_TRUE(idle.back()->send(get));
    EXPECT_THAT(idle.back()->receive(), StartsWith("HTTP/1.1 200"));
  }
  sockets.expect_service();
  // Each is still good for a request.
  for (auto& wire : idle) {
    ASSERT_TRUE(wire->send(get));
    EXPECT_THAT(wire->receive(), StartsWith("HTTP/1.1 200"));
  }
}

TEST(SocketsTest, RequestsThatComeTogetherAreAnsweredInTurn) {
  Sockets sockets;
  Wire wire(sockets.server.port());
  const std::string post =
      "POST /small HTTP/1.1\r\nHost: localhost\r\nContent-Length: 3\r\n\r\nabc";
  std::string all;
  for (int i = 0; i < 20; ++i) all += i % 2 ? get : post;
  ASSERT_TRUE(wire.send(all));
  std::string text;
  const auto answers = [&] {
    int count = 0;
    for (std::size_t at = 0; (at = text.find("HTTP/1.1 200", at)) != text.npos; ++at) ++count;
    return count;
  };
  while (answers() < 20) {
    const std::string more = wire.receive(5000);
    ASSERT_FALSE(more.empty()) << text;
    text += more;
  }
  EXPECT_EQ(sockets.answered, 20);
}

TEST(SocketsTest, TheOldestIdleConnectionGivesWayToANewOne) {
  HttpOptions options;
  options.connections = 4;
  Sockets sockets(options);
  std::vector<std::unique_ptr<Wire>> idle;
  for (int i = 0; i < 4; ++i) idle.push_back(std::make_unique<Wire>(sockets.server.port()));
  std::this_thread::sleep_for(milliseconds(200));
  sockets.expect_service();
  EXPECT_TRUE(idle[0]->closed());
  EXPECT_FALSE(idle[3]->closed(100));
}

TEST(SocketsTest, WhereAllConnectionsAreServedANewOneIsToldToComeLater) {
  HttpOptions options;
  options.connections = 2;
  Sockets sockets(options);
  Wire first(sockets.server.port()), second(sockets.server.port());
  for (Wire* wire : {&first, &second})
    ASSERT_TRUE(wire->send("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n"));
  ASSERT_TRUE(eventually([&] { return sockets.stream.alive == 2; }));
  Wire third(sockets.server.port());
  const std::string answer = third.receive();
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 503"));
  EXPECT_THAT(answer, HasSubstr("Retry-After: "));
  EXPECT_THAT(answer, HasSubstr("problem:overloaded"));
  EXPECT_TRUE(third.closed());
}

TEST(SocketsTest, HeadersMustComeInTime) {
  HttpOptions options;
  options.threads = 2;
  options.header_timeout = milliseconds(400);
  Sockets sockets(options);
  std::vector<std::unique_ptr<Wire>> slow;
  for (int i = 0; i < 20; ++i) slow.push_back(std::make_unique<Wire>(sockets.server.port()));
  const auto start = steady_clock::now();
  for (const char byte : std::string("GET /")) {
    for (auto& wire : slow) wire->send(std::string_view(&byte, 1));
    sockets.expect_service();
  }
  for (auto& wire : slow) {
    const std::string answer = wire->receive();
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 408"));
    EXPECT_TRUE(wire->closed());
  }
  EXPECT_LT(steady_clock::now() - start, seconds(20));
  Wire silent(sockets.server.port());
  EXPECT_EQ(silent.receive(), "");
}

TEST(SocketsTest, AnIdleConnectionIsClosedInTheEnd) {
  HttpOptions options;
  options.idle_timeout = milliseconds(300);
  Sockets sockets(options);
  Wire wire(sockets.server.port());
  ASSERT_TRUE(wire.send(get));
  EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 200"));
  EXPECT_TRUE(wire.closed(5000));
}

TEST(SocketsTest, HeadersMayNotBeEndless) {
  Sockets sockets;
  Wire wire(sockets.server.port());
  wire.send("GET / HTTP/1.1\r\n");
  const std::string header = "X-" + std::string(1000, 'a') + ": b\r\n";
  for (int i = 0; i < 100 && wire.send(header); ++i) {
  }
  EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 431"));
}

TEST(SocketsTest, SlowBodiesHoldNoThreadAndHaveTheirTime) {
  HttpOptions options;
  options.threads = 2;
  options.transfers = 1;
  options.transfer_timeout = milliseconds(1500);
  Sockets sockets(options);
  const std::string head =
      "POST /small HTTP/1.1\r\nHost: localhost\r\nContent-Length: 100\r\n\r\n{";
  std::vector<std::unique_ptr<Wire>> slow;
  for (int i = 0; i < 40; ++i) {
    slow.push_back(std::make_unique<Wire>(sockets.server.port()));
    ASSERT_TRUE(slow.back()->send(head));
  }
  sockets.expect_service();
  // A body that comes in a second segment is as good as one that comes along with its head.
  for (int i = 0; i < 20; ++i) {
    Wire wire(sockets.server.port());
    ASSERT_TRUE(wire.send(head));
    std::this_thread::sleep_for(milliseconds(5));
    ASSERT_TRUE(wire.send(std::string(99, ' ')));
    EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 200"));
  }
  for (auto& wire : slow) {
    EXPECT_THAT(wire->receive(), StartsWith("HTTP/1.1 408"));
    EXPECT_TRUE(wire->closed());
  }
  EXPECT_EQ(sockets.answered, 21);
  EXPECT_THAT(sockets.metrics.text(), HasSubstr(R"(method="POST",route="other",status="408"} 40)"));
}

TEST(SocketsTest, BodiesThatComeInPartAreBoundedInMemory) {
  HttpOptions options;
  options.body_bytes = 4 << 20;
  Sockets sockets(options);
  const std::string head =
      "POST /small HTTP/1.1\r\nHost: localhost\r\nContent-Length: 4000000\r\n\r\n";
  std::vector<std::unique_ptr<Wire>> large;
  for (int i = 0; i < 24; ++i) {
    large.push_back(std::make_unique<Wire>(sockets.server.port()));
    large.back()->send(head + std::string(3'900'000, ' '));
  }
  // Of 64 MiB that may be held, the oldest make room.
  EXPECT_THAT(large[0]->receive(), StartsWith("HTTP/1.1 503"));
  large.back()->send(std::string(100'000, ' '));
  EXPECT_THAT(large.back()->receive(), StartsWith("HTTP/1.1 200"));
  sockets.expect_service();
}

TEST(SocketsTest, ClientsThatDoNotReadAreLeft) {
  HttpOptions options;
  options.threads = 3;
  options.transfers = 2;
  options.transfer_timeout = milliseconds(500);
  Sockets sockets(options);
  std::vector<std::unique_ptr<Wire>> deaf;
  for (int i = 0; i < 6; ++i) {
    deaf.push_back(std::make_unique<Wire>(sockets.server.port()));
    ASSERT_TRUE(deaf.back()->send("GET /large HTTP/1.1\r\nHost: localhost\r\n\r\n"));
  }
  ASSERT_TRUE(eventually([&] { return sockets.answered == 6; }));
  sockets.expect_service();
}

}  // namespace
}  // namespace translucube::server::test

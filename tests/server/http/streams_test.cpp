// Event streams, and who gets none, over a real socket.

#include "tests/server/http/sockets.h"

namespace translucube::server::test {
namespace {

TEST(RoutesStreamTest, EventsComeAsTheyAreSaid) {
  Sockets sockets;
  Wire wire(sockets.server.port());
  ASSERT_TRUE(wire.send("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n"));
  const std::string head = wire.receive();
  EXPECT_THAT(head, StartsWith("HTTP/1.1 200"));
  for (const char* header : {"Content-Type: text/event-stream", "Cache-Control: no-store",
                             "X-Accel-Buffering: no", "Transfer-Encoding: chunked"})
    EXPECT_THAT(head, HasSubstr(header));
  EXPECT_THAT(sockets.metrics.text(), HasSubstr("translucube_event_streams_open 1\n"));
  const auto read_to = [&](const std::string& end) {
    std::string text;
    for (int i = 0; i < 100 && !text.ends_with(end); ++i) text += wire.receive_some();
    return text;
  };
  sockets.stream.say("data: 1\n\n");
  EXPECT_EQ(read_to("\r\n"), "9\r\ndata: 1\n\n\r\n");
  sockets.stream.say("data: 2\n\n", true);
  EXPECT_EQ(read_to("0\r\n\r\n"), "9\r\ndata: 2\n\n\r\n0\r\n\r\n");
  ASSERT_TRUE(eventually([&] { return sockets.stream.alive == 0; }));
  // The connection is good for more.
  ASSERT_TRUE(wire.send(get));
  EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 200"));
}

TEST(RoutesStreamTest, AStreamEndsAsSoonAsItsClientHangsUp) {
  Sockets sockets;
  {
    Wire wire(sockets.server.port());
    ASSERT_TRUE(wire.send("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n"));
    ASSERT_TRUE(eventually([&] { return sockets.stream.calls > 2; }));
    EXPECT_EQ(sockets.stream.alive, 1);
  }
  const auto start = steady_clock::now();
  ASSERT_TRUE(eventually([&] { return sockets.stream.alive == 0; }));
  EXPECT_LT(steady_clock::now() - start, seconds(5));
  EXPECT_THAT(sockets.metrics.text(), HasSubstr("translucube_event_streams_open 0\n"));
}

TEST(RoutesStreamTest, AStopEndsStreams) {
  auto sockets = std::make_unique<Sockets>();
  Wire wire(sockets->server.port());
  ASSERT_TRUE(wire.send("GET /events HTTP/1.1\r\nHost: localhost\r\n\r\n"));
  ASSERT_TRUE(eventually([&] { return sockets->stream.alive == 1; }));
  const auto start = steady_clock::now();
  sockets->server.stop();
  sockets->thread.join();
  EXPECT_LT(steady_clock::now() - start, seconds(5));
  EXPECT_EQ(sockets->stream.alive, 0);
  while (!wire.receive_some().empty()) {
  }
}

TEST(RoutesAccessTest, RefusalsComeBeforeTheBodyAndMetricsNeedTheToken) {
  Sockets sockets({}, {false, {{"ci", sha256("secret")}}, {}, {}});
  Wire post(sockets.server.port());
  ASSERT_TRUE(post.send("POST /small HTTP/1.1\r\nHost: a\r\nContent-Length: 1000000\r\n\r\n{"));
  const std::string refusal = post.receive();
  EXPECT_THAT(refusal, StartsWith("HTTP/1.1 401"));
  EXPECT_THAT(refusal, HasSubstr("WWW-Authenticate: Bearer"));
  EXPECT_TRUE(post.closed());
  const auto status = [&](const std::string& path, const std::string& headers) {
    Wire wire(sockets.server.port());
    wire.send("GET " + path + " HTTP/1.1\r\nHost: a\r\n" + headers + "\r\n");
    return wire.receive();
  };
  EXPECT_THAT(status("/metrics", ""), StartsWith("HTTP/1.1 401"));
  // A Range that the library cannot read takes another way through it.
  EXPECT_THAT(status("/small", "Range: bytes=x\r\n"), StartsWith("HTTP/1.1 401"));
  EXPECT_EQ(sockets.answered, 0);
  EXPECT_THAT(status("/livez", ""), StartsWith("HTTP/1.1 200"));
  // What was answered is counted a little later.
  const std::string counted =
      R"(translucube_http_requests_total{method="GET",route="/metrics",status="401"} 1)";
  EXPECT_TRUE(eventually([&] {
    const std::string metrics = status("/metrics", "Authorization: Bearer secret\r\n");
    return metrics.find("text/plain; version=0.0.4") != metrics.npos &&
           metrics.find(counted) != metrics.npos;
  }));
}

}  // namespace
}  // namespace translucube::server::test

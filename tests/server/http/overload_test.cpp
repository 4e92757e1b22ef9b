// More is asked at once than can be answered.

#include <sys/resource.h>

#include "tests/server/http/sockets.h"

namespace translucube::server::test {
namespace {

std::string asking_for(const std::string& path) {
  return "GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n";
}

std::vector<std::unique_ptr<Wire>> all_ask_for(const Sockets& sockets, const std::string& path,
                                               int count) {
  std::vector<std::unique_ptr<Wire>> wires;
  for (int i = 0; i < count; ++i) {
    wires.push_back(std::make_unique<Wire>(sockets.server.port()));
    EXPECT_TRUE(wires.back()->send(asking_for(path)));
  }
  return wires;
}

void expect_probes(const Sockets& sockets) {
  for (const char* path : {"/livez", "/readyz"}) {
    const auto start = steady_clock::now();
    Wire wire(sockets.server.port());
    wire.send(asking_for(path));
    EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 200")) << path;
    EXPECT_LT(steady_clock::now() - start, seconds(1)) << path;
  }
}

std::string count_of(const std::string& status, int count) {
  return R"(translucube_http_requests_total{method="GET",route="other",status=")" + status +
         "\"} " + std::to_string(count) + '\n';
}

TEST(OverloadTest, SoManyAreAnsweredSoManyStandInLineAndTheOthersComeLater) {
  HttpOptions options;
  options.answering = 3;
  options.in_line = 5;
  Sockets sockets(options);
  auto wires = all_ask_for(sockets, "/slow", 50);
  EXPECT_TRUE(eventually(
      [&] { return sockets.metrics.text().find(count_of("503", 42)) != std::string::npos; }));
  EXPECT_EQ(sockets.gate.waiting, 3);
  expect_probes(sockets);
  sockets.gate.open();
  EXPECT_TRUE(eventually(
      [&] { return sockets.metrics.text().find(count_of("200", 8)) != std::string::npos; }));
  int answered = 0;
  for (auto& wire : wires) {
    const std::string answer = wire->receive();
    answered += answer.starts_with("HTTP/1.1 200");
    EXPECT_THAT(answer, testing::AnyOf(StartsWith("HTTP/1.1 200"),
                                       testing::AllOf(StartsWith("HTTP/1.1 503"),
                                                      HasSubstr("Retry-After: "))));
  }
  EXPECT_EQ(answered, 8);
}

TEST(OverloadTest, WhoAsksAgainAtOnceIsHeardALittleLater) {
  HttpOptions options;
  options.answering = 1;
  options.in_line = 0;
  Sockets sockets(options);
  auto busy = all_ask_for(sockets, "/slow", 1);
  ASSERT_TRUE(eventually([&] { return sockets.gate.waiting == 1; }));
  Wire wire(sockets.server.port());
  const auto start = steady_clock::now();
  for (int i = 0; i < 4; ++i) {
    wire.send(asking_for("/small"));
    EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 503"));
  }
  EXPECT_GE(steady_clock::now() - start, milliseconds(600));
  sockets.gate.open();
  EXPECT_THAT(busy[0]->receive(), StartsWith("HTTP/1.1 200"));
  wire.send(get);
  EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 200"));
}

TEST(OverloadTest, NobodyStandsInLineForLong) {
  HttpOptions options;
  options.answering = 1;
  Sockets sockets(options);
  auto first = all_ask_for(sockets, "/slow", 1);
  ASSERT_TRUE(eventually([&] { return sockets.gate.waiting == 1; }));
  const auto start = steady_clock::now();
  auto second = all_ask_for(sockets, "/slow", 1);
  EXPECT_THAT(second[0]->receive(), StartsWith("HTTP/1.1 503"));
  EXPECT_LT(steady_clock::now() - start, seconds(10));
}

TEST(OverloadTest, WhoWaitsGivesWay) {
  HttpOptions options;
  options.answering = 2;
  options.in_line = 0;
  Sockets sockets(options);
  auto waiting = all_ask_for(sockets, "/waiting", 20);
  ASSERT_TRUE(eventually([&] { return sockets.gate.waiting == 20; }));
  sockets.expect_service();
  sockets.gate.open();
  for (auto& wire : waiting) EXPECT_THAT(wire->receive(), StartsWith("HTTP/1.1 200"));
}

TEST(OverloadTest, TheLastThreadIsForProbes) {
  HttpOptions options;
  options.threads = 2;
  options.in_line = 0;
  Sockets sockets(options);
  auto waiting = all_ask_for(sockets, "/waiting", 2);
  ASSERT_TRUE(eventually([&] { return sockets.gate.waiting == 2; }));
  auto late = all_ask_for(sockets, "/small", 10);
  for (auto& wire : late) EXPECT_THAT(wire->receive(), StartsWith("HTTP/1.1 503"));
  expect_probes(sockets);
  sockets.gate.open();
  for (auto& wire : waiting) EXPECT_THAT(wire->receive(), StartsWith("HTTP/1.1 200"));
  sockets.expect_service();
}

TEST(OverloadTest, AClientThatDoesNotReadKeepsNoProbeWaiting) {
  HttpOptions options;
  options.threads = 0;  // but for the last one
  options.in_line = 0;
  options.transfer_timeout = milliseconds(20'000);
  Sockets sockets(options);
  // Probes are asked for until their answers no longer fit.
  Wire deaf(sockets.server.port());
  std::string many;
  for (int i = 0; i < 1000; ++i) many += asking_for("/livez");
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 10; ++j) deaf.send_some(many);
    expect_probes(sockets);
    std::this_thread::sleep_for(milliseconds(20));
  }
}

TEST(OverloadTest, ARangeOfManyDigitsIsPassedOverCheaply) {
  Sockets sockets;
  for (const std::string& range :
       {"bytes=" + std::string(8000, '1'), "bytes=" + std::string(4000, '-'),
        "bytes=0-" + std::string(7000, '9'), std::string(8000, '=')}) {
    Wire wire(sockets.server.port());
    wire.send("GET /small HTTP/1.1\r\nHost: localhost\r\nRange: " + range + "\r\n\r\n");
    EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 200"));
  }
}

TEST(OverloadTest, WhereNoDescriptorIsLeftIdleConnectionsGiveWay) {
  Sockets sockets;
  std::vector<std::unique_ptr<Wire>> idle;
  for (int i = 0; i < 20; ++i) idle.push_back(std::make_unique<Wire>(sockets.server.port()));
  std::this_thread::sleep_for(milliseconds(100));
  // All descriptors that the process may still have are taken, but for those of clients.
  rlimit before{};
  ::getrlimit(RLIMIT_NOFILE, &before);
  std::vector<FileDescriptor> clients;
  for (int i = 0; i < 5; ++i)
    clients.emplace_back(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const FileDescriptor highest(::dup(0));
  const rlimit none{static_cast<rlim_t>(highest.get()) + 1, before.rlim_max};
  ::setrlimit(RLIMIT_NOFILE, &none);
  for (const FileDescriptor& client : clients) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(sockets.server.port()));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(client.get(), reinterpret_cast<const sockaddr*>(&address), sizeof address),
              0);
    const std::string ask = asking_for("/small");
    EXPECT_GT(::send(client.get(), ask.data(), ask.size(), MSG_NOSIGNAL), 0);
    pollfd poll{client.get(), POLLIN, 0};
    EXPECT_EQ(::poll(&poll, 1, 5000), 1) << "no answer";
  }
  ::setrlimit(RLIMIT_NOFILE, &before);
  EXPECT_TRUE(idle[0]->closed());
}

}  // namespace
}  // namespace translucube::server::test

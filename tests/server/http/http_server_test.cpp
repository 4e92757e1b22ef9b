// The service over a real socket: what the library would do wrong by itself.

#include <gmock/gmock.h>
#include <httplib.h>

#include <nlohmann/json.hpp>

#include "server/calls/front.h"
#include "server/http/server.h"
#include "tests/server/calls/calls_under_test.h"
#include "tests/server/http/wire.h"
#include "tests/support/malformed_corpus.h"

namespace translucube::server::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

HttpOptions few_threads(std::uint64_t body_bytes, int threads) {
  HttpOptions options;
  options.body_bytes = body_bytes;
  options.threads = threads;
  return options;
}

struct Served : CallsUnderTest {
  explicit Served(int workers = 1, int threads = 8)
      : CallsUnderTest(workers),
        server(handlers(), few_threads(service.catalog.limits.body_bytes, threads)),
        thread([this] { server.run(); }) {
    while (!server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    client.set_read_timeout(60);
    // Else each body waits for the delayed acknowledgement of its headers.
    client.set_tcp_nodelay(true);
  }
  ~Served() {
    service.service.shut_down();
    server.stop();
  }
  HttpHandlers handlers() {
    HttpHandlers all;
    all.respond = [this](const HttpRequest& request) { return respond(context, request); };
    return all;
  }

  HttpServer server;
  std::jthread thread;
  httplib::Client client{"127.0.0.1", server.port()};
};

std::string type_of(const httplib::Result& result) {
  EXPECT_TRUE(result) << to_string(result.error());
  if (!result) return {};
  EXPECT_EQ(result->get_header_value("Content-Type"), "application/problem+json");
  const json body = json::parse(result->body);
  EXPECT_EQ(body["status"], result->status);
  const std::string type = body["type"];
  return type.substr(type.rfind(':') + 1);
}

TEST(HttpServerTest, ARenderGoesInAndItsPictureComesOut) {
  Served served;
  const auto posted = served.client.Post("/v1/renders", {{"Prefer", "wait=20"}}, small_request(8),
                                         "application/json");
  ASSERT_TRUE(posted);
  ASSERT_EQ(posted->status, 200) << posted->body;
  const std::string location = posted->get_header_value("Location");
  const auto png = served.client.Get(location + "/image");
  EXPECT_EQ(png->status, 200);
  EXPECT_THAT(png->body, StartsWith("\x89PNG"));
  const auto exr = served.client.Get(location + "/image?format=exr");
  EXPECT_EQ(exr->body, served.service.exr(json::parse(posted->body)["id"]));

  const auto part = served.client.Get(location + "/image?format=exr", {{"Range", "bytes=100-199"}});
  EXPECT_EQ(part->status, 206);
  EXPECT_EQ(part->body, exr->body.substr(100, 100));
  const auto none = served.client.Get(location + "/image", {{"Range", "bytes=9999999-"}});
  EXPECT_EQ(none->status, 416);
  EXPECT_EQ(type_of(none), "range-not-satisfiable");
  // A status is no picture: ranges are not for it.
  EXPECT_EQ(served.client.Get(location, {{"Range", "bytes=0-3"}})->status, 200);

  EXPECT_EQ(served.client.Delete(location)->status, 204);
  EXPECT_EQ(type_of(served.client.Get(location)), "not-found");
}

TEST(HttpServerTest, ARangeThatIsNoneIsIgnored) {
  Served served;
  const auto posted = served.client.Post("/v1/renders", {{"Prefer", "wait=20"}}, small_request(4),
                                         "application/json");
  const std::string image = posted->get_header_value("Location") + "/image";
  for (const char* range : {"items=0-3", "bytes=x", "bytes=5-1", "bytes=0-0,2-2"}) {
    const auto answer = served.client.Get(image, {{"Range", range}});
    ASSERT_TRUE(answer) << range;
    EXPECT_EQ(answer->status, 200) << range;
    EXPECT_THAT(answer->body, StartsWith("\x89PNG")) << range;
  }
  std::string many = "bytes=0-0";
  while (many.size() < 8000) many += ",0-0";
  EXPECT_EQ(served.client.Get(image, {{"Range", many}})->status, 200);
}

TEST(HttpServerTest, HeadHasTheHeadersOfGetAndNoBody) {
  Served served;
  const auto posted = served.client.Post("/v1/renders", {{"Prefer", "wait=20"}}, small_request(4),
                                         "application/json");
  const std::string image = posted->get_header_value("Location") + "/image";
  const auto get = served.client.Get(image), head = served.client.Head(image);
  EXPECT_EQ(head->status, 200);
  EXPECT_TRUE(head->body.empty());
  for (const char* name : {"Content-Length", "Content-Type", "ETag", "Vary"})
    EXPECT_EQ(head->get_header_value(name), get->get_header_value(name)) << name;
  EXPECT_EQ(served.client.Head("/nowhere")->status, 404);
}

TEST(HttpServerTest, AnUnchangedPictureIsNotSentAgain) {
  Served served;
  const auto posted = served.client.Post("/v1/renders", {{"Prefer", "wait=20"}}, small_request(4),
                                         "application/json");
  const std::string image = posted->get_header_value("Location") + "/image";
  const std::string etag = served.client.Get(image)->get_header_value("ETag");
  const auto same = served.client.Get(image, {{"If-None-Match", etag}});
  EXPECT_EQ(same->status, 304);
  EXPECT_FALSE(same->has_header("Content-Length"));
  EXPECT_TRUE(same->body.empty());
}

TEST(HttpServerTest, EveryAnswerHasARequestIdTheClientsWhereItGaveOne) {
  Served served;
  EXPECT_EQ(served.client.Get("/livez", {{"X-Request-Id", "abc-1.2_3"}})
                ->get_header_value("X-Request-Id"),
            "abc-1.2_3");
  for (const char* path : {"/livez", "/nowhere"}) {
    const auto answer = served.client.Get(path, {{"X-Request-Id", "not; an id"}});
    EXPECT_EQ(answer->get_header_value("X-Request-Id").size(), 16u);
    EXPECT_EQ(answer->get_header_value_count("X-Request-Id"), 1u);
  }
}

TEST(HttpServerTest, WrongMethodsAndPathsAreProblems) {
  Served served;
  const auto put = served.client.Put("/v1/renders", "{}", "application/json");
  EXPECT_EQ(type_of(put), "method-not-allowed");
  EXPECT_EQ(put->get_header_value("Allow"), "POST, GET, HEAD");
  EXPECT_EQ(type_of(served.client.Patch("/v1/renders", "{}", "application/json")),
            "method-not-allowed");
  EXPECT_EQ(type_of(served.client.Post("/nowhere", "{}", "application/json")), "not-found");
  EXPECT_EQ(type_of(served.client.Get("/v1/renders/..%2f..%2fetc%2fpasswd")), "not-found");
  EXPECT_EQ(type_of(served.client.Get("/v1/renders?limit=1&limit=2")), "invalid-request");
  EXPECT_EQ(type_of(served.client.Get("/livez?verbose=1")), "invalid-request");
}

TEST(HttpServerTest, ABodyOf64MebibytesIsRefusedAndTheServiceGoesOn) {
  Served served;
  const std::string body(std::size_t(64) << 20, ' ');
  EXPECT_EQ(type_of(served.client.Post("/v1/renders", body, "application/json")),
            "payload-too-large");
  // In chunks, whose sum is not announced.
  std::size_t left = body.size();
  EXPECT_EQ(type_of(served.client.Post(
                "/v1/renders",
                [&](std::size_t, httplib::DataSink& sink) {
                  const std::size_t size = std::min<std::size_t>(left, 1 << 16);
                  sink.write(body.data(), size);
                  left -= size;
                  if (left == 0) sink.done();
                  return true;
                },
                "application/json")),
            "payload-too-large");
  EXPECT_EQ(served.client.Get("/livez")->status, 200);
}

TEST(HttpServerTest, ABodyThatIsNotJsonOrIsCodedIsRefusedUnread) {
  Served served;
  EXPECT_EQ(type_of(served.client.Post("/v1/renders", small_request(4), "text/plain")),
            "unsupported-media-type");
  EXPECT_EQ(type_of(served.client.Post("/v1/renders", {{"Content-Encoding", "gzip"}},
                                       std::string(100, '\x1f'), "application/json")),
            "unsupported-media-type");
  const httplib::MultipartFormDataItems items{{"a", "b", "", ""}};
  EXPECT_EQ(type_of(served.client.Post("/v1/renders", items)), "unsupported-media-type");
  const httplib::Params form{{"a", std::string(10'000, 'b')}};
  EXPECT_EQ(type_of(served.client.Post("/v1/renders", form)), "unsupported-media-type");
}

TEST(HttpServerTest, AnEmptyIdempotencyKeyIsNoKey) {
  Served served;
  Wire wire(served.server.port());
  const std::string body = small_request(4);
  wire.send("POST /v1/renders HTTP/1.1\r\nHost: x\r\nIdempotency-Key:\r\nContent-Length: " +
            std::to_string(body.size()) + "\r\n\r\n" + body);
  const std::string answer = wire.receive();
  EXPECT_THAT(answer, StartsWith("HTTP/1.1 422"));
  EXPECT_THAT(answer, HasSubstr("Idempotency-Key"));
}

TEST(HttpServerTest, APostOrDeleteWithoutABodyIsNotWaitedFor) {
  Served served;
  const auto start = std::chrono::steady_clock::now();
  for (const char* method : {"POST /v1/renders/01ARZ3NDEKTSV4RRFFQ69G5FAV/cancel",
                             "DELETE /v1/renders/01ARZ3NDEKTSV4RRFFQ69G5FAV", "POST /v1/renders"}) {
    Wire wire(served.server.port());
    wire.send(std::string(method) + " HTTP/1.1\r\nHost: x\r\n\r\n");
    EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 4")) << method;
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(3));
}

TEST(HttpServerTest, WhatIsNotHttpIsAProblemAndTheConnectionEnds) {
  Served served;
  const std::string post = "POST /v1/renders HTTP/1.1\r\nHost: x\r\n";
  const std::string malformed = "malformed-http";
  const std::vector<std::pair<std::string, std::string>> requests{
      {"nonsense\r\n\r\n", malformed},
      {"GET / HTTP/1.1 \r\nHost: x\r\n\r\n", malformed},
      {"GET /livez HTTP/1.1\r\nHost: x\r\nContent-Length: 5\r\n\r\nhello", malformed},
      {post + "Content-Length: -1\r\n\r\n", malformed},
      {post + "Content-Length: 5\r\nContent-Length: 6\r\n\r\nhello", malformed},
      {post + "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", malformed},
      {post + "Transfer-Encoding: chunked\r\n\r\nZZ\r\nhello\r\n0\r\n\r\n", malformed},
      {post + "Content-Length: 18446744073709551615\r\n\r\n", "payload-too-large"},
      {"GET /" + std::string(10'000, 'a') + " HTTP/1.1\r\nHost: x\r\n\r\n", "uri-too-long"},
  };
  for (const auto& [request, type] : requests) {
    Wire wire(served.server.port());
    wire.send(request);
    const std::string answer = wire.receive();
    EXPECT_THAT(answer, StartsWith("HTTP/1.1 4")) << request.substr(0, 100);
    EXPECT_THAT(answer, HasSubstr("application/problem+json")) << request.substr(0, 100);
    EXPECT_THAT(answer, HasSubstr("\"urn:translucube:problem:" + type + '"'))
        << request.substr(0, 100);
    EXPECT_TRUE(wire.closed()) << request.substr(0, 100);
  }
  EXPECT_EQ(served.client.Get("/livez")->status, 200);
}

TEST(HttpServerTest, AClientThatAsksBeforeItSendsTooMuchIsSparedTheSending) {
  Served served;
  Wire wire(served.server.port());
  wire.send(
      "POST /v1/renders HTTP/1.1\r\nHost: x\r\nContent-Length: 67108864\r\n"
      "Expect: 100-continue\r\n\r\n");
  EXPECT_THAT(wire.receive(), StartsWith("HTTP/1.1 413"));
}

TEST(HttpServerTest, ALongPathDoesNoHarm) {
  Served served;
  const std::string path = '/' + std::string(8000, 'a');
  EXPECT_EQ(type_of(served.client.Get(path)), "not-found");
  EXPECT_EQ(type_of(served.client.Post(path, "{}", "application/json")), "not-found");
}

TEST(HttpServerTest, AFailureOfOursTellsNothingOfItself) {
  Served served(0);
  const auto posted = served.client.Post("/v1/renders", small_request(4), "application/json");
  const std::string location = posted->get_header_value("Location");
  // A store whose row is no JSON any more.
  NewJob broken{"not json", "not json either", {}, 4, Pass{0, 0, 4}, "broken"};
  const auto submitted = *served.service.store.submit(broken);
  const auto answer = served.client.Get("/v1/renders/" + submitted.stored.id);
  EXPECT_EQ(answer->status, 500);
  EXPECT_EQ(type_of(answer), "internal");
  std::string all = answer->body;
  for (const auto& [name, value] : answer->headers) all += name + value;
  EXPECT_THAT(all, Not(HasSubstr("not JSON")));
  EXPECT_THAT(all, Not(HasSubstr("what")));
  EXPECT_EQ(served.client.Get(location)->status, 200);
}

TEST(HttpServerTest, ASecondServiceOnThePortIsRefused) {
  Served served;
  HttpOptions options;
  options.port = served.server.port();
  EXPECT_THROW(HttpServer(served.handlers(), options), ListenError);
  options.host = "no.such.host.invalid";
  EXPECT_THROW(HttpServer(served.handlers(), options), ListenError);
}

TEST(HttpServerTest, ClientsThatWaitLeaveThreadsForProbes) {
  Served served(1, 8);
  const auto crowd = take_all_but(4, served.context.waiting);
  served.renderer.milliseconds_per_pass = 60'000;
  std::vector<std::jthread> waiting;
  for (int i = 0; i < 12; ++i)
    waiting.emplace_back([&] {
      httplib::Client client("127.0.0.1", served.server.port());
      client.set_read_timeout(60);
      const auto answer =
          client.Post("/v1/renders", {{"Prefer", "wait=30"}}, small_request(4), "application/json");
      ASSERT_TRUE(answer);
      EXPECT_EQ(answer->status, 202);
    });
  ASSERT_TRUE(eventually([&] { return served.context.waiting.free() == 0; }));
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < 20; ++i) {
    httplib::Client client("127.0.0.1", served.server.port());
    const auto answer = client.Get("/livez");
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->status, 200);
  }
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(15));
  served.service.service.shut_down();
}

TEST(HttpServerTest, AStopEndsWaitingClientsAndIdleConnectionsSoon) {
  auto served = std::make_unique<Served>();
  served->renderer.milliseconds_per_pass = 60'000;
  std::jthread waiting([port = served->server.port()] {
    httplib::Client client("127.0.0.1", port);
    client.set_read_timeout(60);
    const auto answer =
        client.Post("/v1/renders", {{"Prefer", "wait=60"}}, small_request(4), "application/json");
    EXPECT_TRUE(answer);
  });
  served->client.set_keep_alive(true);
  served->client.Get("/livez");
  ASSERT_TRUE(eventually([&] {
    return served->context.waiting.free() == served->service.config.waiting_requests - 1;
  }));
  const auto start = std::chrono::steady_clock::now();
  served.reset();
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(8));
}

TEST(HttpServerTest, MalformedBodiesGetProblemsAndTheNextGoodRenderSucceeds) {
  Served served;
  const auto corpus = translucube::test::malformed_bodies();
  ASSERT_GE(corpus.size(), 200u);
  served.client.set_keep_alive(true);
  for (const auto& bad : corpus) {
    const auto answer = served.client.Post("/v1/renders", bad.text, "application/json");
    ASSERT_TRUE(answer) << bad.name << ": " << to_string(answer.error());
    EXPECT_EQ(answer->status, bad.status) << bad.name << '\n' << answer->body;
    EXPECT_EQ(answer->get_header_value("Content-Type"), "application/problem+json") << bad.name;
    const json problem = json::parse(answer->body, nullptr, false);
    ASSERT_FALSE(problem.is_discarded()) << bad.name;
    EXPECT_EQ(problem["status"], bad.status) << bad.name;
    EXPECT_TRUE(problem["type"].is_string() && problem["title"].is_string()) << bad.name;
    if (bad.pointer.empty()) continue;
    const auto names_it = [&](const json& error) { return error["pointer"] == bad.pointer; };
    EXPECT_TRUE(std::ranges::any_of(problem["errors"], names_it)) << bad.name << '\n'
                                                                  << answer->body;
  }
  const auto good = served.client.Post("/v1/renders", {{"Prefer", "wait=20"}}, small_request(4),
                                       "application/json");
  EXPECT_EQ(good->status, 200);
  EXPECT_EQ(json::parse(good->body)["state"], "succeeded");
  EXPECT_EQ(served.service.store.list({{}, {}, 1000}).size(), 1u);
}

}  // namespace
}  // namespace translucube::server::test

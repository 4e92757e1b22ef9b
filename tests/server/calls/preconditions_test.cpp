// If-Match and If-None-Match (RFC 9110, 13) on every method.

#include "server/calls/preconditions.h"

#include <gmock/gmock.h>

#include "tests/server/calls/calls_under_test.h"

namespace translucube::server::test {
namespace {

using Headers = CallsUnderTest::Headers;

struct Conditions : CallsUnderTest {
  Conditions() : CallsUnderTest(0) {}

  HttpResponse ask(const std::string& method, const std::string& path, Headers headers) {
    return respond(context, {method, path, {}, std::move(headers), {}});
  }
  std::string etag(const std::string& path) { return header(get(path), "ETag"); }
};

TEST(PreconditionsTest, GetIsAnsweredWhereTheTagIsTheRightOne) {
  Conditions tested;
  const std::string path = "/v1/renders/" + tested.service.submit(small_request(4)).id;
  const std::string tag = tested.etag(path);
  ASSERT_FALSE(tag.empty());
  for (const std::string method : {"GET", "HEAD"}) {
    const auto status = [&](Headers headers) {
      return tested.ask(method, path, std::move(headers)).status;
    };
    EXPECT_EQ(status({{"if-match", tag}}), 200);
    EXPECT_EQ(status({{"if-match", "\"a\", " + tag}}), 200);
    EXPECT_EQ(status({{"if-match", "*"}}), 200);
    EXPECT_EQ(status({{"if-match", "\"nope\""}}), 412);
    EXPECT_EQ(status({{"if-match", "W/" + tag}}), 412);
    EXPECT_EQ(status({{"if-match", ""}}), 412);
    EXPECT_EQ(status({{"if-none-match", tag}}), 304);
    EXPECT_EQ(status({{"if-none-match", "W/" + tag}}), 304);
    EXPECT_EQ(status({{"if-none-match", "\"a\", " + tag}}), 304);
    EXPECT_EQ(status({{"if-none-match", "*"}}), 304);
    EXPECT_EQ(status({{"if-none-match", "\"nope\""}}), 200);
    EXPECT_EQ(status({{"if-none-match", ""}}), 200);
    // If-Match comes first (RFC 9110, 13.2.2).
    EXPECT_EQ(status({{"if-match", "\"nope\""}, {"if-none-match", tag}}), 412);
    EXPECT_EQ(status({{"if-match", tag}, {"if-none-match", tag}}), 304);
  }
  const HttpResponse unchanged = tested.ask("GET", path, {{"if-none-match", tag}});
  EXPECT_EQ(header(unchanged, "ETag"), tag);
  EXPECT_EQ(std::get<std::string>(unchanged.body), "");
  EXPECT_EQ(unchanged.content_type, "");
}

TEST(PreconditionsTest, NothingIsChangedWhereTheTagIsAnother) {
  Conditions tested;
  const std::string path = "/v1/renders/" + tested.service.submit(small_request(4)).id;
  const auto status = [&](const std::string& method, const std::string& of, Headers headers) {
    return tested.ask(method, of, std::move(headers)).status;
  };
  for (const Headers& unmet :
       std::initializer_list<Headers>{{{"if-match", "\"nope\""}},
                                      {{"if-match", ""}},
                                      {{"if-match", "W/" + tested.etag(path)}},
                                      {{"if-none-match", "*"}},
                                      {{"if-none-match", tested.etag(path)}}}) {
    EXPECT_EQ(status("DELETE", path, unmet), 412);
    EXPECT_EQ(status("POST", path + "/cancel", unmet), 412);
    EXPECT_EQ(status("GET", path, {}), 200);
  }
  EXPECT_EQ(tested.service.state(path.substr(12)), api::JobState::queued);
  EXPECT_EQ(status("POST", path + "/cancel", {{"if-match", tested.etag(path)}}), 200);
  EXPECT_EQ(tested.service.state(path.substr(12)), api::JobState::canceled);
  EXPECT_EQ(status("DELETE", path, {{"if-match", "\"x\", " + tested.etag(path)}}), 204);
  // What is not there is not there, whatever the precondition (RFC 9110, 13.2.1).
  EXPECT_EQ(status("DELETE", path, {{"if-match", "*"}}), 404);
  EXPECT_EQ(status("DELETE", path, {{"if-none-match", "*"}}), 404);
  EXPECT_EQ(status("GET", path, {{"if-match", "\"x\""}}), 404);
}

TEST(PreconditionsTest, AListIsWhatAPostOfARenderChanges) {
  Conditions tested;
  const auto post = [&](Headers headers) {
    return respond(tested.context,
                   {"POST", "/v1/renders", {}, std::move(headers), small_request(4)})
        .status;
  };
  const std::string tag = tested.etag("/v1/renders");
  EXPECT_EQ(post({{"if-match", "\"nope\""}}), 412);
  EXPECT_EQ(tested.etag("/v1/renders"), tag);
  EXPECT_EQ(post({{"if-match", tag}}), 202);
  EXPECT_NE(tested.etag("/v1/renders"), tag);
  EXPECT_EQ(post({{"if-match", tag}}), 412);
}

TEST(PreconditionsTest, OptionsOfTheWholeServiceAndOfAPath) {
  Conditions tested;
  const HttpResponse all = tested.ask("OPTIONS", "*", {});
  EXPECT_EQ(all.status, 204);
  EXPECT_EQ(header(all, "Allow"), "GET, HEAD, POST, PUT, DELETE");
  EXPECT_EQ(tested.ask("OPTIONS", "/v1/nowhere", {}).status, 404);
  EXPECT_EQ(header(tested.ask("OPTIONS", "/v1/renders", {}), "Allow"), "POST, GET, HEAD");
}

}  // namespace
}  // namespace translucube::server::test

// The calls of the service with requests made by hand: no sockets.

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/server/calls/calls_under_test.h"

namespace translucube::server::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

struct FrontUnderTest : CallsUnderTest {
  using CallsUnderTest::CallsUnderTest;

  HttpResponse call(const std::string& method, const std::string& path,
                    const std::string& body = {}, Headers headers = {}, Query query = {}) {
    return respond(context, {method, path, std::move(query), std::move(headers), body});
  }
  HttpResponse post(int samples, Headers headers = {}) {
    headers.emplace("content-type", "application/json");
    return call("POST", "/v1/renders", small_request(samples), std::move(headers));
  }
  std::string finished() { return service.wait(service.submit(small_request(4)).id).id; }
};

json body_of(const HttpResponse& response) {
  return json::parse(std::get<std::string>(response.body));
}

std::string problem_of(const HttpResponse& response) {
  EXPECT_EQ(response.content_type, "application/problem+json");
  const json body = body_of(response);
  EXPECT_EQ(body["status"], response.status);
  const std::string type = body["type"];
  return type.substr(type.rfind(':') + 1);
}

TEST(CallsTest, APostIsAcceptedWithItsLocation) {
  FrontUnderTest tested(0);
  const HttpResponse response = tested.post(4);
  EXPECT_EQ(response.status, 202);
  EXPECT_EQ(body_of(response)["state"], "queued");
  const std::string location = header(response, "Location");
  EXPECT_EQ(location, "/v1/renders/" + std::string(body_of(response)["id"]));
  EXPECT_EQ(tested.call("GET", location).status, 200);
}

TEST(CallsTest, APostThatWaitsAnswersWithTheEnd) {
  FrontUnderTest tested;
  const HttpResponse response = tested.post(4, {{"prefer", "wait=20"}});
  EXPECT_EQ(response.status, 200);
  EXPECT_EQ(header(response, "Preference-Applied"), "wait=20");
  EXPECT_EQ(body_of(response)["state"], "succeeded");
}

TEST(CallsTest, APostThatWaitedInVainIsAccepted) {
  FrontUnderTest tested(0);
  EXPECT_EQ(tested.post(4, {{"prefer", "wait=0"}}).status, 202);
}

TEST(CallsTest, WaitingIsNotHonouredWhereTooManyWait) {
  FrontUnderTest tested(0);
  const auto crowd = take_all_but(0, tested.context.waiting);
  const auto start = std::chrono::steady_clock::now();
  const HttpResponse response = tested.post(4, {{"prefer", "wait=20"}});
  EXPECT_EQ(response.status, 202);
  EXPECT_EQ(header(response, "Preference-Applied"), "");
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(10));
  EXPECT_EQ(tested.context.waiting.free(), 0);
}

TEST(CallsTest, AnIdempotentPostIsAnsweredWithTheSameRender) {
  FrontUnderTest tested(0);
  const HttpResponse first = tested.post(4, {{"idempotency-key", "k"}});
  const HttpResponse again = tested.post(4, {{"idempotency-key", "k"}});
  EXPECT_EQ(again.status, first.status);
  EXPECT_EQ(body_of(again), body_of(first));
  EXPECT_EQ(header(again, "Location"), header(first, "Location"));
  EXPECT_EQ(header(again, "Idempotency-Replayed"), "true");
  EXPECT_EQ(header(first, "Idempotency-Replayed"), "");
  const HttpResponse other = tested.post(8, {{"idempotency-key", "k"}});
  EXPECT_EQ(other.status, 422);
  EXPECT_EQ(problem_of(other), "idempotency-mismatch");
  for (const std::string& key : {std::string(), std::string(256, 'k'), std::string("a b")})
    EXPECT_EQ(tested.post(4, {{"idempotency-key", key}}).status, 422) << key;
}

TEST(CallsTest, OnlyJsonIsPosted) {
  FrontUnderTest tested(0);
  for (const char* type :
       {"text/plain", "application/x-www-form-urlencoded", "multipart/form-data"})
    EXPECT_EQ(
        problem_of(tested.call("POST", "/v1/renders", small_request(4), {{"content-type", type}})),
        "unsupported-media-type");
  EXPECT_EQ(tested.call("POST", "/v1/renders", small_request(4)).status, 202);
}

TEST(CallsTest, FaultsOfARequestAreAllNamed) {
  FrontUnderTest tested(0);
  const HttpResponse response = tested.call(
      "POST", "/v1/renders",
      R"({"material":{"cube":{"absorption":2,"roughness":0.3,"scattering":0.5}},"sead":1})");
  EXPECT_EQ(response.status, 422);
  EXPECT_EQ(problem_of(response), "invalid-request");
  EXPECT_EQ(body_of(response)["errors"].size(), 2u);
}

TEST(CallsTest, AStatusIsSentAgainOnlyWhenItChanged) {
  FrontUnderTest tested(0);
  const std::string location = header(tested.post(4), "Location");
  const std::string etag = header(tested.call("GET", location), "ETag");
  EXPECT_THAT(etag, testing::StartsWith("\""));
  const HttpResponse same = tested.call("GET", location, {}, {{"if-none-match", etag}});
  EXPECT_EQ(same.status, 304);
  EXPECT_EQ(header(same, "ETag"), etag);
  EXPECT_TRUE(std::get<std::string>(same.body).empty());
  tested.call("POST", location + "/cancel");
  EXPECT_EQ(tested.call("GET", location, {}, {{"if-none-match", etag}}).status, 200);
}

TEST(CallsTest, ListsArePagedAndFilteredAndRefuseOtherQueries) {
  FrontUnderTest tested(0);
  for (int i = 0; i < 3; ++i) tested.post(4);
  const HttpResponse page = tested.call("GET", "/v1/renders", {}, {}, {{"limit", "2"}});
  EXPECT_EQ(body_of(page)["renders"].size(), 2u);
  const HttpResponse rest = tested.call("GET", "/v1/renders", {}, {},
                                        {{"limit", "2"}, {"cursor", body_of(page)["next_cursor"]}});
  EXPECT_EQ(body_of(rest)["renders"].size(), 1u);
  EXPECT_TRUE(body_of(rest)["next_cursor"].is_null());
  EXPECT_EQ(body_of(tested.call("GET", "/v1/renders", {}, {}, {{"status", "running"}}))["renders"],
            json::array());
  const std::vector<std::pair<std::string, std::string>> bad{
      {"limit", "0"}, {"limit", "201"}, {"limit", "1x"},     {"limit", ""},   {"status", "done"},
      {"state", "x"}, {"", ""},         {"cursor", "1' OR"}, {"cursor", "\n"}};
  for (const auto& query : bad)
    EXPECT_EQ(tested.call("GET", "/v1/renders", {}, {}, {query}).status, 422)
        << query.first << '=' << query.second;
  EXPECT_EQ(tested.call("GET", "/v1/renders", {}, {}, {{"limit", "1"}, {"limit", "1"}}).status,
            422);
}

TEST(CallsTest, AnImageIsNegotiatedTaggedAndServedInParts) {
  FrontUnderTest tested;
  const std::string path = "/v1/renders/" + tested.finished() + "/image";
  const HttpResponse png = tested.call("GET", path);
  EXPECT_EQ(png.status, 200);
  EXPECT_EQ(png.content_type, "image/png");
  EXPECT_EQ(header(png, "Vary"), "Accept");
  EXPECT_EQ(tested.call("GET", path, {}, {{"accept", "image/jpeg"}}).content_type, "image/jpeg");
  EXPECT_EQ(
      tested.call("GET", path, {}, {{"accept", "image/jpeg"}}, {{"format", "exr"}}).content_type,
      "image/x-exr");
  const std::string etag = header(png, "ETag");
  EXPECT_EQ(tested.call("GET", path, {}, {{"if-none-match", "W/" + etag}}).status, 304);

  const auto size = std::get<FileSlice>(png.body).length;
  const HttpResponse part = tested.call("GET", path, {}, {{"range", "bytes=10-19"}});
  EXPECT_EQ(part.status, 206);
  EXPECT_EQ(header(part, "Content-Range"), "bytes 10-19/" + std::to_string(size));
  EXPECT_EQ(std::get<FileSlice>(part.body).length, 10u);
  EXPECT_EQ(tested.call("HEAD", path, {}, {{"range", "bytes=10-19"}}).status, 200);
  const HttpResponse behind = tested.call("GET", path, {}, {{"range", "bytes=9999999-"}});
  EXPECT_EQ(behind.status, 416);
  EXPECT_EQ(header(behind, "Content-Range"), "bytes */" + std::to_string(size));
  EXPECT_EQ(tested.call("GET", path, {}, {{"range", "bytes=0-1"}, {"if-range", "\"old\""}}).status,
            200);
  EXPECT_EQ(tested.call("GET", path, {}, {{"range", "bytes=0-1"}, {"if-range", etag}}).status, 206);
}

TEST(CallsTest, AnImageThatIsNotToBeHadIsAProblem) {
  FrontUnderTest tested(0);
  const std::string location = header(tested.post(4), "Location");
  EXPECT_EQ(problem_of(tested.call("GET", location + "/image")), "not-ready");
  EXPECT_EQ(problem_of(tested.call("GET", location + "/image", {}, {{"accept", "text/html"}})),
            "not-acceptable");
  EXPECT_EQ(problem_of(tested.call("GET", location + "/image", {}, {}, {{"format", "bmp"}})),
            "not-acceptable");
  EXPECT_EQ(problem_of(tested.call("GET", location + "/image", {}, {}, {{"size", "1"}})),
            "invalid-request");
  tested.call("POST", location + "/cancel");
  EXPECT_EQ(problem_of(tested.call("GET", location + "/image")), "conflict");
}

TEST(CallsTest, CancelSaysTheStateAndRemoveLeavesNothing) {
  FrontUnderTest tested(0);
  const std::string location = header(tested.post(4), "Location");
  for (int i = 0; i < 2; ++i) {
    const HttpResponse canceled = tested.call("POST", location + "/cancel");
    EXPECT_EQ(canceled.status, 200);
    EXPECT_EQ(body_of(canceled)["state"], "canceled");
  }
  EXPECT_EQ(tested.call("DELETE", location).status, 204);
  for (const auto& [method, path] :
       std::vector<std::pair<std::string, std::string>>{{"DELETE", location},
                                                        {"GET", location},
                                                        {"GET", location + "/image"},
                                                        {"POST", location + "/cancel"}})
    EXPECT_EQ(problem_of(tested.call(method, path)), "not-found") << method << ' ' << path;
}

TEST(CallsTest, WhatMayBeNamedIsListed) {
  FrontUnderTest tested(0);
  EXPECT_GE(body_of(tested.call("GET", "/v1/absorbers"))["absorbers"].size(), 5u);
  EXPECT_THAT(body_of(tested.call("GET", "/v1/environments")).dump(), HasSubstr("forest"));
  EXPECT_THAT(body_of(tested.call("GET", "/v1/objects")).dump(), HasSubstr("wedge"));
  EXPECT_THAT(body_of(tested.call("GET", "/v1/displays")).dump(), HasSubstr("sRGB"));
}

TEST(CallsTest, ProbesSayAliveAndReady) {
  FrontUnderTest tested(0);
  EXPECT_EQ(tested.call("GET", "/livez").status, 200);
  EXPECT_EQ(tested.call("GET", "/readyz").status, 200);
  tested.service.service.shut_down();
  EXPECT_EQ(tested.call("GET", "/livez").status, 200);
  const HttpResponse unready = tested.call("GET", "/readyz");
  EXPECT_EQ(unready.status, 503);
  EXPECT_THAT(std::string(body_of(unready)["detail"]), HasSubstr("shutting down"));
  EXPECT_EQ(tested.post(4).status, 503);
}

TEST(CallsTest, NotReadyWhereTheDiskRefuses) {
  FrontUnderTest tested(0);
  // The probe cannot be renamed over a folder.
  std::filesystem::create_directories(tested.folder / "artifacts" / "probe" / "x");
  const HttpResponse unready = tested.call("GET", "/readyz");
  EXPECT_EQ(unready.status, 503);
  EXPECT_EQ(std::string(body_of(unready)["detail"]).find(tested.folder.path().string()),
            std::string::npos)
      << "no path of ours is told";
}

TEST(CallsTest, UnknownPathsAndWrongMethodsAreTold) {
  FrontUnderTest tested(0);
  for (const char* path :
       {"", "/web/", "/web/../service.json", "/v1", "/v1/renders/", "/v1/renders/..%2f",
        "/v1/renders/x/y", "/v1/renders/../../etc/passwd", "/v1/rendersx", "/v1/renders/x\n"})
    EXPECT_EQ(problem_of(tested.call("GET", path)), "not-found") << path;
  const HttpResponse wrong = tested.call("PUT", "/v1/renders");
  EXPECT_EQ(problem_of(wrong), "method-not-allowed");
  EXPECT_EQ(header(wrong, "Allow"), "POST, GET, HEAD");
  EXPECT_EQ(header(tested.call("GET", "/v1/renders/x/cancel"), "Allow"), "POST");
  EXPECT_EQ(tested.call("OPTIONS", "/v1/renders").status, 204);
  EXPECT_EQ(tested.call("HEAD", "/livez").status, 200);
}

}  // namespace
}  // namespace translucube::server::test

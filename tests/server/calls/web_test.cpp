// The files of the web explorer as they are served; the page itself is tested in tests/web.

#include <gmock/gmock.h>

#include <regex>
#include <set>

#include "server/calls/web_files.h"
#include "tests/server/calls/calls_under_test.h"

namespace translucube::server::test {
namespace {

using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

std::set<std::string> matches(std::string_view text, const char* pattern) {
  const std::string copy(text);
  const std::regex regex(pattern);
  std::set<std::string> found;
  for (std::sregex_iterator it(copy.begin(), copy.end(), regex), end; it != end; ++it)
    found.insert((*it)[1]);
  return found;
}

TEST(WebTest, ThePageAndItsFilesHaveTheirTypesAndAPolicy) {
  CallsUnderTest tested(0);
  const HttpResponse page = tested.get("/");
  EXPECT_EQ(page.status, 200);
  EXPECT_EQ(page.content_type, "text/html; charset=utf-8");
  EXPECT_THAT(std::get<std::string>(page.body), StartsWith("<!doctype html>"));
  for (const WebFile& file : web_files()) {
    const HttpResponse response = tested.get("/web/" + std::string(file.name));
    EXPECT_EQ(response.status, 200) << file.name;
    EXPECT_NE(response.content_type, "application/octet-stream") << file.name;
    EXPECT_THAT(header(response, "Content-Security-Policy"), StartsWith("default-src 'self'; "));
    EXPECT_THAT(header(response, "Content-Security-Policy"), Not(HasSubstr("unsafe")));
    const std::string etag = header(response, "ETag");
    EXPECT_THAT(etag, StartsWith("\""));
    EXPECT_EQ(tested.get("/web/" + std::string(file.name), {}, {{"if-none-match", etag}}).status,
              304);
  }
  EXPECT_EQ(tested.get("/web/none.js").status, 404);
  EXPECT_EQ(tested.get("/web/").status, 404);
  EXPECT_EQ(respond(tested.context, {"POST", "/", {}, {}, {}}).status, 405);
}

TEST(WebTest, WhatThePageLoadsIsThere) {
  std::set<std::string> named;
  for (const WebFile& file : web_files()) {
    named.merge(matches(file.bytes, R"re((?:href|src)="/web/([^"]+)")re"));
    named.merge(matches(file.bytes, R"re(from '\./([^']+)')re"));
  }
  EXPECT_GE(named.size(), 10u);
  for (const std::string& name : named) EXPECT_NE(find_web_file(name), nullptr) << name;
}

TEST(WebTest, NothingIsInlineOrFromElsewhere) {
  for (const WebFile& file : web_files()) {
    if (file.name.ends_with(".html")) {
      EXPECT_TRUE(matches(file.bytes, R"re((<style|style=| on[a-z]+="|<script>))re").empty());
    }
    for (const std::string& address : matches(file.bytes, R"re((https?://[^\s"'`]+))re"))
      EXPECT_EQ(address, "http://www.w3.org/2000/svg") << file.name;
    EXPECT_TRUE(matches(file.bytes, R"re((eval\(|new Function))re").empty()) << file.name;
  }
}

}  // namespace
}  // namespace translucube::server::test

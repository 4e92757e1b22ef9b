// Heads as RFC 9112 and 9110 have them, as pure bytes.

#include "server/http/request_head.h"

#include <gmock/gmock.h>

#include <cctype>
#include <cstring>

#include "server/http/head_scan.h"

namespace translucube::server::test {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

/// The status that a head is refused with, 200 where it is read, 0 where it is not whole.
int status_of(std::string_view head) {
  HeadScan scan;
  switch (scan.scan(head)) {
    case HeadScan::State::begun:
      return 0;
    case HeadScan::State::faulty:
      return api::kind(scan.fault().code).status;
    case HeadScan::State::whole:
      break;
  }
  EXPECT_EQ(scan.size(), head.size());
  const auto read = read_request_head(head);
  return read ? 200 : api::kind(read.problem().code).status;
}

RequestHead read(const std::string& line, const std::string& fields = "Host: a\r\n") {
  auto head = read_request_head(line + "\r\n" + fields + "\r\n");
  if (head) return *std::move(head);
  ADD_FAILURE() << line << '\n' << fields << head.problem().detail;
  return {};
}

int status_of_line(const std::string& line) { return status_of(line + "\r\nHost: a\r\n\r\n"); }
int status_of_fields(const std::string& fields) {
  return status_of("GET / HTTP/1.1\r\nHost: a\r\n" + fields + "\r\n");
}
int status_of_host(const std::string& fields, const std::string& version = "1.1") {
  return status_of("GET / HTTP/" + version + "\r\n" + fields + "\r\n");
}

TEST(RequestHeadTest, ARequestLineIsMethodTargetAndVersionBetweenSingleSpaces) {
  for (const char* line : {"GET / HTTP/1.1", "GET /a/b?c=d&e HTTP/1.1", "PoST / HTTP/1.1",
                           "!#$%&'*+-.^_`|~09az / HTTP/1.1", "GET / HTTP/1.0", "GET / HTTP/1.9"})
    EXPECT_EQ(status_of_line(line), 200) << line;
  for (const char* line : {"GET",
                           "GET /",
                           "GET  / HTTP/1.1",
                           "GET /  HTTP/1.1",
                           " GET / HTTP/1.1",
                           "GET / HTTP/1.1 ",
                           "GET\t/ HTTP/1.1",
                           "GET /\tHTTP/1.1",
                           "GET / a HTTP/1.1",
                           "G(T / HTTP/1.1",
                           "G:T / HTTP/1.1",
                           "GET / http/1.1",
                           "GET / HTTP/1",
                           "GET / HTTP/1.10",
                           "GET / HTTP/11",
                           "GET / HTTP/01.1",
                           "GET / HTTP 1.1",
                           "GET / HTTP/1,1",
                           "GET / HTTP/a.1",
                           "GET / HTTP/1.b",
                           "GET / HTTPS/1.1",
                           "GET / HTTP/-1.1",
                           "GET HTTP/1.1",
                           "/ HTTP/1.1",
                           "G\xc3\x84T / HTTP/1.1"})
    EXPECT_EQ(status_of_line(line), 400) << line;
  for (const char* line : {"GET / HTTP/2.0", "PRI * HTTP/2.0", "GET / HTTP/0.9", "GET / HTTP/9.9"})
    EXPECT_EQ(status_of_line(line), 505) << line;
}

TEST(RequestHeadTest, ALaterMinorVersionIsReadAs1_1) {
  EXPECT_EQ(read("GET / HTTP/1.0").minor, 0);
  EXPECT_EQ(read("GET / HTTP/1.1").minor, 1);
  EXPECT_EQ(read("GET / HTTP/1.7").minor, 1);
}

TEST(RequestHeadTest, LinesEndInCrLfAndHaveNoControlCharacters) {
  const std::string line = "GET / HTTP/1.1\r\n", host = "Host: a\r\n";
  for (const std::string& head :
       {"GET / HTTP/1.1\n" + host + "\r\n", line + "Host: a\n\r\n", line + host + "\n",
        line + host + "X: a\rb\r\n\r\n", line + host + "X: a\r\r\n\r\n", line + host + "\r\r\n",
        "GET /\r HTTP/1.1\r\n" + host + "\r\n", "GET / HTTP/1.1\r\r\n" + host + "\r\n",
        line + host + "X\r: a\r\n\r\n"})
    EXPECT_EQ(status_of(head), 400) << testing::PrintToString(head);
  for (int c = 0; c < 256; ++c) {
    const std::string byte(1, static_cast<char>(c));
    const bool text = (c >= 0x20 && c != 0x7f) || c == '\t';
    EXPECT_EQ(status_of_fields("X: a" + byte + "b\r\n"), text ? 200 : 400) << c;
    EXPECT_EQ(status_of_fields("X: " + byte + "\r\n"), text ? 200 : 400) << c;
    const bool plain =
        std::isalnum(c) || (c != 0 && c < 127 && std::strchr("-._~!$&'()*+,;=:@/?", c));
    EXPECT_EQ(status_of_line("GET /a" + byte + "b HTTP/1.1"), plain ? 200 : 400) << c;
    EXPECT_EQ(status_of_line("GET /?a" + byte + "b HTTP/1.1"), plain ? 200 : 400) << c;
    const bool token = std::isalnum(c) || (c != 0 && c < 127 && std::strchr("!#$%&'*+-.^_`|~", c));
    EXPECT_EQ(status_of_fields("X" + byte + "Y: a\r\n"), token || c == ':' ? 200 : 400) << c;
    EXPECT_EQ(status_of_line("G" + byte + "T / HTTP/1.1"), token ? 200 : 400) << c;
  }
}

TEST(RequestHeadTest, AFieldLineIsANameAColonAndAValue) {
  const RequestHead head =
      read("GET / HTTP/1.1", "Host:a\r\nX-Many:  \t b \t \r\nx-MANY:c\r\nEmpty:\r\nE2: \t\r\n");
  EXPECT_EQ(head.value("x-many"), "b, c");
  EXPECT_EQ(head.value("empty"), "");
  EXPECT_EQ(head.value("e2"), "");
  EXPECT_EQ(head.value("not-there"), std::nullopt);
  for (const char* fields :
       {"X : a\r\n", "X\t: a\r\n", ": a\r\n", "X\r\n", "X a: b\r\n", " X: a\r\n", "\tX: a\r\n",
        "X: a\r\n b\r\n", "X: a\r\n\tb\r\n", "X:\r\n a\r\n", "X: a\r\n \r\n", "\"X\": a\r\n",
        "X(c): a\r\n", "X\xe4: a\r\n"})
    EXPECT_EQ(status_of_fields(fields), 400) << fields;
  // White space between the request line and the first field (RFC 9112, 2.2).
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\n Host: a\r\n\r\n"), 400);
  EXPECT_EQ(status_of("GET / HTTP/1.1\r\n \r\nHost: a\r\n\r\n"), 400);
}

TEST(RequestHeadTest, WhatIsTooLongIsSaidSo) {
  EXPECT_EQ(status_of_line("GET /" + std::string(8000, 'a') + " HTTP/1.1"), 200);
  EXPECT_EQ(status_of_line("GET /" + std::string(9000, 'a') + " HTTP/1.1"), 414);
  EXPECT_EQ(status_of("GET /" + std::string(9000, 'a')), 414);  // before its end is there
  EXPECT_EQ(status_of_fields("X: " + std::string(8000, 'a') + "\r\n"), 200);
  EXPECT_EQ(status_of_fields("X: " + std::string(9000, 'a') + "\r\n"), 431);
  EXPECT_EQ(status_of_fields(std::string(9000, 'a')), 431);
  std::string many;
  for (int i = 0; i < 9; ++i) many += "X: " + std::string(8000, 'a') + "\r\n";
  EXPECT_EQ(status_of_fields(many), 431);
  std::string short_ones;
  for (int i = 0; i < 99; ++i) short_ones += "a:\r\n";
  EXPECT_EQ(status_of_fields(short_ones), 200);
  EXPECT_EQ(status_of_fields(short_ones + "a:\r\n"), 431);
}

TEST(RequestHeadTest, TheHostIsThereOnceAndIsOne) {
  for (const char* host : {"a", "A.b-c.example", "a:80", "a:", "127.0.0.1:8080", "[::1]",
                           "[::1]:8080", "", ":80", "%41", "a_b"})
    EXPECT_EQ(status_of_host("Host: " + std::string(host) + "\r\n"), 200) << host;
  for (const char* host : {"a b",      "a@b",     "user:secret@b", "a/b",      "a?b",     "a#b",
                           "a:b",      "a:80:80", "::1",           "[::1",     "::1]",    "[]",
                           "a:123456", "a:-1",    "a, b",          "http://a", "a\\b",    "%4",
                           "%",        "a\tb",    "<a>",           "a:8 0",    "\xc3\xa4"})
    EXPECT_EQ(status_of_host("Host: " + std::string(host) + "\r\n"), 400) << host;
  EXPECT_EQ(status_of_host(""), 400);
  EXPECT_EQ(status_of_host("Host: a\r\nHost: a\r\n"), 400);
  EXPECT_EQ(status_of_host("Host: a\r\nhOST:\r\n"), 400);
  EXPECT_EQ(status_of_host("", "1.0"), 200);
  EXPECT_EQ(status_of_host("Host: a b\r\n", "1.0"), 400);
  EXPECT_EQ(status_of_host("Host: a\r\nHost: a\r\n", "1.0"), 400);
}

TEST(RequestHeadTest, TheAuthorityOfTheAbsoluteFormIsTheHost) {
  const RequestHead head = read("GET http://b.example:81/c?d=e HTTP/1.1");
  EXPECT_EQ(head.value("host"), "b.example:81");
  EXPECT_EQ(head.path, "/c");
  EXPECT_THAT(head.query, ElementsAre(Pair("d", "e")));
  EXPECT_EQ(read("GET HTTPS://[::1]/ HTTP/1.1").value("host"), "[::1]");
  EXPECT_EQ(read("GET http://b HTTP/1.1").path, "/");
  const RequestHead bare = read("GET http://b?c=d HTTP/1.1");
  EXPECT_EQ(bare.path, "/");
  EXPECT_THAT(bare.query, ElementsAre(Pair("c", "d")));
  EXPECT_EQ(read("OPTIONS http://b HTTP/1.1").path, "*");
  EXPECT_EQ(read("OPTIONS http://b/ HTTP/1.1").path, "/");
  // The Host field must be there all the same (RFC 9112, 3.2).
  EXPECT_EQ(status_of("GET http://a/ HTTP/1.1\r\n\r\n"), 400);
  for (const char* target :
       {"http://", "http:///a", "http://:80/", "ftp://a/", "http:/a", "http:a", "http//a",
        "http://u@a/", "http://u:p@a/", "http://a:b/", "http://a b/", "http://a/#f", "://a/",
        "http://a\\b/", "javascript:a", "urn:a:b"})
    EXPECT_EQ(status_of_line("GET " + std::string(target) + " HTTP/1.1"), 400) << target;
}

TEST(RequestHeadTest, EachMethodHasItsFormsOfTargets) {
  EXPECT_EQ(read("OPTIONS * HTTP/1.1").path, "*");
  EXPECT_EQ(read("CONNECT a.example:443 HTTP/1.1").value("host"), "a.example:443");
  for (const char* line :
       {"GET * HTTP/1.1", "POST * HTTP/1.1", "OPTIONS ** HTTP/1.1", "OPTIONS *?a HTTP/1.1",
        "GET a.example:443 HTTP/1.1", "GET a HTTP/1.1", "GET a/b HTTP/1.1", "GET ?a HTTP/1.1",
        "CONNECT / HTTP/1.1", "CONNECT a HTTP/1.1", "CONNECT a: HTTP/1.1", "CONNECT :1 HTTP/1.1",
        "CONNECT http://a:1/ HTTP/1.1", "CONNECT u@a:1 HTTP/1.1", "CONNECT * HTTP/1.1"})
    EXPECT_EQ(status_of_line(line), 400) << line;
}

TEST(RequestHeadTest, TargetsAreDecodedOnceAndKeepTheirSegments) {
  EXPECT_EQ(read("GET /a%20b%c3%A4 HTTP/1.1").path, "/a b\xc3\xa4");
  EXPECT_EQ(read("GET /a%2Fb%2fc HTTP/1.1").path, "/a%2Fb%2fc");
  EXPECT_EQ(read("GET /a%00 HTTP/1.1").path, "/a%00");
  EXPECT_EQ(read("GET /%252F HTTP/1.1").path, "/%2F");
  EXPECT_EQ(read("GET /a+b HTTP/1.1").path, "/a+b");
  EXPECT_EQ(read("GET //a/../b HTTP/1.1").path, "//a/../b");
  EXPECT_THAT(
      read("GET /?a=b+c&d=%26%3D&e&=f&&a= HTTP/1.1").query,
      ElementsAre(Pair("a", "b c"), Pair("d", "&="), Pair("e", ""), Pair("", "f"), Pair("a", "")));
  EXPECT_THAT(read("GET /? HTTP/1.1").query, IsEmpty());
  EXPECT_THAT(read("GET /?a?b=/ HTTP/1.1").query, ElementsAre(Pair("a?b", "/")));
  for (const char* target : {"/%", "/%4", "/%zz", "/%4g", "/?%", "/?a=%g0", "/%%30"})
    EXPECT_EQ(status_of_line("GET " + std::string(target) + " HTTP/1.1"), 400) << target;
}

TEST(RequestHeadTest, ALengthIsDigitsOnce) {
  EXPECT_EQ(read("POST / HTTP/1.1", "Host: a\r\nContent-Length: 007\r\n").framing.length, 7u);
  EXPECT_FALSE(read("POST / HTTP/1.1").framing.has_body());
  EXPECT_FALSE(read("POST / HTTP/1.1", "Host: a\r\nContent-Length: 0\r\n").framing.has_body());
  // Too large to be held, and so to be taken.
  for (const char* huge : {"18446744073709551615", "18446744073709551616",
                           "99999999999999999999999999999999999999999999"})
    EXPECT_EQ(read("POST / HTTP/1.1", "Host: a\r\nContent-Length: " + std::string(huge) + "\r\n")
                  .framing.length,
              ~std::uint64_t{0})
        << huge;
  for (const char* length : {"", "+5", "-5", "-0", "0x5", "5a", "a", "5 5", "5,5", "5, 5", "5,",
                             ",5", "5.0", "5e0", "\"5\"", "1_0", "\xd9\xa5", "5;a"})
    EXPECT_EQ(status_of_fields("Content-Length: " + std::string(length) + "\r\n"), 400) << length;
  EXPECT_EQ(status_of_fields("Content-Length: 5\r\nContent-Length: 5\r\n"), 400);
  EXPECT_EQ(status_of_fields("Content-Length: 5\r\ncontent-length: 6\r\n"), 400);
}

TEST(RequestHeadTest, TheLastCodingIsChunkedOnce) {
  for (const char* coding : {"chunked", "Chunked", "CHUNKED", " \tchunked\t "})
    EXPECT_TRUE(
        read("POST / HTTP/1.1", "Host: a\r\nTransfer-Encoding: " + std::string(coding) + "\r\n")
            .framing.chunked)
        << coding;
  for (const char* coding :
       {"", "identity", "gzip", "chunked, gzip", "chunked, identity", "chunked, chunked",
        "chunked,chunked", "chunked;a=b", "\"chunked\"", "chunked chunked", "xchunked", "chunkedx",
        ", chunked", "chunked,", "gzip,, chunked", "chunked\x0b", "gzip;q=\",\", chunked"})
    EXPECT_EQ(status_of_fields("Transfer-Encoding: " + std::string(coding) + "\r\n"), 400)
        << coding;
  for (const char* coding : {"gzip, chunked", "deflate, gzip, chunked", "identity, chunked"})
    EXPECT_EQ(status_of_fields("Transfer-Encoding: " + std::string(coding) + "\r\n"), 501)
        << coding;
  EXPECT_EQ(status_of_fields("Transfer-Encoding: chunked\r\nTransfer-Encoding: chunked\r\n"), 400);
  EXPECT_EQ(status_of_fields("Transfer-Encoding: gzip\r\nTransfer-Encoding: chunked\r\n"), 501);
  EXPECT_EQ(status_of_fields("Transfer-Encoding: chunked\r\nTransfer-Encoding:\r\n"), 400);
  EXPECT_EQ(status_of_fields("Transfer-Encoding: chunked\r\nContent-Length: 5\r\n"), 400);
  EXPECT_EQ(status_of_fields("Content-Length: 0\r\nTransfer-Encoding: chunked\r\n"), 400);
  EXPECT_EQ(status_of("POST / HTTP/1.0\r\nHost: a\r\nTransfer-Encoding: chunked\r\n\r\n"), 400);
}

TEST(RequestHeadTest, ConnectionOptionsHaveNoCaseAndComeInLists) {
  const auto keeps = [](const std::string& version, const std::string& fields) {
    return read("GET / HTTP/" + version, "Host: a\r\n" + fields).keep_alive;
  };
  EXPECT_TRUE(keeps("1.1", ""));
  EXPECT_TRUE(keeps("1.2", ""));
  EXPECT_FALSE(keeps("1.0", ""));
  for (const char* close :
       {"close", "Close", "TE, close", "close,TE", "keep-alive, close", "a,\tCLOSE ,b", ",close"}) {
    EXPECT_FALSE(keeps("1.1", "Connection: " + std::string(close) + "\r\n")) << close;
    EXPECT_FALSE(keeps("1.0", "Connection: " + std::string(close) + "\r\n")) << close;
  }
  EXPECT_FALSE(keeps("1.1", "Connection: TE\r\nConnection: close\r\n"));
  EXPECT_FALSE(keeps("1.0", "Connection: keep-alive\r\nConnection: close\r\n"));
  for (const char* other : {"", "TE", "closed", "keep-alive", ",", "TE,,a"})
    EXPECT_TRUE(keeps("1.1", "Connection: " + std::string(other) + "\r\n")) << other;
  for (const char* none : {"\"close\"", "close;a", "close/", "clo se", "close=1"})
    EXPECT_EQ(status_of_fields("Connection: " + std::string(none) + "\r\n"), 400) << none;
  EXPECT_TRUE(keeps("1.0", "Connection: Keep-Alive\r\n"));
  EXPECT_TRUE(keeps("1.0", "Connection: a, keep-alive\r\n"));
  EXPECT_FALSE(keeps("1.0", "Connection: keep\r\n"));
}

TEST(RequestHeadTest, TheExpectationHasNoCaseAndIsNoneOf1_0) {
  const auto expects = [](const std::string& version, const std::string& value) {
    return read("POST / HTTP/" + version, "Host: a\r\nExpect: " + value + "\r\n");
  };
  for (const char* value : {"100-continue", "100-Continue", "100-CONTINUE", ", 100-continue"}) {
    EXPECT_TRUE(expects("1.1", value).expects_continue) << value;
    EXPECT_FALSE(expects("1.1", value).expects_more) << value;
    EXPECT_FALSE(expects("1.0", value).expects_continue) << value;
  }
  for (const char* value :
       {"200-ok", "100-continue, other", "100-continue;a=b", "\"100-continue\""})
    EXPECT_TRUE(expects("1.1", value).expects_more) << value;
  EXPECT_FALSE(expects("1.0", "other").expects_more);
  EXPECT_FALSE(expects("1.1", "").expects_more);
}

TEST(RequestHeadTest, AHeadIsFoundHoweverItsBytesAreCut) {
  const std::string head = "GET /a HTTP/1.1\r\nHost: a\r\nX: b\r\n\r\n";
  for (std::size_t step = 1; step <= head.size(); ++step) {
    HeadScan scan;
    std::size_t size = 0;
    for (; size + step < head.size(); size += step)
      ASSERT_EQ(scan.scan(std::string_view(head).substr(0, size + step)), HeadScan::State::begun)
          << size << ' ' << step;
    ASSERT_EQ(scan.scan(head + "GET /"), HeadScan::State::whole);
    ASSERT_EQ(scan.size(), head.size());
  }
}

}  // namespace
}  // namespace translucube::server::test

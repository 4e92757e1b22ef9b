#include <gtest/gtest.h>

#include "server/http/message.h"
#include "server/http/negotiation.h"

namespace translucube::server {
namespace {

std::string chosen(std::string_view accept) {
  const auto format = negotiate_image(accept);
  return format ? std::string(name(*format)) : "none";
}

TEST(NegotiationTest, PngIsTheAnswerWhereNothingIsAskedFor) {
  EXPECT_EQ(chosen(""), "png");
  EXPECT_EQ(chosen("*/*"), "png");
  EXPECT_EQ(chosen("image/*"), "png");
  EXPECT_EQ(chosen("text/html,application/xhtml+xml,image/avif,image/webp,*/*;q=0.8"), "png");
}

TEST(NegotiationTest, TheHighestQualityWins) {
  EXPECT_EQ(chosen("image/png;q=0.3, image/tiff;q=0.7, image/jpeg;q=0.5"), "tiff");
  EXPECT_EQ(chosen("image/*;q=0.5, image/jpeg"), "jpeg");
  EXPECT_EQ(chosen("image/x-exr"), "exr");
  EXPECT_EQ(chosen("IMAGE/JPEG ; Q=1.0"), "jpeg");
}

TEST(NegotiationTest, TheMostSpecificRangeDecidesOnAType) {
  EXPECT_EQ(chosen("image/*, image/png;q=0"), "exr");
  EXPECT_EQ(chosen("*/*;q=0.9, image/*;q=0.1, image/tiff;q=0.2"), "tiff");
  EXPECT_EQ(chosen("image/png;q=0, */*"), "exr");
}

TEST(NegotiationTest, WhatIsNotThereIsNotAcceptable) {
  EXPECT_EQ(chosen("text/html"), "none");
  EXPECT_EQ(chosen("image/webp, application/json"), "none");
  EXPECT_EQ(chosen("image/png;q=0"), "none");
  EXPECT_EQ(chosen("image/png;q=nan"), "none");
  EXPECT_EQ(chosen("image/png;q=-1"), "none");
  EXPECT_EQ(chosen(",;,=\"\\"), "none");
}

TEST(NegotiationTest, JsonIsToldByItsTypeAlone) {
  EXPECT_TRUE(is_json("application/json"));
  EXPECT_TRUE(is_json("Application/JSON; charset=utf-8"));
  EXPECT_FALSE(is_json("text/json"));
  EXPECT_FALSE(is_json("application/jsonx"));
  EXPECT_FALSE(is_json("multipart/form-data; boundary=application/json"));
}

TEST(NegotiationTest, EntityTagsMatchWeaklyInLists) {
  EXPECT_TRUE(etag_matches("\"a\"", "\"a\""));
  EXPECT_TRUE(etag_matches("\"b\", W/\"a\"", "\"a\""));
  EXPECT_TRUE(etag_matches("*", "\"a\""));
  EXPECT_FALSE(etag_matches("\"b\"", "\"a\""));
  EXPECT_FALSE(etag_matches("a", "\"a\""));
  EXPECT_FALSE(etag_matches("", "\"a\""));
  // A comma and a backslash are characters of a tag as any other (RFC 9110, 8.8.3).
  EXPECT_TRUE(etag_matches("\"b,\", \"a\"", "\"a\""));
  EXPECT_TRUE(etag_matches("\"b\\\",\"a\"", "\"a\""));
  EXPECT_FALSE(etag_matches("\"b\" \"a\"", "\"a\""));
  EXPECT_FALSE(etag_matches("w/\"a\"", "\"a\""));
}

TEST(NegotiationTest, IfMatchComparesStrongly) {
  EXPECT_TRUE(etag_matches_strongly("\"b\", \"a\"", "\"a\""));
  EXPECT_TRUE(etag_matches_strongly("*", "\"a\""));
  EXPECT_FALSE(etag_matches_strongly("W/\"a\"", "\"a\""));
  EXPECT_FALSE(etag_matches_strongly("W/\"a\"", "W/\"a\""));
  EXPECT_FALSE(etag_matches_strongly("\"b\"", "\"a\""));
  EXPECT_FALSE(etag_matches_strongly("", "\"a\""));
}

TEST(NegotiationTest, WaitIsReadFromPrefer) {
  EXPECT_EQ(preferred_wait("wait=10"), 10);
  EXPECT_EQ(preferred_wait("respond-async, Wait=\"5\""), 5);
  EXPECT_EQ(preferred_wait("wait = 3; x=y"), 3);
  for (const char* text : {"", "respond-async", "wait", "wait=", "wait=-1", "wait=1e3", "wait=2.5",
                           "wait=99999999999999999999", "await=3"})
    EXPECT_FALSE(preferred_wait(text)) << text;
}

std::string range(std::string_view text, std::uint64_t size = 100) {
  const auto result = requested_range(text, size);
  if (std::holds_alternative<WholeBody>(result)) return "whole";
  if (std::holds_alternative<UnsatisfiableRange>(result)) return "none";
  const auto& part = std::get<ByteRange>(result);
  return std::to_string(part.first) + '+' + std::to_string(part.length);
}

TEST(NegotiationTest, RangesAreCutToTheBody) {
  EXPECT_EQ(range("bytes=0-9"), "0+10");
  EXPECT_EQ(range("bytes=90-"), "90+10");
  EXPECT_EQ(range("bytes=90-1000"), "90+10");
  EXPECT_EQ(range("bytes=-10"), "90+10");
  EXPECT_EQ(range("bytes=-1000"), "0+100");
  EXPECT_EQ(range("Bytes= 0 - 0 "), "0+1");
}

TEST(NegotiationTest, RangesBehindTheEndAreUnsatisfiable) {
  EXPECT_EQ(range("bytes=100-"), "none");
  EXPECT_EQ(range("bytes=18446744073709551615-"), "none");
  EXPECT_EQ(range("bytes=-0"), "none");
  EXPECT_EQ(range("bytes=0-", 0), "none");
}

TEST(NegotiationTest, WhatIsNoRangeIsIgnored) {
  for (const char* text : {"", "bytes", "bytes=", "bytes=-", "bytes=a-b", "bytes=9-1", "items=0-1",
                           "bytes=0-1,5-6", "bytes=--1", "bytes=99999999999999999999999-"})
    EXPECT_EQ(range(text), "whole") << text;
}

TEST(NegotiationTest, IdempotencyKeysAreVisibleAsciiOfBoundedLength) {
  EXPECT_TRUE(is_idempotency_key("8e03978e-40d5-43dd-bc93-6894a57f9324"));
  EXPECT_TRUE(is_idempotency_key(std::string(255, 'k')));
  EXPECT_FALSE(is_idempotency_key(std::string(256, 'k')));
  EXPECT_FALSE(is_idempotency_key(""));
  EXPECT_FALSE(is_idempotency_key("a b"));
  EXPECT_FALSE(is_idempotency_key("\xc3\xa9"));
}

TEST(NegotiationTest, LogLinesHoldNoControlCharacters) {
  EXPECT_EQ(printable("/a\nb\x1b[31m"), "/a?b?[31m");
  EXPECT_EQ(printable(std::string(1000, 'a')).size(), 200u);
}

}  // namespace
}  // namespace translucube::server

// Bodies as RFC 9112 has them, as pure bytes, however they are cut.

#include "server/http/body_reader.h"

#include <gmock/gmock.h>

namespace translucube::server::test {
namespace {

constexpr std::uint64_t limit = 1000;
const Framing in_chunks{true, 0};

struct Outcome {
  int status = 0;  ///< 200 where it is whole, 0 where more must come
  std::string body, rest;
  friend bool operator==(const Outcome&, const Outcome&) = default;
};
void PrintTo(const Outcome& outcome, std::ostream* out) {
  *out << outcome.status << " body " << testing::PrintToString(outcome.body) << " rest "
       << testing::PrintToString(outcome.rest);
}

/// The bytes in pieces of so many.
Outcome read(const Framing& framing, std::string_view bytes, std::size_t step) {
  BodyReader reader(framing, limit);
  while (!bytes.empty()) {
    std::string_view piece = bytes.substr(0, step);
    const std::size_t given = piece.size();
    reader.take(piece);
    bytes.remove_prefix(given - piece.size());
    if (reader.whole() || reader.fault()) break;
  }
  if (reader.fault()) return {api::kind(reader.fault()->code).status, "", ""};
  if (!reader.whole()) return {};
  if (reader.too_large()) return {413, "", std::string(bytes)};
  return {200, reader.release(), std::string(bytes)};
}

/// What all ways to cut the bytes come to.
Outcome read(const Framing& framing, std::string_view bytes) {
  const Outcome whole = read(framing, bytes, bytes.size() + 1);
  for (std::size_t step = 1; step <= std::min<std::size_t>(bytes.size(), 20); ++step)
    EXPECT_EQ(read(framing, bytes, step), whole) << testing::PrintToString(bytes) << ' ' << step;
  return whole;
}

TEST(BodyReaderTest, ALengthEndsTheBody) {
  EXPECT_EQ(read({false, 3}, "abcGET"), (Outcome{200, "abc", "GET"}));
  EXPECT_EQ(read({false, 3}, "ab"), Outcome{});
  EXPECT_EQ(read({false, 1001}, std::string(1001, 'a') + "b"), (Outcome{413, "", "b"}));
  EXPECT_TRUE(BodyReader(Framing{}, limit).whole());
}

TEST(BodyReaderTest, ChunksEndWithAnEmptyOne) {
  for (const char* body :
       {"3\r\nabc\r\n0\r\n\r\nG", "1\r\na\r\n2\r\nbc\r\n0\r\n\r\nG", "03\r\nabc\r\n000\r\n\r\nG",
        "0000000000000000000003\r\nabc\r\n0\r\n\r\nG"})
    EXPECT_EQ(read(in_chunks, body), (Outcome{200, "abc", "G"})) << body;
  EXPECT_EQ(read(in_chunks, "0\r\n\r\nG"), (Outcome{200, "", "G"}));
  EXPECT_EQ(read(in_chunks, "a\r\n0123456789\r\nB\r\n0123456789a\r\n0\r\n\r\n").body,
            "01234567890123456789a");
  EXPECT_EQ(read(in_chunks, "2\r\n\r\n\r\n0\r\n\r\n").body, "\r\n");
  EXPECT_EQ(read(in_chunks, "3e9\r\n" + std::string(1001, 'a') + "\r\n0\r\n\r\nG"),
            (Outcome{413, "", "G"}));
  for (const char* body :
       {"", "3", "3\r", "3\r\n", "3\r\nab", "3\r\nabc", "3\r\nabc\r", "3\r\nabc\r\n",
        "3\r\nabc\r\n0", "3\r\nabc\r\n0\r\n", "0\r\n\r", "0\r\nT: x\r\n"})
    EXPECT_EQ(read(in_chunks, body), Outcome{}) << body;
}

TEST(BodyReaderTest, ASizeIsHexDigits) {
  for (const char* size : {"0x2",
                           "+2",
                           "-2",
                           " 2",
                           "\t2",
                           "2_0",
                           "",
                           ";a=b",
                           "g",
                           "2 ",
                           "2\t",
                           "2h",
                           "2.0",
                           "2,0",
                           "\"2\"",
                           "2 2",
                           "\xef\xbc\x92",
                           "10000000000000000",
                           "fffffffffffffffff",
                           "2\v",
                           "2\f"})
    EXPECT_EQ(read(in_chunks, size + std::string("\r\n{}\r\n0\r\n\r\n")).status, 400) << size;
  EXPECT_EQ(read(in_chunks, std::string("2\0\r\n{}\r\n0\r\n\r\n", 14)).status, 400);
  // At once, before the line ends.
  EXPECT_EQ(read(in_chunks, "-").status, 400);
  // Held, but never to come.
  EXPECT_EQ(read(in_chunks, "ffffffffffffffff\r\nab"), Outcome{});
}

TEST(BodyReaderTest, LinesEndInCrLfAndDataWhereItsSizeSays) {
  for (const char* body :
       {"2\n{}\r\n0\r\n\r\n", "2\r\n{}\n0\r\n\r\n", "2\r\n{}\r\n0\n\r\n", "2\r\n{}\r\n0\r\n\n",
        "2\r{}\r\n0\r\n\r\n", "2\r\n{}\r0\r\n\r\n", "2\r\n{}}\r\n0\r\n\r\n", "2\r\n{}0\r\n\r\n",
        "2\r\n{}XX\r\n0\r\n\r\n", "3\r\n{}\r\n0\r\n\r\n", "2\r\n{}\r\n\r\n0\r\n\r\n",
        "2\r\r\n{}\r\n0\r\n\r\n", "2;a\rb\r\n{}\r\n0\r\n\r\n", "2;a\nb\r\n{}\r\n0\r\n\r\n"})
    EXPECT_EQ(read(in_chunks, body).status, 400) << testing::PrintToString(body);
}

TEST(BodyReaderTest, ExtensionsArePassedOverWhereTheyAreOnes) {
  for (const char* extension : {";a", ";a=b", ";a=\"b;c\"", " ; a = b", "\t;\ta\t=\t\"b\"",
                                ";a;b=c;d=\"\"", ";a=\"\\\"\r\"", ";a=\"\\\\\""}) {
    if (std::string_view(extension).find('\r') != std::string_view::npos) continue;
    EXPECT_EQ(read(in_chunks, "2" + std::string(extension) + "\r\n{}\r\n0;z\r\n\r\nG"),
              (Outcome{200, "{}", "G"}))
        << extension;
  }
  for (const char* extension : {";", ";;a", ";=b", ";a=", ";a=\"b", ";a=b c", ";a b", "h", " a",
                                ";a=\"b\"c", ";a=b\"c\"", ";\"a\"=b", ";a==b", ";a=(b)",
                                ";a="
                                "\xc3\xa4",
                                ";a ", ";a=b "})
    EXPECT_EQ(read(in_chunks, "2" + std::string(extension) + "\r\n{}\r\n0\r\n\r\n").status, 400)
        << extension;
  const std::string long_one = ";a=" + std::string(4000, 'b');
  EXPECT_EQ(read(in_chunks, "2" + long_one + "\r\n{}\r\n0\r\n\r\n").status, 200);
  EXPECT_EQ(read(in_chunks, "2" + long_one + long_one + "\r\n{}\r\n0\r\n\r\n").status, 431);
  std::string many;
  for (int i = 0; i < 5; ++i) many += "1" + long_one + "\r\na\r\n";
  EXPECT_EQ(read(in_chunks, many + "0\r\n\r\n").status, 431);
}

TEST(BodyReaderTest, TrailersAreDroppedWhereTheyAreFields) {
  for (const char* trailers : {"T: x\r\n", "A: b\r\nC: d\r\n", "Content-Length: 5\r\n", "T:\r\n"})
    EXPECT_EQ(read(in_chunks, "2\r\n{}\r\n0\r\n" + std::string(trailers) + "\r\nG"),
              (Outcome{200, "{}", "G"}))
        << trailers;
  for (const char* trailers : {"T\r\n", "T : x\r\n", " T: x\r\n", "T: x\r\n y\r\n", ": x\r\n",
                               "T: \x01\r\n", "T: x\n", "T: x\ry\r\n", "X\r\n"})
    EXPECT_EQ(read(in_chunks, "2\r\n{}\r\n0\r\n" + std::string(trailers) + "\r\n").status, 400)
        << trailers;
  EXPECT_EQ(read(in_chunks, "0\r\nT: " + std::string(9000, 'x')).status, 431);
  std::string many = "0\r\n";
  for (int i = 0; i < 3000; ++i) many += "T: x\r\n";
  EXPECT_EQ(read(in_chunks, many, many.size()).status, 431);
}

}  // namespace
}  // namespace translucube::server::test

// RFC 9112 and 9110 over a real socket: bytes in; the statuses of the answers, and whether the
// connection goes on, out. Each row is sent whole, byte by byte and cut in two.

#include <map>

#include "tests/server/http/sockets.h"

namespace translucube::server::test {
namespace {

using testing::Not;

struct Row {
  std::string bytes;
  std::vector<int> statuses;  ///< of the answers, in their order
  bool open = false;          ///< the connection takes another request
};

/// All that comes, up to so many answers with a Content-Length, or to the end of the connection.
class Answers {
 public:
  explicit Answers(Wire& wire) : wire_(wire) {}

  /// The status of the next one, 0 at the end.
  int next() {
    std::size_t head = 0;
    while ((head = text_.find("\r\n\r\n")) == text_.npos)
      if (!more()) return 0;
    const int status = std::stoi(text_.substr(9, 3));
    const std::string name = "Content-Length: ";
    const std::size_t at = text_.find(name);
    const std::size_t length = at < head ? std::stoul(text_.substr(at + name.size(), 20)) : 0;
    while (text_.size() < head + 4 + length)
      if (!more()) return 0;
    last_ = text_.substr(0, head + 4 + length);
    text_.erase(0, last_.size());
    return status;
  }
  const std::string& last() const { return last_; }

 private:
  bool more() {
    const std::string some = wire_.receive_some(5000);
    text_ += some;
    return !some.empty();
  }
  Wire& wire_;
  std::string text_, last_;
};

/// What the row comes to where it is sent in these pieces.
void check(const Sockets& sockets, const Row& row, const std::vector<std::string_view>& pieces) {
  SCOPED_TRACE(testing::PrintToString(row.bytes.substr(0, 300)) + " in " +
               std::to_string(pieces.size()));
  Wire wire(sockets.server.port());
  for (const std::string_view piece : pieces) wire.send(piece);
  if (row.open) wire.send(get);
  Answers answers(wire);
  for (const int status : row.statuses) ASSERT_EQ(answers.next(), status) << answers.last();
  if (row.open)
    ASSERT_EQ(answers.next(), 200) << answers.last();
  else
    ASSERT_EQ(answers.next(), 0) << answers.last();
}

void check(const Sockets& sockets, const std::vector<Row>& rows) {
  for (std::size_t index = 0; index < rows.size(); ++index) {
    const Row& row = rows[index];
    const std::string_view bytes = row.bytes;
    check(sockets, row, {bytes});
    if (bytes.size() > 1000) continue;
    std::vector<std::string_view> single;
    for (std::size_t i = 0; i < bytes.size(); ++i) single.push_back(bytes.substr(i, 1));
    check(sockets, row, single);
    for (std::size_t cut = 1 + index % 7; cut < bytes.size(); cut += 7)
      check(sockets, row, {bytes.substr(0, cut), bytes.substr(cut)});
  }
}

const std::string host = "Host: localhost\r\n";
const std::string hidden = "GET /hidden HTTP/1.1\r\n" + host + "\r\n";
std::string get_with(const std::string& fields) {
  return "GET /small HTTP/1.1\r\n" + host + fields + "\r\n";
}
std::string post_with(const std::string& fields, const std::string& body,
                      const std::string& method = "POST") {
  return method + " /small HTTP/1.1\r\n" + host + fields + "\r\n" + body;
}
std::string chunked(const std::string& body) {
  return post_with("Transfer-Encoding: chunked\r\n", body);
}

TEST(MessagesTest, RequestLines) {
  check(Sockets(), {{get, {200}, true},
                    {get + get + get, {200, 200, 200}, true},
                    {"\r\n" + get, {200}, true},
                    {"\r\n\r\n" + get + "\r\n" + get, {200, 200}, true},
                    {"GET /small HTTP/1.2\r\n" + host + "\r\n", {200}, true},
                    {"GET /small HTTP/1.0\r\n\r\n", {200}},
                    {"GET /small HTTP/1.0\r\nConnection: Keep-Alive\r\n\r\n", {200}, true},
                    {"GET /small HTTP/2.0\r\n" + host + "\r\n", {505}},
                    {"PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n", {505}},
                    {"GET /small http/1.1\r\n" + host + "\r\n", {400}},
                    {"GET /small\r\n\r\n" + hidden, {400}},
                    {"GET  /small HTTP/1.1\r\n" + host + "\r\n", {400}},
                    {"GET /small HTTP/1.1 \r\n" + host + "\r\n", {400}},
                    {"GET /sm all HTTP/1.1\r\n" + host + "\r\n", {400}},
                    {"GET /small#a HTTP/1.1\r\n" + host + "\r\n", {400}},
                    {"GET /sm\tall HTTP/1.1\r\n" + host + "\r\n", {400}},
                    {"\rGET /small HTTP/1.1\r\n" + host + "\r\n", {400}},
                    {"\nGET /small HTTP/1.1\r\n" + host + "\r\n", {400}},
                    {"GET /small HTTP/1.1\n" + host + "\n", {400}},
                    {std::string("GET /sm\0all HTTP/1.1\r\n", 22) + host + "\r\n", {400}},
                    {"\x16\x03\x01\x02", {400}},
                    {"BREW /pot HTTP/1.1\r\n" + host + "\r\n", {501}, true},
                    {"get /small HTTP/1.1\r\n" + host + "\r\n", {501}, true},
                    {"TRACE /small HTTP/1.1\r\n" + host + "\r\n", {501}, true},
                    {"CONNECT localhost:80 HTTP/1.1\r\n" + host + "\r\n", {501}, true},
                    {"CONNECT /small HTTP/1.1\r\n" + host + "\r\n", {400}},
                    {post_with("Content-Length: 2\r\n", "{}", "BREW"), {501}},
                    {"GET /" + std::string(9000, 'a') + " HTTP/1.1\r\n" + host + "\r\n", {414}},
                    {std::string(9000, 'A'), {414}}});
}

TEST(MessagesTest, Fields) {
  check(Sockets(), {{get_with("X-A : b\r\n"), {400}},
                    {get_with("X-A\t: b\r\n"), {400}},
                    {get_with(": b\r\n"), {400}},
                    {get_with("X-A b\r\n"), {400}},
                    {get_with("X-A: b\r\n c\r\n"), {400}},
                    {get_with("X-A:\r\n\tb\r\n"), {400}},
                    {get_with("X-A: a\rb\r\n"), {400}},
                    {get_with("X-A: a\nb\r\n"), {400}},
                    {get_with(std::string("X-A: a\0b\r\n", 10)), {400}},
                    {get_with("X-A: a\x01\r\n"), {400}},
                    {get_with("X-A: a\x7f\r\n"), {400}},
                    {get_with("X-A: \xc3\xa4\t \"b\"\r\n"), {200}, true},
                    {get_with("X-A:b\r\nX-A:\r\n"), {200}, true},
                    {"GET /small HTTP/1.1\r\n " + host + "\r\n", {400}},
                    {get_with("X: " + std::string(9000, 'a') + "\r\n"), {431}}});
}

TEST(MessagesTest, HostsAndTargets) {
  check(Sockets(),
        {{"GET /small HTTP/1.1\r\n\r\n" + hidden, {400}},
         {get_with(host), {400}},
         {get_with("HOST: localhost\r\n"), {400}},
         {"GET /small HTTP/1.1\r\nHost: user@localhost\r\n\r\n", {400}},
         {"GET /small HTTP/1.1\r\nHost: local host\r\n\r\n", {400}},
         {"GET /small HTTP/1.1\r\nHost: localhost:80:80\r\n\r\n", {400}},
         {"GET /small HTTP/1.1\r\nHost: localhost/\r\n\r\n", {400}},
         {"GET /small HTTP/1.1\r\nHost:\r\n\r\n", {421}, true},
         {"GET /small HTTP/1.1\r\nHost: evil.example\r\n\r\n", {421}, true},
         {"GET http://localhost/small HTTP/1.1\r\n" + host + "\r\n", {200}, true},
         // The target's authority counts, whatever the Host field says (RFC 9112, 3.2.2).
         {"GET http://localhost/small HTTP/1.1\r\nHost: evil.example\r\n\r\n", {200}, true},
         {"GET http://evil.example/small HTTP/1.1\r\n" + host + "\r\n", {421}, true},
         {"GET http://localhost/small HTTP/1.1\r\n\r\n", {400}},
         {"GET http://user@localhost/small HTTP/1.1\r\n" + host + "\r\n", {400}},
         {"GET localhost:80 HTTP/1.1\r\n" + host + "\r\n", {400}},
         {"GET * HTTP/1.1\r\n" + host + "\r\n", {400}},
         {"GET small HTTP/1.1\r\n" + host + "\r\n", {400}},
         {"GET /%zz HTTP/1.1\r\n" + host + "\r\n", {400}},
         {"OPTIONS * HTTP/1.1\r\n" + host + "\r\n", {200}, true}});
}

TEST(MessagesTest, AnEmptyOriginIsAnotherOne) {
  check(Sockets(), {{post_with("Origin:\r\n", ""), {403}, true},
                    {post_with("Origin: \r\nOrigin: http://localhost\r\n", ""), {403}, true},
                    {post_with("Origin: http://localhost\r\n", ""), {200}, true}});
}

TEST(MessagesTest, Lengths) {
  const auto post = [](const std::string& length, const std::string& body) {
    return post_with("Content-Length: " + length + "\r\n", body);
  };
  check(Sockets(),
        {{post("2", "{}") + hidden, {200, 200}, true},
         {post("0", ""), {200}, true},
         {post_with("", ""), {200}, true},
         {post("02", "{}"), {200}, true},
         {post("2", "{}"), {200}, true},
         {post("2", "{}") + "\r\n" + hidden, {200, 200}, true},
         {post("+2", "{}"), {400}},
         {post("-2", "{}"), {400}},
         {post("0x2", "{}"), {400}},
         {post("2, 2", "{}"), {400}},
         {post("2 2", "{}"), {400}},
         {post("", "{}"), {400}},
         {post("99999999999999999999999999", "{}"), {413}},
         {post("18446744073709551615", "{}"), {413}},
         {post_with("Content-Length: 2\r\nContent-Length: 2\r\n", "{}"), {400}},
         {post_with("Content-Length: 2\r\nContent-Length: 9\r\n", "{}"), {400}},
         {post_with("Content-Length: 6\r\nTransfer-Encoding: chunked\r\n", "0\r\n\r\nX"), {400}},
         {post_with("Content-Length : 2\r\n", "{}"), {400}},
         {post_with("Content-Length: 2\r\n", "{}", "DELETE") + hidden, {200, 200}, true},
         {post_with("Content-Length: 2\r\n", "{}", "OPTIONS") + hidden, {200, 200}, true},
         {post_with("Content-Length: 2\r\n", "{}", "GET") + hidden, {400}}});
}

TEST(MessagesTest, Codings) {
  const auto post = [](const std::string& coding) {
    return post_with("Transfer-Encoding: " + coding + "\r\n", "2\r\n{}\r\n0\r\n\r\n");
  };
  check(Sockets(),
        {{post("chunked") + hidden, {200, 200}, true},
         {post("Chunked") + hidden, {200, 200}, true},
         {post("gzip, chunked"), {501}},
         {post("chunked, chunked"), {400}},
         {post("chunked, identity"), {400}},
         {post("identity"), {400}},
         {post("gzip"), {400}},
         {post(""), {400}},
         {post("xchunked"), {400}},
         {post("chunked;a"), {400}},
         {post("\vchunked"), {400}},
         {post_with("Transfer-Encoding : chunked\r\n", "0\r\n\r\n"), {400}},
         {post_with("Transfer-Encoding:\r\n chunked\r\n", "0\r\n\r\n"), {400}},
         {post_with("Transfer-Encoding: chunked\r\n", "2\r\n{}\r\n0\r\n\r\n", "DELETE") + hidden,
          {200, 200},
          true},
         {post_with("Transfer-Encoding: chunked\r\n", "0\r\n\r\n", "GET") + hidden, {400}},
         {"POST /small HTTP/1.0\r\nTransfer-Encoding: chunked\r\n\r\n0\r\n\r\n", {400}}});
}

TEST(MessagesTest, Chunks) {
  check(Sockets(),
        {{chunked("2\r\n{}\r\n0\r\n\r\n") + hidden, {200, 200}, true},
         {chunked("1\r\n{\r\n01\r\n}\r\n00\r\n\r\n") + hidden, {200, 200}, true},
         {chunked("2;a=b;c=\"d;e\"\r\n{}\r\n0\r\n\r\n") + hidden, {200, 200}, true},
         {chunked("2 ; a\r\n{}\r\n0\r\n\r\n") + hidden, {200, 200}, true},
         {chunked("2\r\n{}\r\n0\r\nT: x\r\nContent-Length: 9\r\n\r\n") + hidden, {200, 200}, true},
         {chunked("0x2\r\n{}\r\n0\r\n\r\n"), {400}},
         {chunked("-2\r\n"), {400}},
         {chunked("+2\r\n{}\r\n0\r\n\r\n"), {400}},
         {chunked(" 2\r\n{}\r\n0\r\n\r\n"), {400}},
         {chunked("2 \r\n{}\r\n0\r\n\r\n"), {400}},
         {chunked("2_0\r\n{}\r\n0\r\n\r\n"), {400}},
         {chunked("\r\n{}\r\n0\r\n\r\n"), {400}},
         {chunked("10000000000000002\r\n{}\r\n0\r\n\r\n"), {400}},
         {chunked("2;\r\n{}\r\n0\r\n\r\n"), {400}},
         {chunked("2;a=\"b\r\n{}\r\n0\r\n\r\n"), {400}},
         {chunked("2\r\n{}}\r\n0\r\n\r\n"), {400}},
         {chunked("2\r\n{}XX\r\n") + hidden, {400}},
         {chunked("2\n{}\n0\n\n"), {400}},
         {chunked("2\r\n{}\r\n0\r\nT : x\r\n\r\n"), {400}},
         {chunked("2\r\n{}\r\n0\r\nT: a\r\n b\r\n\r\n"), {400}},
         {chunked("0;" + std::string(5000, 'a') + "\r\n\r\n"), {431}},
         {chunked("0\r\nT: " + std::string(9000, 'a') + "\r\n\r\n"), {431}}});
}

TEST(MessagesTest, ConnectionOptions) {
  Sockets sockets;
  sockets.stream.say("", true);
  check(sockets, {{get_with("Connection: close\r\n") + hidden, {200}},
                  {get_with("Connection: Close\r\n"), {200}},
                  {get_with("Connection: TE, close\r\n"), {200}},
                  {get_with("Connection: TE\r\nConnection: CLOSE\r\n"), {200}},
                  {get_with("Connection: keep-alive, close\r\n"), {200}},
                  {get_with("Connection: keep-alive\r\n"), {200}, true},
                  {get_with("Connection: closed\r\n"), {200}, true},
                  {"GET /small HTTP/1.0\r\nConnection: keep-alive, close\r\n\r\n", {200}},
                  {"GET /events HTTP/1.0\r\nConnection: keep-alive\r\n\r\n", {200}}});
}

TEST(MessagesTest, WhatEndsTooSoonIsNoRequest) {
  const Sockets sockets;
  const auto after_half_close = [&](const std::string& bytes) {
    Wire wire(sockets.server.port());
    wire.send(bytes);
    wire.end_sending();
    Answers answers(wire);
    return answers.next();
  };
  EXPECT_EQ(after_half_close(post_with("Content-Length: 5\r\n", "ab")), 400);
  EXPECT_EQ(after_half_close(chunked("5\r\nab")), 400);
  EXPECT_EQ(after_half_close(chunked("2\r\nab\r\n0\r\n")), 400);
  EXPECT_EQ(after_half_close("GET /small HTTP/1.1\r\nHos"), 0);
  EXPECT_EQ(after_half_close(get), 200);
  EXPECT_EQ(sockets.answered, 1);
}

TEST(MessagesTest, OneIsAskedToContinueWhereTheBodyIsWanted) {
  const Sockets sockets({}, {true, {{"ci", sha256("secret")}}, {}, {}});
  const std::string token = "Authorization: Bearer secret\r\n";
  const auto first = [&](const std::string& fields, const std::string& body = {},
                         const std::string& version = "1.1") {
    Wire wire(sockets.server.port());
    wire.send("POST /small HTTP/" + version + "\r\n" + host + fields + "\r\n" + body);
    return wire.receive(1000).substr(9, 3);
  };
  const std::string five = token + "Content-Length: 5\r\n";
  EXPECT_EQ(first(five + "Expect: 100-continue\r\n"), "100");
  EXPECT_EQ(first(five + "Expect: 100-CONTINUE\r\n"), "100");
  EXPECT_EQ(first(token + "Transfer-Encoding: chunked\r\nExpect: 100-continue\r\n"), "100");
  // Before all else is looked at, nothing is asked for.
  EXPECT_EQ(first("Content-Length: 5\r\nExpect: 100-continue\r\n"), "401");
  EXPECT_EQ(first(token + "Content-Length: 9999999\r\nExpect: 100-continue\r\n"), "413");
  EXPECT_EQ(first(five + "Expect: 100-continue\r\n", "hello"), "200");
  EXPECT_EQ(first(token + "Expect: 100-continue\r\n"), "200");
  EXPECT_EQ(first(five + "Expect: something\r\n"), "417");
  EXPECT_EQ(first(five + "Expect: 100-continue, something\r\n"), "417");
  EXPECT_EQ(first(five + "Expect: 100-continue\r\n", "hello", "1.0"), "200");
  Wire old(sockets.server.port());
  old.send("POST /small HTTP/1.0\r\n" + five + "Expect: 100-continue\r\n\r\n");
  EXPECT_EQ(old.receive(300), "");
  old.send("hello");
  EXPECT_THAT(old.receive(), StartsWith("HTTP/1.1 200"));
}

/// The header fields of an answer, but for those that differ from one to the next.
std::map<std::string, std::string> fields_of(const std::string& answer) {
  std::map<std::string, std::string> fields;
  const std::size_t end = answer.find("\r\n\r\n");
  for (std::size_t at = answer.find("\r\n") + 2; at < end;) {
    const std::size_t colon = answer.find(": ", at), line = answer.find("\r\n", at);
    fields[answer.substr(at, colon - at)] = answer.substr(colon + 2, line - colon - 2);
    at = line + 2;
  }
  fields.erase("X-Request-Id");
  fields.erase("Date");
  return fields;
}

TEST(MessagesTest, HeadHasTheFieldsOfGetAndNoContent) {
  Sockets sockets;
  sockets.stream.say("", true);
  {
    Wire wire(sockets.server.port());
    wire.send(post_with("Content-Length: 2\r\n", "{}", "HEAD") + hidden);
    const std::string head = wire.receive_some();
    EXPECT_THAT(head, StartsWith("HTTP/1.1 400"));
    EXPECT_EQ(head.find("\r\n\r\n") + 4, head.size());
    EXPECT_TRUE(wire.closed());
  }
  for (const std::string path : {"/small", "/large", "/events"}) {
    for (const std::string version : {"1.0", "1.1"}) {
      const auto ask = [&](const std::string& method) {
        Wire wire(sockets.server.port());
        wire.send(method + ' ' + path + " HTTP/" + version + "\r\n" + host +
                  "Connection: close\r\n\r\n");
        std::string all;
        for (std::string some; !(some = wire.receive_some()).empty();) all += some;
        return all;
      };
      const std::string head = ask("HEAD");
      EXPECT_EQ(fields_of(head), fields_of(ask("GET"))) << path;
      EXPECT_EQ(head.find("\r\n\r\n") + 4, head.size()) << path;
      EXPECT_EQ(head.find("Content-Length") == head.npos, path == "/events");
    }
  }
}

TEST(MessagesTest, AStreamToHttp1_0HasNoChunksAndEndsTheConnection) {
  Sockets sockets;
  sockets.stream.say("data: 1\n\n", true);
  Wire wire(sockets.server.port());
  wire.send("GET /events HTTP/1.0\r\nConnection: keep-alive\r\n\r\n");
  std::string all;
  for (std::string some; !(some = wire.receive_some()).empty();) all += some;
  EXPECT_THAT(all, testing::EndsWith("\r\n\r\ndata: 1\n\n"));
  EXPECT_THAT(all, Not(HasSubstr("Transfer-Encoding")));
  EXPECT_THAT(all, HasSubstr("Connection: close\r\n"));
}

TEST(MessagesTest, AnswersHaveTheDate) {
  const Sockets sockets;
  Wire wire(sockets.server.port());
  wire.send(get);
  EXPECT_THAT(fields_of(wire.receive()).contains("X-Request-Id"), false);
  wire.send(get);
  EXPECT_THAT(wire.receive(), testing::ContainsRegex(
                                  "Date: (Mon|Tue|Wed|Thu|Fri|Sat|Sun), [0-9][0-9] [A-Z][a-z][a-z] "
                                  "20[0-9][0-9] [0-9][0-9]:[0-9][0-9]:[0-9][0-9] GMT\r\n"));
}

}  // namespace
}  // namespace translucube::server::test

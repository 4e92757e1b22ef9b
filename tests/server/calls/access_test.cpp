// Who is let in, by requests written by hand.

#include "server/calls/access.h"

#include <gmock/gmock.h>

#include "tests/server/process/process.h"
#include "tests/server/temp_folder.h"

namespace translucube::server::test {
namespace {

using testing::HasSubstr;

using Headers = std::map<std::string, std::string>;

HttpRequest request(const std::string& method, const Headers& headers,
                    const std::string& path = "/v1/renders") {
  return {method, path, {}, headers, {}};
}

/// The refusal's status, or 0.
int refused(const AccessPolicy& policy, const HttpRequest& request) {
  const auto result = admit(policy, request);
  return result ? 0 : api::kind(result.problem().code).status;
}

const std::string token = "0123456789abcdef";
AccessPolicy with_tokens() {
  return {false, {{"ci", sha256(token)}, {"other", sha256("x")}}, {}, {}};
}

TEST(AccessTest, OnLoopbackOnlyOwnNamesAreHosts) {
  const AccessPolicy policy{true, {}, {"cube.example", "lab.example:8080"}, {}};
  for (const char* host : {"localhost", "LOCALHOST:1", "127.0.0.1", "127.0.0.1:8080", "[::1]",
                           "[::1]:80", "cube.example", "Cube.Example:99", "lab.example:8080"})
    EXPECT_EQ(refused(policy, request("GET", {{"host", host}})), 0) << host;
  for (const char* host : {"evil.example", "localhost.evil.example", "127.0.0.1.evil.example", "",
                           "localhost, evil.example", "lab.example", "lab.example:81", "::1",
                           "[::1", "localhost:x", "127.0.0.2"})
    EXPECT_EQ(refused(policy, request("GET", {{"host", host}})), 421) << host;
  EXPECT_EQ(refused(policy, request("GET", {})), 421);
}

TEST(AccessTest, ElsewhereHostsAreCheckedWhereTheyAreNamed) {
  AccessPolicy policy = with_tokens();
  const Headers headers{{"host", "evil.example"}, {"authorization", "Bearer " + token}};
  EXPECT_EQ(refused(policy, request("GET", headers)), 0);
  policy.hosts = {"cube.example"};
  EXPECT_EQ(refused(policy, request("GET", headers)), 421);
}

TEST(AccessTest, PagesOfOtherOriginsMayNotPost) {
  const AccessPolicy policy{true, {}, {}, {"https://lab.example"}};
  const auto post = [&](Headers headers, const char* method = "POST") {
    headers.emplace("host", "localhost:8080");
    return refused(policy, request(method, headers));
  };
  EXPECT_EQ(post({}), 0);
  EXPECT_EQ(post({{"origin", "http://localhost:8080"}}), 0);
  EXPECT_EQ(post({{"origin", "https://localhost:8080"}}), 0);
  EXPECT_EQ(post({{"origin", "https://LAB.example"}, {"sec-fetch-site", "cross-site"}}), 0);
  EXPECT_EQ(post({{"sec-fetch-site", "same-origin"}}), 0);
  EXPECT_EQ(post({{"origin", "http://localhost:3000"}}), 403);
  EXPECT_EQ(post({{"origin", "http://evil.example"}}), 403);
  EXPECT_EQ(post({{"origin", "null"}}), 403);
  EXPECT_EQ(post({{"origin", ""}}), 403);
  EXPECT_EQ(post({{"sec-fetch-site", "cross-site"}}), 403);
  EXPECT_EQ(post({{"origin", "http://evil.example"}}, "DELETE"), 403);
  for (const char* method : {"GET", "HEAD", "OPTIONS"})
    EXPECT_EQ(post({{"origin", "http://evil.example"}}, method), 0) << method;
}

TEST(AccessTest, EverythingButTheProbesAndThePageNeedsATokenWhereThereAreSome) {
  const AccessPolicy policy = with_tokens();
  for (const char* path : {"/livez", "/readyz"})
    EXPECT_EQ(refused(policy, request("GET", {{"host", "10.0.0.7:80"}}, path)), 0);
  for (const char* path :
       {"/metrics", "/openapi.json", "/v1/renders", "/livez/", "//", "/web", "//livez"})
    EXPECT_EQ(refused(policy, request("GET", {}, path)), 401) << path;
  for (const char* path : {"/", "/web/app.js"}) {
    EXPECT_EQ(refused(policy, request("GET", {}, path)), 0) << path;
    EXPECT_EQ(refused(policy, request("POST", {}, path)), 401) << path;
    EXPECT_EQ(
        refused({true, policy.tokens, {}, {}}, request("GET", {{"host", "evil.example"}}, path)),
        421);
  }
  const auto with = [&](const std::string& credentials) {
    return refused(policy, request("GET", {{"authorization", credentials}}));
  };
  EXPECT_EQ(with("Bearer " + token), 0);
  EXPECT_EQ(with("bearer  " + token), 0);
  for (const std::string& bad : {std::string("Bearer"), std::string("Bearer "), "Basic " + token,
                                 token, "Bearer " + token + "0", "Bearer " + token.substr(1),
                                 "Bearer " + token + ", Bearer " + token})
    EXPECT_EQ(with(bad), 401) << bad;
}

TEST(AccessTest, TheTokensNameIsTold) {
  const auto result = admit(with_tokens(), request("GET", {{"authorization", "Bearer " + token}}));
  EXPECT_EQ(result->client, "ci");
}

TEST(AccessTest, LoopbackIsWhatOnlyThisMachineReaches) {
  for (const char* host : {"127.0.0.1", "127.1.2.3", "::1", "localhost", "LocalHost"})
    EXPECT_TRUE(is_loopback(host)) << host;
  for (const char* host : {"0.0.0.0", "::", "", "127.evil.example", "192.168.1.1", "localhost.x"})
    EXPECT_FALSE(is_loopback(host)) << host;
}

class TokensTest : public testing::Test {
 protected:
  std::string error(const std::string& text) {
    write_file(file, text);
    try {
      load_tokens(file);
    } catch (const TokensError& failure) {
      return failure.what();
    }
    ADD_FAILURE() << "accepted: " << text;
    return {};
  }
  TempFolder folder;
  std::filesystem::path file = folder / "tokens.json";
};

TEST_F(TokensTest, AMadeTokenOpensAndOthersDoNot) {
  const NewToken made = make_token("ci"), second = make_token("lab");
  EXPECT_EQ(made.token.size(), 64u);
  EXPECT_NE(made.token, second.token);
  EXPECT_THAT(made.entry, testing::Not(HasSubstr(made.token)));
  write_file(file, "{\"tokens\":[" + made.entry + ',' + second.entry + "]}");
  const auto tokens = load_tokens(file);
  EXPECT_EQ(name_of(tokens, made.token), "ci");
  EXPECT_EQ(name_of(tokens, second.token), "lab");
  EXPECT_EQ(name_of(tokens, ""), "");
  EXPECT_EQ(name_of(tokens, made.token + ' '), "");
}

TEST_F(TokensTest, TheHashIsSha256) {  // FIPS 180-4, "abc"
  write_file(file, R"({"tokens":[{"name":"a","sha256":)"
                   R"("BA7816BF8F01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad"}]})");
  EXPECT_EQ(name_of(load_tokens(file), "abc"), "a");
}

TEST_F(TokensTest, AFileThatIsNotUsableIsRefusedAndSaysWhere) {
  const std::string hash(64, 'a');
  const std::string entry = R"({"name":"ci","sha256":")" + hash + R"("})";
  EXPECT_THAT(error("{"), HasSubstr("not JSON"));
  EXPECT_THAT(error("{}"), HasSubstr("/tokens: is required"));
  EXPECT_THAT(error(R"({"tokens":[]})"), HasSubstr("/tokens: is empty"));
  EXPECT_THAT(error(R"({"tokens":7})"), HasSubstr("/tokens: must be an array"));
  EXPECT_THAT(error(R"({"tokens":[7]})"), HasSubstr("/tokens/0"));
  EXPECT_THAT(error(R"({"tokens":[{"name":"ci","sha256":"00"}]})"),
              HasSubstr("/tokens/0/sha256: must be 64"));
  EXPECT_THAT(error(R"({"tokens":[{"name":"c i","sha256":")" + hash + R"("}]})"),
              HasSubstr("/tokens/0/name"));
  EXPECT_THAT(error(R"({"tokens":[)" + entry + "," + entry + "]}"),
              HasSubstr("/tokens/1/name: is there already"));
  EXPECT_THAT(error(R"({"tokens":[)" + entry + R"(],"x":1})"), HasSubstr("/x"));
  EXPECT_THROW(load_tokens(folder / "none.json"), TokensError);
  EXPECT_THROW(load_tokens(folder.path()), TokensError);
}

TEST_F(TokensTest, ListeningElsewhereNeedsThem) {
  ServerConfig config;
  EXPECT_TRUE(access_policy(config).loopback);
  config.host = "0.0.0.0";
  EXPECT_THROW(access_policy(config), TokensError);
  config.tokens_file = file;
  EXPECT_THROW(access_policy(config), TokensError);
  write_file(file, "{\"tokens\":[" + make_token("ci").entry + "]}");
  EXPECT_FALSE(access_policy(config).loopback);
  config.host = "127.0.0.1";
  EXPECT_EQ(access_policy(config).tokens.size(), 1u);
}

TEST(AccessProcessTest, TheServiceDoesNotListenElsewhereWithoutTokens) {
  const TempFolder folder;
  const Ran ran =
      run_translucube({"serve", "--host", "0.0.0.0", "--port", "0", "--data", folder.path()});
  EXPECT_EQ(ran.status, 1);
  EXPECT_THAT(ran.errors, HasSubstr("server.tokens_file"));
}

TEST(AccessProcessTest, TheTokenVerbPrintsATokenAndItsEntry) {
  const Ran ran = run_translucube({"token", "--name", "ci"});
  EXPECT_EQ(ran.status, 0);
  EXPECT_THAT(ran.output, HasSubstr(R"({"name":"ci","sha256":")"));
  EXPECT_EQ(run_translucube({"token", "--name", "c\ni"}).status, 2);
}

}  // namespace
}  // namespace translucube::server::test

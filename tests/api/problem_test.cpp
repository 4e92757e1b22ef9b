#include "api/base/problem.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "api/base/faults.h"

namespace translucube::api {
namespace {

using nlohmann::json;

constexpr std::array all_codes{ProblemCode::malformed_http,
                               ProblemCode::malformed_json,
                               ProblemCode::invalid_request,
                               ProblemCode::idempotency_mismatch,
                               ProblemCode::unauthorized,
                               ProblemCode::forbidden,
                               ProblemCode::not_found,
                               ProblemCode::gone,
                               ProblemCode::method_not_allowed,
                               ProblemCode::not_acceptable,
                               ProblemCode::request_timeout,
                               ProblemCode::conflict,
                               ProblemCode::not_ready,
                               ProblemCode::payload_too_large,
                               ProblemCode::uri_too_long,
                               ProblemCode::unsupported_media_type,
                               ProblemCode::range_not_satisfiable,
                               ProblemCode::misdirected,
                               ProblemCode::queue_full,
                               ProblemCode::headers_too_large,
                               ProblemCode::overloaded,
                               ProblemCode::storage_failure,
                               ProblemCode::internal};

TEST(Problem, CodesHaveTheirOwnStableType) {
  std::set<std::string> types;
  for (const ProblemCode code : all_codes) {
    EXPECT_TRUE(std::string(kind(code).type).starts_with("urn:translucube:problem:"));
    types.insert(kind(code).type);
  }
  EXPECT_EQ(types.size(), all_codes.size());
}

TEST(Problem, CodesHaveTheStatusOfTheContract) {
  EXPECT_EQ(kind(ProblemCode::malformed_http).status, 400);
  EXPECT_EQ(kind(ProblemCode::malformed_json).status, 400);
  EXPECT_EQ(kind(ProblemCode::unauthorized).status, 401);
  EXPECT_EQ(kind(ProblemCode::forbidden).status, 403);
  EXPECT_EQ(kind(ProblemCode::not_found).status, 404);
  EXPECT_EQ(kind(ProblemCode::gone).status, 410);
  EXPECT_EQ(kind(ProblemCode::method_not_allowed).status, 405);
  EXPECT_EQ(kind(ProblemCode::not_acceptable).status, 406);
  EXPECT_EQ(kind(ProblemCode::request_timeout).status, 408);
  EXPECT_EQ(kind(ProblemCode::conflict).status, 409);
  EXPECT_EQ(kind(ProblemCode::not_ready).status, 409);
  EXPECT_EQ(kind(ProblemCode::payload_too_large).status, 413);
  EXPECT_EQ(kind(ProblemCode::uri_too_long).status, 414);
  EXPECT_EQ(kind(ProblemCode::unsupported_media_type).status, 415);
  EXPECT_EQ(kind(ProblemCode::range_not_satisfiable).status, 416);
  EXPECT_EQ(kind(ProblemCode::invalid_request).status, 422);
  EXPECT_EQ(kind(ProblemCode::idempotency_mismatch).status, 422);
  EXPECT_EQ(kind(ProblemCode::internal).status, 500);
  EXPECT_EQ(kind(ProblemCode::misdirected).status, 421);
  EXPECT_EQ(kind(ProblemCode::queue_full).status, 429);
  EXPECT_EQ(kind(ProblemCode::headers_too_large).status, 431);
  EXPECT_EQ(kind(ProblemCode::overloaded).status, 503);
  EXPECT_EQ(kind(ProblemCode::storage_failure).status, 507);
}

TEST(Problem, JsonHasTheMembersOfRfc9457) {
  const Problem problem{ProblemCode::invalid_request, "one fault found", {{"/seed", "is odd"}}};
  EXPECT_EQ(json::parse(to_json(problem)),
            json::parse(R"({"type":"urn:translucube:problem:invalid-request",
                            "title":"The request is not valid","status":422,
                            "detail":"one fault found",
                            "errors":[{"pointer":"/seed","detail":"is odd"}]})"));
}

TEST(Problem, JsonHasNoErrorsWhereThereAreNone) {
  EXPECT_FALSE(json::parse(to_json({ProblemCode::not_found, "no render", {}})).contains("errors"));
}

TEST(Problem, JsonStaysJsonWhateverBytesADetailHas) {
  EXPECT_TRUE(json::accept(to_json({ProblemCode::internal, "file \xff\xfe", {}})));
}

TEST(Problem, TextHasALineForEachFault) {
  const Problem problem{
      ProblemCode::invalid_request, "2 faults found", {{"/seed", "is odd"}, {"", "is empty"}}};
  EXPECT_EQ(to_text(problem),
            "The request is not valid: 2 faults found\n"
            "  /seed: is odd\n"
            "  (document): is empty\n");
}

TEST(Problem, TextCannotDriveATerminal) {
  const std::string text =
      to_text({ProblemCode::invalid_request, "", {{"/\x1b[2J\x07\x7f\n\u009b\u00a7", "unknown"}}});
  EXPECT_EQ(text, "The request is not valid\n  /?[2J????\u00a7: unknown\n");
}

TEST(Faults, AreCountedPastTheMostThatAreKept) {
  Faults faults;
  for (int i = 0; i < 250; ++i) faults.add("/" + std::to_string(i), "wrong");
  const auto list = faults.list();
  ASSERT_EQ(list.size(), 101u);
  EXPECT_EQ(list[99].pointer, "/99");
  EXPECT_EQ(list[100], (Fault{"", "and 150 more faults"}));
  EXPECT_EQ(invalid_request(faults).detail, "250 faults found");
}

TEST(PointerToken, EscapesAsRfc6901) {
  EXPECT_EQ(pointer_token("a/b"), "a~1b");
  EXPECT_EQ(pointer_token("m~n"), "m~0n");
  EXPECT_EQ(pointer_token("~1"), "~01");
  EXPECT_EQ(pointer_token(""), "");
}

TEST(PointerToken, CutsLongKeysBetweenCharacters) {
  EXPECT_EQ(pointer_token(std::string(64, 'k')), std::string(64, 'k'));
  EXPECT_EQ(pointer_token(std::string(65, 'k')), std::string(64, 'k') + "...");
  // 63 letters and a euro sign of three bytes, which does not fit.
  EXPECT_EQ(pointer_token(std::string(63, 'k') + "\xe2\x82\xac!"), std::string(63, 'k') + "...");
}

}  // namespace
}  // namespace translucube::api

// The check of schemas that the contract rests on: each keyword refuses what it should.

#include "tests/support/json_schema.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace translucube::test {
namespace {

using nlohmann::json;
using testing::ElementsAre;
using testing::IsEmpty;

struct Case {
  const char *schema, *fits, *does_not;
};

TEST(JsonSchemaTest, EachKeywordHoldsAndRefuses) {
  const std::vector<Case> cases{
      {R"({"type": "integer"})", "1", "1.5"},
      {R"({"type": "number"})", "1.5", "\"1\""},
      {R"({"type": ["string", "null"]})", "null", "true"},
      {R"({"type": "object"})", "{}", "[]"},
      {R"({"type": "array"})", "[]", "{}"},
      {R"({"type": "boolean"})", "false", "0"},
      {R"({"const": "a"})", "\"a\"", "\"b\""},
      {R"({"enum": ["a", "b"]})", "\"b\"", "\"c\""},
      {R"({"minimum": 0})", "0", "-0.1"},
      {R"({"maximum": 1})", "1", "1.1"},
      {R"({"exclusiveMinimum": 0})", "0.1", "0"},
      {R"({"exclusiveMaximum": 1})", "0.9", "1"},
      {R"({"minLength": 1})", "\"a\"", "\"\""},
      {R"({"maxLength": 1})", "\"a\"", "\"ab\""},
      {R"({"pattern": "^a+$"})", "\"aa\"", "\"ab\""},
      {R"({"format": "date-time"})", "\"2026-01-31T12:00:00.000Z\"", "\"yesterday\""},
      {R"({"minItems": 1})", "[1]", "[]"},
      {R"({"maxItems": 1})", "[1]", "[1, 2]"},
      {R"({"uniqueItems": true})", "[1, 2]", "[1, 1]"},
      {R"({"items": {"type": "null"}})", "[null]", "[null, 1]"},
      {R"({"required": ["a"]})", R"({"a": 1})", "{}"},
      {R"({"properties": {"a": {"const": 1}}})", R"({"a": 1, "b": 2})", R"({"a": 2})"},
      {R"({"properties": {"a": {}}, "additionalProperties": false})", R"({"a": 1})", R"({"b": 1})"},
      {R"({"oneOf": [{"minimum": 0}, {"maximum": 1}]})", "2", "0.5"},
      {R"({"anyOf": [{"minimum": 1}, {"maximum": 0}]})", "2", "0.5"},
      {R"({"not": {"const": 1}})", "2", "1"},
      {R"({"$ref": "#/one"})", "1", "2"},
  };
  const json document{{"one", {{"const", 1}}}};
  for (const auto& [schema, fits, does_not] : cases) {
    EXPECT_THAT(schema_faults(document, json::parse(schema), json::parse(fits)), IsEmpty())
        << schema;
    EXPECT_EQ(schema_faults(document, json::parse(schema), json::parse(does_not)).size(), 1u)
        << schema;
    EXPECT_THAT(unknown_keywords(json::parse(schema)), IsEmpty()) << schema;
  }
}

TEST(JsonSchemaTest, FaultsSayWhere) {
  const json schema = json::parse(R"({"properties": {"a": {"items": {"type": "null"}}}})");
  EXPECT_THAT(schema_faults({}, schema, json::parse(R"({"a": [null, 1]})")),
              ElementsAre(R"(/a/1: against type "null")"));
}

TEST(JsonSchemaTest, WhatItPassesOverIsTold) {
  EXPECT_THAT(
      unknown_keywords(json::parse(
          R"({"oneOf": [{"properties": {"a": {"multipleOf": 2}}}], "format": "email",
                      "items": {"additionalProperties": {}}})")),
      testing::UnorderedElementsAre("multipleOf", "format \"email\"", "additionalProperties"));
}

}  // namespace
}  // namespace translucube::test

// The OpenAPI document by itself: routes, examples, keywords, strictness.

#include <functional>

#include "server/calls/router.h"
#include "tests/server/calls/contract.h"

namespace translucube::server::test {
namespace {

TEST(ContractDocumentTest, EveryRouteAndQueryIsDescribedAndTheOtherWayRound) {
  using Queries = std::map<std::string, std::set<std::string>>;
  const Contract contract;
  Queries served{{"GET /metrics", {}}};  // in front.cpp
  for (const Call& call : calls())
    served[std::string(call.method) + ' ' + std::string(call.pattern)] = {call.query.begin(),
                                                                          call.query.end()};
  Queries described;
  for (const Operation& operation : contract.operations()) {
    auto& query = described[operation.method + ' ' + operation.pattern];
    for (const json& reference : operation.description.value("parameters", json::array()))
      if (const json& parameter = contract.resolved(reference); parameter["in"] == "query")
        query.insert(parameter["name"]);
  }
  EXPECT_EQ(served, described);
}

/// Calls `at` with every object in the value that has this key.
void visit(const json& value, const std::string& key, const std::function<void(const json&)>& at) {
  if (value.is_object() && value.contains(key)) at(value);
  if (value.is_structured())
    for (const json& item : value) visit(item, key, at);
}

TEST(ContractDocumentTest, EveryAnswerWithABodyHasExamplesThatFitItsSchema) {
  const Contract contract;
  visit(contract.document["paths"], "responses", [&](const json& operation) {
    for (const auto& [status, reference] : operation["responses"].items()) {
      const json contents = contract.resolved(reference).value("content", json::object());
      for (const auto& [type, content] : contents.items()) {
        if (type != "application/json" && type != "application/problem+json") continue;
        const bool own_document = operation["operationId"] == "getOpenapi" && status == "200";
        EXPECT_EQ(content.contains("examples"), !own_document)
            << operation["operationId"] << ' ' << status;
        for (const json& example : content.value("examples", json::object()))
          contract.expect_fits(content["schema"], example["value"]);
      }
    }
  });
}

TEST(ContractDocumentTest, TheDocumentsKeywordsAreThoseThatTheCheckKnows) {
  const Contract contract;
  for (const auto& [name, schema] : contract.document["components"]["schemas"].items())
    EXPECT_THAT(translucube::test::unknown_keywords(schema), testing::IsEmpty()) << name;
  visit(contract.document, "schema", [](const json& holder) {
    EXPECT_THAT(translucube::test::unknown_keywords(holder["schema"]), testing::IsEmpty());
  });
}

TEST(ContractDocumentTest, EveryObjectIsStrict) {
  const Contract contract;
  visit(contract.document["components"]["schemas"], "properties", [](const json& schema) {
    EXPECT_FALSE(schema.value("additionalProperties", true)) << schema;
  });
}

}  // namespace
}  // namespace translucube::server::test

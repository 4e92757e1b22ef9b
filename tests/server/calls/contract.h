#pragma once

// The OpenAPI document held against the service: each answer that goes through here must be one
// that the document describes.

#include <gmock/gmock.h>
#include <httplib.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "api/openapi.h"
#include "tests/server/fixture.h"
#include "tests/support/json_schema.h"

namespace translucube::server::test {

using nlohmann::json;

inline std::string upper_case(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

struct Operation {
  std::string id, method, pattern;  ///< "getRender", "GET", "/v1/renders/{id}"
  json description;

  bool has(int status) const { return description["responses"].contains(std::to_string(status)); }
  bool changes_something() const { return method != "GET"; }
  /// The first example of its request body, "" where it takes none.
  std::string body() const {
    if (!description.contains("requestBody")) return {};
    const json& content = description["requestBody"]["content"];
    if (!content.contains("application/json")) return "a file";
    return content["application/json"]["examples"].begin()->at("value").dump();
  }
};

struct Answer {
  int status = 0;  ///< 0: none
  std::multimap<std::string, std::string> headers;
  std::string body;

  std::string header(const std::string& name) const {
    const auto it = headers.find(name);
    return it == headers.end() ? std::string() : it->second;
  }
  json value() const { return json::parse(body, nullptr, false); }
};

class Contract {
 public:
  const json document = json::parse(api::openapi_document());
  std::set<std::string> provoked;  ///< "getRender 404"

  std::vector<Operation> operations() const {
    std::vector<Operation> all;
    for (const auto& [pattern, item] : document["paths"].items())
      for (const auto& [method, description] : item.items()) {
        if (method == "parameters") continue;
        all.push_back({description["operationId"], upper_case(method), pattern, description});
      }
    return all;
  }

  /// Where a reference leads, or the value itself.
  const json& resolved(const json& value) const {
    return value.contains("$ref")
               ? document.at(json::json_pointer(value["$ref"].get<std::string>().substr(1)))
               : value;
  }

  /// Notes the answer as provoked, and says where it is not as described.
  void check(const Operation& operation, const Answer& answer) {
    const std::string name = operation.id + ' ' + std::to_string(answer.status);
    SCOPED_TRACE(name);
    if (!operation.has(answer.status)) {
      ADD_FAILURE() << "the document has no such answer: " << answer.body;
      return;
    }
    provoked.insert(name);
    EXPECT_NE(answer.header("X-Request-Id"), "");
    const json& described =
        resolved(operation.description["responses"][std::to_string(answer.status)]);
    check_headers(described, answer);
    check_body(described, answer);
  }

  void check_problem(const Answer& answer) const {
    EXPECT_EQ(answer.header("Content-Type"), "application/problem+json");
    expect_fits({{"$ref", "#/components/schemas/Problem"}}, answer.value());
    EXPECT_EQ(answer.value().value("status", 0), answer.status);
  }

  void expect_fits(const json& schema, const json& value) const {
    EXPECT_THAT(translucube::test::schema_faults(document, schema, value), testing::IsEmpty())
        << value;
  }

 private:
  void check_headers(const json& described, const Answer& answer) const {
    const json headers = described.value("headers", json::object());
    for (const auto& [name, reference] : headers.items()) {
      const json& header = resolved(reference);
      const std::string text = answer.header(name);
      if (answer.headers.find(name) == answer.headers.end())
        EXPECT_FALSE(header.value("required", false)) << "no " << name;
      else
        expect_fits(header["schema"], header["schema"].value("type", json()) == "integer"
                                          ? json::parse(text, nullptr, false)
                                          : json(text));
    }
  }

  void check_body(const json& described, const Answer& answer) const {
    if (!described.contains("content")) {
      EXPECT_EQ(answer.body, "");
      return;
    }
    const std::string type = answer.header("Content-Type");
    if (!described["content"].contains(type)) {
      ADD_FAILURE() << "no such content: " << type;
      return;
    }
    const json& content = described["content"][type];
    if (type == "application/problem+json")
      check_problem(answer);
    else if (type == "text/event-stream")
      check_events(content["x-events"], answer.body);
    else
      expect_fits(content["schema"],
                  type == "application/json" ? answer.value() : json(answer.body));
  }

  /// Each event, of lines `id: `, `event: ` and `data: `, has the schema of its type.
  void check_events(const json& schemas, const std::string& stream) const {
    std::istringstream lines(stream);
    int events = 0;
    for (std::string line, type; std::getline(lines, line);) {
      if (line.starts_with("event: ")) type = line.substr(7);
      if (!line.starts_with("data: ")) continue;
      ++events;
      if (schemas.contains(type))
        expect_fits(schemas[type], json::parse(line.substr(6), nullptr, false));
      else
        ADD_FAILURE() << "no such event: " << type;
    }
    EXPECT_GT(events, 0);
  }
};

}  // namespace translucube::server::test

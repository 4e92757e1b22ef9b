#include "api/openapi.h"

#include <functional>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "api/answer/listings.h"
#include "api/answer/material_report.h"
#include "api/answer/render_status.h"
#include "api/request/canonical.h"
#include "api/request/sweep.h"
#include "picture/image_format.h"
#include "tests/api/fixture.h"

namespace translucube::api {
namespace {

using nlohmann::json;

const json& document() {
  static const json parsed = json::parse(openapi_document());
  return parsed;
}
const json& schema(const std::string& name) { return document()["components"]["schemas"][name]; }

std::set<std::string> keys(const json& object) {
  std::set<std::string> all;
  for (const auto& [key, value] : object.items()) all.insert(key);
  return all;
}
std::set<std::string> properties(const json& schema) { return keys(schema["properties"]); }

void visit_references(const json& value, const std::function<void(const std::string&)>& visit) {
  if (value.is_object() && value.contains("$ref")) visit(value["$ref"]);
  if (value.is_structured())
    for (const auto& item : value) visit_references(item, visit);
}

TEST(OpenApi, DescribesEveryCallOfTheService) {
  EXPECT_EQ(document()["openapi"], "3.1.0");
  std::set<std::string> calls;
  for (const auto& [path, item] : document()["paths"].items())
    for (const auto& [method, operation] : item.items())
      if (method != "parameters") calls.insert(method + ' ' + path);
  EXPECT_EQ(calls, (std::set<std::string>{"get /",
                                          "get /web/{file}",
                                          "post /v1/renders",
                                          "get /v1/renders",
                                          "get /v1/renders/{id}",
                                          "delete /v1/renders/{id}",
                                          "get /v1/renders/{id}/image",
                                          "get /v1/renders/{id}/events",
                                          "post /v1/renders/{id}/cancel",
                                          "post /v1/sweeps",
                                          "get /v1/sweeps",
                                          "get /v1/sweeps/{id}",
                                          "delete /v1/sweeps/{id}",
                                          "get /v1/sweeps/{id}/points/{point}/image",
                                          "get /v1/sweeps/{id}/sheet",
                                          "get /v1/sweeps/{id}/events",
                                          "post /v1/sweeps/{id}/cancel",
                                          "get /v1/absorbers",
                                          "get /v1/environments",
                                          "put /v1/environments/{sha256}",
                                          "get /v1/meshes",
                                          "put /v1/meshes/{sha256}",
                                          "get /v1/objects",
                                          "get /v1/displays",
                                          "get /livez",
                                          "get /readyz",
                                          "get /metrics",
                                          "get /openapi.json"}));
}

TEST(OpenApi, ReferencesLeadSomewhere) {
  visit_references(document(), [](const std::string& reference) {
    ASSERT_TRUE(reference.starts_with("#/"));
    EXPECT_TRUE(document().contains(json::json_pointer(reference.substr(1)))) << reference;
  });
}

TEST(OpenApi, RequestHasTheKeysThatTheParserKnows) {
  // The parser lists what it knows where it is asked for what it does not.
  const auto known_by = [](const auto& result) {
    std::string detail = result.problem().faults.at(0).detail;
    const std::string prefix = "unknown key; known here: ";
    EXPECT_TRUE(detail.starts_with(prefix)) << detail;
    std::set<std::string> names;
    std::istringstream words(detail.substr(prefix.size()));
    for (std::string word; words >> word;)
      names.insert(word.back() == ',' ? word.substr(0, word.size() - 1) : word);
    return names;
  };
  const auto known = [&](const std::string& text) {
    return known_by(parse_render_request(text, shipped_catalog()));
  };
  EXPECT_EQ(properties(schema("RenderRequest")), known(request_with(R"("?":0)")));
  EXPECT_EQ(properties(schema("Material")), known(material_with(R"("?":0)")));
  EXPECT_EQ(properties(schema("CubePoint")),
            known(R"({"material":{"cube":{"absorption":0,"roughness":0,"scattering":0,"?":0}}})"));
  EXPECT_EQ(
      properties(schema("Coefficients")),
      known(R"({"material":{"coefficients":{"sigma_a_peak":0,"alpha":0,"sigma_s":0,"?":0}}})"));
  EXPECT_EQ(properties(schema("Scene")), known(request_with(R"("scene":{"?":0})")));
  EXPECT_EQ(properties(schema("Object")["oneOf"][0]),
            known(request_with(R"("scene":{"object":{"?":0}})")));
  for (const json& object : schema("Object")["oneOf"]) {
    const std::string type = object["properties"]["type"]["const"];
    if (type == "mesh") continue;  // it would look for its file
    EXPECT_EQ(properties(object),
              known(request_with(R"("scene":{"object":{"type":")" + type + R"(","?":0}})")));
  }
  EXPECT_EQ(properties(schema("Backdrop")["oneOf"][1]),
            known(request_with(R"("scene":{"backdrop":{"?":0}})")));
  EXPECT_EQ(properties(schema("Material")["properties"]["oil_film"]["oneOf"][1]),
            known(material_with(R"("oil_film":{"?":0})")));
  EXPECT_EQ(properties(schema("Environment")),
            known(request_with(R"("scene":{"environment":{"?":0}})")));
  EXPECT_EQ(properties(schema("Camera")), known(request_with(R"("scene":{"camera":{"?":0}})")));
  EXPECT_EQ(properties(schema("ImageSize")), known(request_with(R"("image":{"?":0})")));
  EXPECT_EQ(properties(schema("Quality")), known(request_with(R"("quality":{"samples":1,"?":0})")));
  const auto known_of_sweep = [&](const std::string& members) {
    return known_by(parse_sweep_request(
        R"({"base":{"material":{"cube":)" + some_cube + "}}," + members + "}", shipped_catalog()));
  };
  EXPECT_EQ(properties(schema("SweepRequest")), known_of_sweep(R"("?":0)"));
  EXPECT_EQ(properties(schema("SweepRequest")["properties"]["axes"]),
            known_of_sweep(R"("axes":{"?":0})"));
  EXPECT_EQ(properties(schema("Axis")["oneOf"][1]),
            known_of_sweep(R"("axes":{"roughness":{"from":0,"to":1,"count":2,"?":0}})"));
}

void expect_defaults(const json& schema_of_value, const json& value, const std::string& where) {
  const json& resolved =
      schema_of_value.contains("$ref")
          ? document()[json::json_pointer(schema_of_value["$ref"].get<std::string>().substr(1))]
          : schema_of_value;
  if (resolved.contains("default")) {
    EXPECT_EQ(resolved["default"], value) << where;
    return;
  }
  ASSERT_TRUE(value.is_object()) << "no default in the schema of " << where;
  const json& object = resolved.contains("oneOf") && !resolved.contains("properties")
                           ? resolved["oneOf"][0]
                           : resolved;
  for (const auto& [key, member] : value.items())
    if (!object["properties"][key].contains("const"))
      expect_defaults(object["properties"][key], member, where + '/' + key);
}

TEST(OpenApi, DefaultsAreThoseOfTheConfiguration) {
  const json config = json::parse(std::ifstream(service_json()));
  expect_defaults(schema("RenderRequest"), config["request_defaults"], "");
}

/// The document's form of a part that GET /v1/objects lists, whose numbers must be the same.
void expect_same_parameters(const json& schema, const json& part) {
  std::set<std::string> listed;
  for (const json& parameter : part["parameters"]) {
    const std::string name = parameter["name"];
    SCOPED_TRACE(part["name"].get<std::string>() + ' ' + name);
    listed.insert(name);
    const json& described = schema["properties"][name];
    for (const char* bound : {"minimum", "maximum", "default"})
      if (parameter.contains(bound)) {
        EXPECT_EQ(parameter[bound], described[bound]);
      }
    if (parameter.contains("values")) {
      EXPECT_EQ(parameter["values"], described["enum"]);
    }
  }
  std::set<std::string> keys = properties(schema);
  if (schema["properties"].contains("type") && schema["properties"]["type"].contains("const"))
    keys.erase("type");
  EXPECT_EQ(listed, keys);
}

TEST(OpenApi, ObjectsAreThoseOfTheListing) {
  const json listing = json::parse(objects_json(shipped_catalog()));
  EXPECT_EQ(keys(listing), properties(schema("ObjectList")));
  std::set<std::string> names;
  for (const json& object : schema("Object")["oneOf"]) {
    const std::string type = object["properties"]["type"]["const"];
    names.insert(type);
    for (const json& part : listing["objects"])
      if (part["name"] == type) expect_same_parameters(object, part);
  }
  std::set<std::string> listed;
  for (const json& part : listing["objects"]) listed.insert(part["name"]);
  EXPECT_EQ(listed, names);
  expect_same_parameters(schema("Backdrop")["oneOf"][1], listing["backdrop"]);
  expect_same_parameters(schema("Material")["properties"]["oil_film"]["oneOf"][1],
                         listing["oil_film"]);
}

TEST(OpenApi, ImageFormatsAreThoseOfTheTable) {
  json names = json::array();
  std::set<std::string> mime_types;
  for (const ImageFormatRow& row : image_formats) {
    names.push_back(row.name);
    mime_types.emplace(row.mime_type);
  }
  int calls = 0;
  for (const auto& [path, item] : document()["paths"].items()) {
    if (!item.contains("get") || !item["get"].contains("parameters")) continue;
    for (const json& parameter : item["get"]["parameters"]) {
      if (parameter.value("name", "") == "format") {
        EXPECT_EQ(parameter["schema"]["enum"], names) << path;
        ++calls;
      }
      if (parameter.value("name", "") == "Accept") {
        EXPECT_EQ(parameter["description"], list_formats(&ImageFormatRow::mime_type, ", ") + '.');
      }
    }
  }
  EXPECT_EQ(calls, 3) << "image, point image, sheet";
  for (const char* response : {"Picture", "PartOfPicture"})
    EXPECT_EQ(keys(document()["components"]["responses"][response]["content"]), mime_types);
}

TEST(OpenApi, AnswersHaveTheKeysOfTheirSchemas) {
  const RenderRequest request = accepted(R"({"material":{"cube":)" + some_cube + "}}");
  RenderStatus status;
  status.request = canonical_json(request);
  status.material = material_report(request, shipped_catalog());
  status.stats = stats_json({});
  const json answer = json::parse(to_json(status));
  EXPECT_EQ(keys(answer), properties(schema("RenderStatus")));
  EXPECT_EQ(keys(answer["progress"]), properties(schema("Progress")));
  EXPECT_EQ(keys(answer["stats"]), properties(schema("Stats")));
  EXPECT_EQ(keys(answer["material"]), properties(schema("MaterialReport")));
  EXPECT_EQ(keys(json::parse(render_list_json({}, {}))), properties(schema("RenderList")));
  EXPECT_EQ(keys(json::parse(absorbers_json(shipped_catalog()))),
            properties(schema("AbsorberList")));
  EXPECT_EQ(keys(json::parse(environments_json(shipped_catalog(), {}))),
            properties(schema("EnvironmentList")));
  EXPECT_EQ(keys(json::parse(displays_json({}))), properties(schema("DisplayList")));
  EXPECT_EQ(keys(json::parse(to_json(Problem{ProblemCode::internal, "", {{"", ""}}}))),
            properties(schema("Problem")));
}

TEST(OpenApi, ProblemTypesAreThoseOfTheErrorTable) {
  std::set<std::string> described;
  for (const json& type : schema("Problem")["properties"]["type"]["enum"]) described.insert(type);
  std::set<std::string> table;
  for (int code = 0; code <= static_cast<int>(ProblemCode::internal); ++code)
    table.insert(kind(static_cast<ProblemCode>(code)).type);
  EXPECT_EQ(described, table);
}

TEST(OpenApi, StatesAreTheJobStates) {
  std::set<std::string> described, states;
  for (const json& state : schema("JobState")["enum"]) described.insert(state);
  for (const JobState state : all_job_states) states.insert(std::string(name(state)));
  EXPECT_EQ(described, states);
}

}  // namespace
}  // namespace translucube::api

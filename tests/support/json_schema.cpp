#include "tests/support/json_schema.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>

namespace translucube::test {
namespace {

using nlohmann::json;
using Faults = std::vector<std::string>;

const std::set<std::string> annotations{"description", "default", "title", "examples"};
const std::set<std::string> keywords{
    "$ref",       "type",    "enum",     "const",       "required",  "additionalProperties",
    "properties", "items",   "minItems", "maxItems",    "minLength", "exclusiveMinimum",
    "maxLength",  "pattern", "format",   "uniqueItems", "minimum",   "exclusiveMaximum",
    "maximum",    "oneOf",   "anyOf",    "not"};

bool is_type(const json& value, const std::string& type) {
  if (type == "object") return value.is_object();
  if (type == "array") return value.is_array();
  if (type == "string") return value.is_string();
  if (type == "boolean") return value.is_boolean();
  if (type == "null") return value.is_null();
  if (type == "number") return value.is_number();
  return type == "integer" && value.is_number_integer();
}

bool has_type(const json& value, const json& types) {
  if (types.is_string()) return is_type(value, types);
  return std::ranges::any_of(types, [&](const json& type) { return is_type(value, type); });
}

bool matches(const std::string& text, const std::string& pattern) {
  return std::regex_search(text, std::regex(pattern));
}

class Check {
 public:
  Check(const json& document, Faults& faults) : document_(document), faults_(faults) {}

  void value(const json& schema, const json& value, const std::string& where) {
    if (const auto it = schema.find("$ref"); it != schema.end())
      this->value(document_.at(json::json_pointer(it->get<std::string>().substr(1))), value, where);
    const auto wrong = [&](const std::string& what) { faults_.push_back(where + ": " + what); };
    const auto asks = [&](const char* key, auto&& holds) {
      const auto it = schema.find(key);
      if (it != schema.end() && !holds(*it))
        wrong(std::string("against ") + key + ' ' + it->dump());
    };
    asks("type", [&](const json& types) { return has_type(value, types); });
    asks("const", [&](const json& only) { return value == only; });
    asks("enum", [&](const json& all) { return std::ranges::find(all, value) != all.end(); });
    asks("oneOf", [&](const json& all) { return count_fitting(all, value) == 1; });
    asks("anyOf", [&](const json& all) { return count_fitting(all, value) >= 1; });
    asks("not", [&](const json& other) { return !fits(other, value); });
    if (value.is_number()) number(asks, value.get<double>());
    if (value.is_string()) text(asks, value.get<std::string>());
    if (value.is_array()) array(schema, asks, value, where);
    if (value.is_object()) object(schema, value, where);
  }

 private:
  template <typename Asks>
  void number(const Asks& asks, double number) {
    asks("minimum", [&](const json& least) { return number >= least.get<double>(); });
    asks("maximum", [&](const json& most) { return number <= most.get<double>(); });
    asks("exclusiveMinimum", [&](const json& bound) { return number > bound.get<double>(); });
    asks("exclusiveMaximum", [&](const json& bound) { return number < bound.get<double>(); });
  }

  template <typename Asks>
  void text(const Asks& asks, const std::string& text) {
    asks("minLength", [&](const json& least) { return text.size() >= least; });
    asks("maxLength", [&](const json& most) { return text.size() <= most; });
    asks("pattern", [&](const json& pattern) { return matches(text, pattern); });
    asks("format", [&](const json& format) {
      return format != "date-time" || matches(text, R"(^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d(\.\d+)?Z$)");
    });
  }

  template <typename Asks>
  void array(const json& schema, const Asks& asks, const json& array, const std::string& where) {
    asks("minItems", [&](const json& least) { return array.size() >= least; });
    asks("maxItems", [&](const json& most) { return array.size() <= most; });
    asks("uniqueItems", [&](const json& unique) {
      return !unique || std::set<json>(array.begin(), array.end()).size() == array.size();
    });
    if (const auto items = schema.find("items"); items != schema.end())
      for (std::size_t i = 0; i < array.size(); ++i)
        value(*items, array[i], where + '/' + std::to_string(i));
  }

  void object(const json& schema, const json& object, const std::string& where) {
    for (const json& key : schema.value("required", json::array()))
      if (!object.contains(key)) faults_.push_back(where + ": has no " + key.get<std::string>());
    const json properties = schema.value("properties", json::object());
    for (const auto& [key, member] : object.items()) {
      if (properties.contains(key))
        value(properties[key], member, where + '/' + key);
      else if (!schema.value("additionalProperties", true))
        faults_.push_back(where + '/' + key + ": is not described");
    }
  }

  bool fits(const json& schema, const json& value) const {
    Faults faults;
    Check(document_, faults).value(schema, value, "");
    return faults.empty();
  }
  std::ptrdiff_t count_fitting(const json& schemas, const json& value) const {
    return std::ranges::count_if(schemas, [&](const json& one) { return fits(one, value); });
  }

  const json& document_;
  Faults& faults_;
};

}  // namespace

Faults schema_faults(const json& document, const json& schema, const json& value) {
  Faults faults;
  Check(document, faults).value(schema, value, "");
  return faults;
}

Faults unknown_keywords(const json& schema) {
  Faults unknown;
  const auto look_into = [&](const json& inner) {
    for (std::string& keyword : unknown_keywords(inner)) unknown.push_back(std::move(keyword));
  };
  for (const auto& [key, value] : schema.items()) {
    // Whether other keys are allowed is all that is known of them.
    const bool known = key == "additionalProperties"
                           ? value.is_boolean()
                           : keywords.contains(key) || annotations.contains(key);
    if (!known) unknown.push_back(key);
    if (key == "format" && value != "date-time" && value != "binary")
      unknown.push_back("format " + value.dump());
    if (key == "items" || key == "not") look_into(value);
    if (key == "properties" || key == "oneOf" || key == "anyOf")
      for (const json& inner : value) look_into(inner);
  }
  return unknown;
}

}  // namespace translucube::test

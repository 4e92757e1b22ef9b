#include "api/base/field_reader.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "api/base/text.h"

namespace translucube::api {

using nlohmann::json;

bool Range::contains(double value) const {
  return (low_open ? value > low : value >= low) && (high_open ? value < high : value <= high);
}

std::string Range::text() const {
  constexpr double largest = std::numeric_limits<double>::max();
  const bool has_low = low > -largest, has_high = high < largest;
  if (has_low && has_high)
    return std::string("in ") + (low_open ? "(" : "[") + number_text(low) + ", " +
           number_text(high) + (high_open ? ")" : "]");
  if (has_low) return (low_open ? "> " : ">= ") + number_text(low);
  if (has_high) return (high_open ? "< " : "<= ") + number_text(high);
  return "";
}

FieldReader::FieldReader(const json& value, std::string pointer, Faults& faults)
    : object_(value.is_object() ? &value : nullptr), pointer_(std::move(pointer)), faults_(faults) {
  if (!object_) faults_.add(pointer_, "must be an object");
}

const json* FieldReader::find(std::string_view key, Presence presence) {
  known_.push_back(key);
  if (!object_) return nullptr;
  const auto found = object_->find(key);
  if (found != object_->end()) return &*found;
  if (presence == Presence::required) fault(key, "is required");
  return nullptr;
}

std::optional<double> FieldReader::number(const json& value, const std::string& pointer,
                                          const Range& range) {
  if (value.is_number()) {
    const double number = value.get<double>();
    if (std::isnan(number)) return std::nullopt;  // the reader has told its fault
    if (range.contains(number)) return number + 0.0;
  }
  const std::string where = range.text();
  faults_.add(pointer, where.empty() ? "must be a number" : "must be a number " + where);
  return std::nullopt;
}

std::optional<double> FieldReader::number(std::string_view key, const Range& range,
                                          Presence presence) {
  const json* value = find(key, presence);
  return value ? number(*value, pointer_to(key), range) : std::nullopt;
}

std::optional<std::uint64_t> FieldReader::integer(std::string_view key, std::uint64_t low,
                                                  std::uint64_t high, Presence presence) {
  const json* value = find(key, presence);
  if (!value) return std::nullopt;
  if (value->is_number_float() && std::isnan(value->get<double>())) return std::nullopt;
  // Signed integers are the negative ones: nlohmann reads all others as unsigned. -0 is one of
  // them.
  if (value->is_number_unsigned() || (value->is_number_integer() && *value == 0)) {
    const auto number = value->get<std::uint64_t>();
    if (number >= low && number <= high) return number;
  }
  // 1.0 and 1e0 are integers too (JSON Schema 2020-12, validation 6.1.1).
  if (value->is_number_float()) {
    const auto number = value->get<double>();
    if (number == std::floor(number) && number >= 0 && number < 0x1p64) {
      const auto whole = static_cast<std::uint64_t>(number);
      if (whole >= low && whole <= high) return whole;
    }
  }
  fault(key, "must be an integer from " + std::to_string(low) + " to " + std::to_string(high));
  return std::nullopt;
}

std::optional<bool> FieldReader::boolean(std::string_view key) {
  const json* value = find(key);
  if (!value) return std::nullopt;
  if (value->is_boolean()) return value->get<bool>();
  fault(key, "must be true or false");
  return std::nullopt;
}

std::optional<std::string> FieldReader::string(std::string_view key, Presence presence) {
  const json* value = find(key, presence);
  if (!value) return std::nullopt;
  if (value->is_string()) return value->get<std::string>();
  fault(key, "must be a string");
  return std::nullopt;
}

std::optional<std::vector<double>> FieldReader::numbers(std::string_view key, const Range& range,
                                                        std::size_t most) {
  const json* value = find(key, Presence::required);
  if (!value) return std::nullopt;
  if (!value->is_array() || value->size() > most) {
    fault(key, "must be an array of at most " + std::to_string(most) + " numbers");
    return std::nullopt;
  }
  std::vector<double> list;
  for (std::size_t i = 0; i < value->size(); ++i)
    if (const auto element = number((*value)[i], pointer_to(key) + '/' + std::to_string(i), range))
      list.push_back(*element);
  if (list.size() < value->size()) return std::nullopt;
  return list;
}

std::optional<std::array<double, 3>> FieldReader::triple(std::string_view key, const Range& range,
                                                         Presence presence) {
  const json* value = find(key, presence);
  if (!value) return std::nullopt;
  return triple(*value, pointer_to(key), range);
}

std::optional<std::array<double, 3>> FieldReader::triple(const json& value,
                                                         const std::string& pointer,
                                                         const Range& range) {
  if (!value.is_array() || value.size() != 3) {
    faults_.add(pointer, "must be an array of three numbers");
    return std::nullopt;
  }
  std::array<double, 3> three{};
  bool complete = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto element = number(value[i], pointer + '/' + std::to_string(i), range);
    complete = complete && element;
    three[i] = element.value_or(0);
  }
  return complete ? std::optional(three) : std::nullopt;
}

std::optional<std::vector<std::array<double, 3>>> FieldReader::triples(
    std::string_view key, const Range& range, std::initializer_list<std::size_t> counts) {
  const json* value = find(key);
  if (!value) return std::nullopt;
  if (!value->is_array() || std::ranges::find(counts, value->size()) == counts.end()) {
    std::vector<std::string> names;
    for (const std::size_t count : counts) names.push_back(std::to_string(count));
    fault(key, "must be a list of triples of numbers, as many as one of " + name_list(names));
    return std::nullopt;
  }
  std::vector<std::array<double, 3>> list;
  for (std::size_t i = 0; i < value->size(); ++i)
    if (const auto three = triple((*value)[i], pointer_to(key) + '/' + std::to_string(i), range))
      list.push_back(*three);
  return list.size() == value->size() ? std::optional(list) : std::nullopt;
}

int FieldReader::exclusive(std::initializer_list<std::string_view> keys, Presence presence) {
  int present = 0;
  std::vector<std::string> names;
  for (const std::string_view key : keys) {
    present += has(key);
    names.emplace_back(key);
    known_.push_back(key);
  }
  if (object_ && present > 1)
    faults_.add(pointer_, "must have only one of " + name_list(names));
  else if (object_ && present == 0 && presence == Presence::required)
    faults_.add(pointer_, "must have one of " + name_list(names));
  return present;
}

bool FieldReader::has(std::string_view key) const { return object_ && object_->contains(key); }

std::string FieldReader::pointer_to(std::string_view key) const {
  return pointer_ + '/' + pointer_token(key);
}

void FieldReader::fault(std::string_view key, std::string detail) {
  faults_.add(pointer_to(key), std::move(detail));
}

void FieldReader::refuse_unknown_keys() {
  if (!object_) return;
  std::string detail;
  for (const auto& item : object_->items()) {
    if (std::find(known_.begin(), known_.end(), item.key()) != known_.end()) continue;
    if (detail.empty()) {
      std::vector<std::string> names(known_.begin(), known_.end());
      std::sort(names.begin(), names.end());
      names.erase(std::unique(names.begin(), names.end()), names.end());
      detail = "unknown key; known here: " + name_list(names);
    }
    fault(item.key(), detail);
  }
}

std::string name_list(const std::vector<std::string>& names) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return list.empty() ? "none" : list;
}

}  // namespace translucube::api

#include "renderer/shape/file/gltf/value.h"

#include <cmath>

namespace translucube::gltf {

std::optional<Value> Value::find(const char* key) const {
  if (!json_->is_object()) fail("must be an object");
  const auto member = json_->find(key);
  if (member == json_->end()) return std::nullopt;
  return Value(*member, pointer_ + '/' + key);
}

Value Value::at(const char* key) const {
  if (auto member = find(key)) return *std::move(member);
  fail(std::string("has no ") + key);
}

std::size_t Value::size() const {
  if (!json_->is_array()) fail("must be an array");
  return json_->size();
}

Value Value::at(std::uint64_t index) const {
  if (index >= size())
    fail("has no element " + std::to_string(index) + ": there are " + std::to_string(size()));
  return Value((*json_)[index], pointer_ + '/' + std::to_string(index));
}

std::uint64_t Value::integer(std::uint64_t most) const {
  const double value = json_->is_number() ? json_->get<double>() : -1;
  if (!(value >= 0) || value > static_cast<double>(most) || value != std::floor(value))
    fail("must be an integer in [0, " + std::to_string(most) + "]");
  return static_cast<std::uint64_t>(value);
}

double Value::number() const {
  const double value = json_->is_number() ? json_->get<double>() : std::nan("");
  if (!std::isfinite(value)) fail("must be a number");
  return value;
}

bool Value::boolean() const {
  if (!json_->is_boolean()) fail("must be true or false");
  return json_->get<bool>();
}

const std::string& Value::text() const {
  if (!json_->is_string()) fail("must be a string");
  return json_->get_ref<const std::string&>();
}

Value referred(const Value& document, const char* array, const Value& reference) {
  const auto elements = document.find(array);
  const std::size_t count = elements ? elements->size() : 0;
  const std::uint64_t index = reference.integer();
  if (index >= count)
    reference.fail("names " + std::to_string(index) + " of the " + array + ": there are " +
                   std::to_string(count));
  return elements->at(index);
}

}  // namespace translucube::gltf

#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "renderer/shape/triangle_mesh.h"

namespace translucube::gltf {

/// A value of the document and where it stands (RFC 6901). What is not as it has to be throws a
/// MeshError with that pointer.
class Value {
 public:
  explicit Value(const nlohmann::json& json, std::string pointer = {})
      : json_(&json), pointer_(std::move(pointer)) {}

  [[noreturn]] void fail(const std::string& why) const {
    throw MeshError((pointer_.empty() ? "the document" : pointer_) + ": " + why);
  }

  /// A member of an object.
  std::optional<Value> find(const char* key) const;
  Value at(const char* key) const;
  bool has(const char* key) const { return find(key).has_value(); }

  /// An element of an array.
  std::size_t size() const;
  Value at(std::uint64_t index) const;

  /// An integer that is at most `most`.
  std::uint64_t integer(std::uint64_t most = largest) const;
  double number() const;  ///< finite
  bool boolean() const;
  const std::string& text() const;

  /// Every integer up to it is exact in JSON.
  static constexpr std::uint64_t largest = (std::uint64_t{1} << 53) - 1;

 private:
  const nlohmann::json* json_;
  std::string pointer_;
};

/// What an index that stands at `reference` names of an array of the document.
Value referred(const Value& document, const char* array, const Value& reference);

}  // namespace translucube::gltf

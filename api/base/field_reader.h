#pragma once

// Typed reading of a JSON object's fields: every fault goes to a list with its pointer, and reading
// goes on.

#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/base/faults.h"

namespace translucube::api {

/// An interval of numbers, each end closed or open.
struct Range {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
  bool low_open = false, high_open = false;

  bool contains(double value) const;
  std::string text() const;  ///< "in [0, 1]", "> 0", ...
};
inline constexpr Range unit_range{0, 1};

enum class Presence { optional, required };

class FieldReader {
 public:
  /// A value that is no object is a fault, and reads like an empty one that misses nothing.
  FieldReader(const nlohmann::json& value, std::string pointer, Faults& faults);

  /// Null where the key is missing (a fault if it is required). Keys that are asked for are known.
  const nlohmann::json* find(std::string_view key, Presence presence = Presence::optional);

  /// The value if it is there and right. Minus zero reads as zero: they mean the same everywhere.
  std::optional<double> number(std::string_view key, const Range& range,
                               Presence presence = Presence::optional);
  std::optional<std::uint64_t> integer(std::string_view key, std::uint64_t low, std::uint64_t high,
                                       Presence presence = Presence::optional);
  std::optional<bool> boolean(std::string_view key);
  std::optional<std::string> string(std::string_view key, Presence presence = Presence::optional);
  std::optional<std::array<double, 3>> triple(std::string_view key, const Range& range,
                                              Presence presence = Presence::optional);
  /// A list of triples, as many as one of `counts`.
  std::optional<std::vector<std::array<double, 3>>> triples(
      std::string_view key, const Range& range, std::initializer_list<std::size_t> counts);
  /// At most `most` numbers.
  std::optional<std::vector<double>> numbers(std::string_view key, const Range& range,
                                             std::size_t most);

  /// How many of these keys are there; more than one, or none where one is required, is a fault of
  /// the object. All of them are known from then on.
  int exclusive(std::initializer_list<std::string_view> keys, Presence presence);

  bool has(std::string_view key) const;
  std::string pointer_to(std::string_view key) const;
  const std::string& pointer() const { return pointer_; }
  void fault(std::string_view key, std::string detail);

  /// Faults for the keys that nobody asked for.
  void refuse_unknown_keys();

 private:
  std::optional<double> number(const nlohmann::json& value, const std::string& pointer,
                               const Range& range);
  std::optional<std::array<double, 3>> triple(const nlohmann::json& value,
                                              const std::string& pointer, const Range& range);

  const nlohmann::json* object_;  ///< null where the value is no object
  std::string pointer_;
  Faults& faults_;
  std::vector<std::string_view> known_;
};

/// "a, b, c" or "none" of the keys of a map or the names in a list.
std::string name_list(const std::vector<std::string>& names);

}  // namespace translucube::api

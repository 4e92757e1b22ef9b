#pragma once

// Texts and the numbers in them.

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

namespace translucube::api {

/// The whole text as a number, or nothing. `form` is the base of an integer, 10 by default.
template <typename Number, typename... Form>
std::optional<Number> number_of(std::string_view text, Form... form) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [at, error] = std::from_chars(text.data(), end, value, form...);
  if (error != std::errc() || at != end) return std::nullopt;
  return value;
}

/// The shortest text that reads back as the number.
inline std::string number_text(double value) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// The text with ASCII letters in lower case.
inline std::string lower_case(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return lower;
}

/// A SHA-256 in hexadecimal: 64 digits, in lower case.
inline bool is_sha256(std::string_view text) {
  return text.size() == 64 && text.find_first_not_of("0123456789abcdef") == text.npos;
}

}  // namespace translucube::api

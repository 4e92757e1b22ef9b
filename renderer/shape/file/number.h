#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

namespace translucube {

/// Reads a whole word as a finite number in double precision, with a sign of either kind.
inline bool read_number(std::string_view word, double& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  if (word.starts_with('+')) return false;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (end != word.data() + word.size()) return false;
  // What is smaller than the smallest number is as good as 0.
  if (error == std::errc::result_out_of_range && word.find("e-") != word.npos)
    value = 0;
  else if (error == std::errc::result_out_of_range && word.find("E-") != word.npos)
    value = 0;
  else if (error != std::errc{})
    return false;
  return std::isfinite(value);
}

template <class Integer>
bool read_integer(std::string_view word, Integer& value) {
  if (word.starts_with('+')) word.remove_prefix(1);
  if (word.starts_with('+')) return false;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return end == word.data() + word.size() && error == std::errc{};
}

/// The next word of a text and what is left behind it; empty at the end.
inline std::string_view next_word(std::string_view& rest, std::string_view space = " \t\r\f\v") {
  const std::size_t begin = rest.find_first_not_of(space);
  if (begin == rest.npos) {
    rest = {};
    return {};
  }
  const std::size_t end = std::min(rest.find_first_of(space, begin), rest.size());
  const std::string_view word = rest.substr(begin, end - begin);
  rest.remove_prefix(end);
  return word;
}

/// A word of a file in a refusal.
inline std::string printable(std::string_view word) {
  std::string text(word.substr(0, 32));
  std::ranges::replace_if(
      text, [](unsigned char c) { return c < 32 || c > 126; }, '?');
  return text;
}

}  // namespace translucube

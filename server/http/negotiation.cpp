#include "server/http/negotiation.h"

#include <algorithm>
#include <array>
#include <vector>

#include "api/base/text.h"
#include "server/http/grammar.h"

namespace translucube::server {
namespace {

using api::lower_case;
using api::number_of;

/// Splits at a separator outside of quoted strings.
std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  bool quoted = false;
  std::size_t start = 0;
  for (std::size_t i = 0; i <= text.size(); ++i) {
    if (i == text.size() || (text[i] == separator && !quoted)) {
      parts.push_back(trimmed(text.substr(start, i - start)));
      start = i + 1;
    } else if (text[i] == '"') {
      quoted = !quoted;
    } else if (text[i] == '\\' && quoted && i + 1 < text.size()) {
      ++i;
    }
  }
  return parts;
}

/// The q parameter of a media range; a value that is none counts as 0.
double quality_of(const std::vector<std::string_view>& parts) {
  for (std::size_t i = 1; i < parts.size(); ++i) {
    const std::size_t equals = parts[i].find('=');
    if (equals == parts[i].npos || lower_case(trimmed(parts[i].substr(0, equals))) != "q") continue;
    const double q = number_of<double>(trimmed(parts[i].substr(equals + 1))).value_or(0);
    return q >= 0 && q <= 1 ? q : 0;
  }
  return 1;
}

/// 3 for the type itself, 2 for its family, 1 for anything, 0 for no match.
int specificity(const std::string& range, std::string_view mime) {
  if (range == mime) return 3;
  if (range == "image/*") return 2;
  return range == "*/*" || range == "*" ? 1 : 0;
}

/// The tag without the mark of a weak one.
std::string_view opaque(std::string_view tag) {
  if (tag.starts_with("W/")) tag.remove_prefix(2);
  return tag;
}

/// Whether "*", or an entity tag of the list up to the first that is malformed, is `such`: in
/// quotes, between which a backslash is a character as any other (RFC 9110, 8.8.3).
template <typename Such>
bool has_etag(std::string_view list, Such such) {
  if (trimmed(list) == "*") return true;
  while (!list.empty()) {
    while (!list.empty() && (is_blank(list.front()) || list.front() == ',')) list.remove_prefix(1);
    const std::size_t open = list.starts_with("W/") ? 2 : 0;
    if (list.size() <= open || list[open] != '"') return false;
    const std::size_t close = list.find('"', open + 1);
    if (close == list.npos) return false;
    if (such(list.substr(0, close + 1))) return true;
    list.remove_prefix(close + 1);
    if (!trimmed(take_until(list, ",")).empty()) return false;
  }
  return false;
}

}  // namespace

std::optional<ImageFormat> negotiate_image(std::string_view accept) {
  if (trimmed(accept).empty()) return image_formats[0].format;
  std::array<double, image_formats.size()> quality{};
  std::array<int, image_formats.size()> matched{};
  for (const std::string_view item : split(accept, ',')) {
    const std::vector<std::string_view> parts = split(item, ';');
    const std::string range = lower_case(parts[0]);
    for (std::size_t i = 0; i < image_formats.size(); ++i) {
      const int match = specificity(range, image_formats[i].mime_type);
      if (match == 0 || match < matched[i]) continue;
      matched[i] = match;
      quality[i] = quality_of(parts);
    }
  }
  const auto best = static_cast<std::size_t>(std::ranges::max_element(quality) - quality.begin());
  if (!(quality[best] > 0)) return std::nullopt;
  return image_formats[best].format;
}

bool is_json(std::string_view content_type) {
  return lower_case(split(content_type, ';')[0]) == "application/json";
}

bool etag_matches(std::string_view list, std::string_view etag) {
  return has_etag(list, [&](std::string_view tag) { return opaque(tag) == opaque(etag); });
}

bool etag_matches_strongly(std::string_view list, std::string_view etag) {
  return has_etag(list, [&](std::string_view tag) { return tag == etag && opaque(tag) == tag; });
}

std::optional<int> preferred_wait(std::string_view prefer) {
  for (const std::string_view item : split(prefer, ',')) {
    const std::string_view preference = split(item, ';')[0];
    const std::size_t equals = preference.find('=');
    if (equals == preference.npos || lower_case(trimmed(preference.substr(0, equals))) != "wait")
      continue;
    std::string_view value = trimmed(preference.substr(equals + 1));
    if (value.size() >= 2 && value.front() == '"' && value.back() == '"')
      value = value.substr(1, value.size() - 2);
    const std::optional<int> seconds = number_of<int>(value);
    return seconds && *seconds >= 0 ? seconds : std::nullopt;
  }
  return std::nullopt;
}

std::variant<WholeBody, ByteRange, UnsatisfiableRange> requested_range(std::string_view range,
                                                                       std::uint64_t size) {
  const std::size_t equals = range.find('=');
  if (equals == range.npos || lower_case(trimmed(range.substr(0, equals))) != "bytes")
    return WholeBody{};
  const std::string_view spec = trimmed(range.substr(equals + 1));
  const std::size_t dash = spec.find('-');
  if (dash == spec.npos || spec.find(',') != spec.npos) return WholeBody{};
  const std::string_view first_text = trimmed(spec.substr(0, dash));
  const std::string_view last_text = trimmed(spec.substr(dash + 1));
  const auto first = number_of<std::uint64_t>(first_text);
  const auto last = number_of<std::uint64_t>(last_text);
  if ((!first && !first_text.empty()) || (!last && !last_text.empty())) return WholeBody{};
  if (!first && !last) return WholeBody{};

  if (!first) {  // the last so many bytes
    if (*last == 0 || size == 0) return UnsatisfiableRange{};
    const std::uint64_t length = std::min(*last, size);
    return ByteRange{size - length, length};
  }
  if (last && *last < *first) return WholeBody{};
  if (*first >= size) return UnsatisfiableRange{};
  return ByteRange{*first, std::min(last.value_or(size - 1), size - 1) - *first + 1};
}

std::uint64_t last_event_id(std::string_view text) {
  return number_of<std::uint64_t>(text).value_or(0);
}

bool is_idempotency_key(std::string_view text) {
  return !text.empty() && text.size() <= 255 &&
         std::ranges::all_of(text, [](char c) { return c > ' ' && c < 127; });
}

}  // namespace translucube::server

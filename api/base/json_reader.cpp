#include "api/base/json_reader.h"

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace translucube::api {
namespace {

using nlohmann::json;

/// Builds the document from nlohmann's SAX events, with an eye on what its DOM parser lets pass.
class DocumentBuilder {
 public:
  explicit DocumentBuilder(const std::set<std::size_t>& too_large) : too_large_(too_large) {}

  bool null() { return add(nullptr); }
  bool boolean(bool value) { return add(value); }
  bool number_integer(json::number_integer_t value) { return add_number(value); }
  bool number_unsigned(json::number_unsigned_t value) { return add_number(value); }
  bool number_float(json::number_float_t value, const std::string&) { return add_number(value); }
  bool string(std::string& value) { return add(std::move(value)); }
  bool binary(json::binary_t&) { return false; }  // not in JSON text

  bool start_object(std::size_t) { return open(json::object()); }
  bool start_array(std::size_t) { return open(json::array()); }
  bool end_object() { return close(); }
  bool end_array() { return close(); }

  bool key(std::string& key) {
    Level& level = open_.back();
    level.key = key;
    const bool repeated = level.container->contains(key);
    level.slot = &(*level.container)[std::move(key)];
    if (repeated) document.faults.add(pointer(), "duplicate key");
    return true;
  }

  bool parse_error(std::size_t position, const std::string& token, const json::exception& error) {
    constexpr int number_overflow = 406;
    error_offset = position == 0 ? 0 : position - 1;
    if (error.id == number_overflow) overflowing_token = {position - token.size(), token.size()};
    return false;
  }

  JsonDocument document;
  bool too_deep = false;
  std::size_t error_offset = 0;
  std::pair<std::size_t, std::size_t> overflowing_token{0, 0};  ///< offset, size
  std::size_t numbers = 0;                                      ///< read so far

 private:
  struct Level {
    json* container;
    std::string key;       ///< of an object: the key that was read last
    json* slot = nullptr;  ///< its value
  };

  /// Where the next value goes. A container does not grow while one of its elements is open, so the
  /// pointers in open_ stay valid.
  json& next() {
    if (open_.empty()) return document.value;
    Level& level = open_.back();
    if (level.container->is_object()) return *level.slot;
    return level.container->emplace_back();
  }

  template <typename T>
  bool add(T&& value) {
    next() = std::forward<T>(value);
    return true;
  }

  template <typename T>
  bool add_number(T value) {
    if (!too_large_.contains(numbers++)) return add(value);
    next() = std::numeric_limits<double>::quiet_NaN();
    document.faults.add(pointer(), "must be a number within double precision");
    return true;
  }

  bool open(json container) {
    json& place = next();
    place = std::move(container);
    if (open_.size() == deepest_nesting) {
      document.faults.add(pointer(), "nested deeper than " + std::to_string(deepest_nesting) +
                                         " levels; the rest was not read");
      too_deep = true;
      return false;
    }
    open_.push_back({&place, {}});
    return true;
  }

  bool close() {
    open_.pop_back();
    return true;
  }

  std::string pointer() const {
    std::string path;
    for (const Level& level : open_)
      path += '/' + (level.container->is_object() ? pointer_token(level.key)
                                                  : std::to_string(level.container->size() - 1));
    return path;
  }

  const std::set<std::size_t>& too_large_;
  std::vector<Level> open_;
};

Problem malformed(std::string_view text, std::size_t offset) {
  std::string detail =
      offset >= text.size()
          ? "the document ends too early, after " + std::to_string(text.size())
          : "not JSON near byte " + std::to_string(offset) + " of " + std::to_string(text.size());
  return {ProblemCode::malformed_json, detail + (offset >= text.size() ? " bytes" : ""), {}};
}

}  // namespace

Result<JsonDocument> read_json(std::string_view text, std::uint64_t most_bytes) {
  if (text.size() > most_bytes)
    return Problem{ProblemCode::payload_too_large,
                   "a body may have at most " + std::to_string(most_bytes) + " bytes",
                   {}};
  // nlohmann skips a byte order mark and takes a zero byte for the end of the text.
  if (text.starts_with("\xEF\xBB\xBF"))
    return Problem{ProblemCode::malformed_json, "the document starts with a byte order mark", {}};
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos)
    return malformed(text, zero);

  // nlohmann stops at a number that overflows. To find the other faults too, the number is
  // overwritten with a 0, its place among the numbers is remembered, and the text is read again:
  // few times, as reading must stay linear.
  constexpr std::size_t most_overflows = 8;
  std::string patched;
  std::set<std::size_t> too_large;
  for (;;) {
    DocumentBuilder builder(too_large);
    const std::string_view source = too_large.empty() ? text : std::string_view(patched);
    if (json::sax_parse(source.begin(), source.end(), &builder)) return std::move(builder.document);
    if (builder.too_deep) return invalid_request(builder.document.faults);
    const auto [offset, size] = builder.overflowing_token;
    if (size == 0) return malformed(text, builder.error_offset);
    if (too_large.size() == most_overflows) {
      builder.document.faults.add("", "more numbers are too large; the rest was not read");
      return invalid_request(builder.document.faults);
    }
    if (too_large.empty()) patched = text;
    std::fill_n(patched.begin() + static_cast<std::ptrdiff_t>(offset), size, ' ');
    patched[offset] = '0';
    too_large.insert(builder.numbers);
  }
}

}  // namespace translucube::api

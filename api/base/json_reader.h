#pragma once

// Strict reading of a JSON document: the layer below every parser of this folder.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string_view>

#include "api/base/faults.h"
#include "api/base/result.h"

namespace translucube::api {

/// Arrays and objects within each other; a render request needs four.
inline constexpr std::size_t deepest_nesting = 16;

struct JsonDocument {
  /// Whole and well-formed. A number too large for double precision is NaN here and has its fault.
  nlohmann::json value;
  Faults faults;  ///< duplicate keys and numbers too large
};

/// Reads RFC 8259 JSON, no extensions, in time linear in its size. Refuses with a problem: more
/// than `most_bytes` (payload_too_large), anything that is not JSON in UTF-8, a byte order mark
/// included (malformed_json, with the offset but none of the text), and nesting deeper than
/// deepest_nesting (invalid_request; the rest is not read).
Result<JsonDocument> read_json(std::string_view text, std::uint64_t most_bytes);

}  // namespace translucube::api

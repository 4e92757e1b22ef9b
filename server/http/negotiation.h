#pragma once

// What a client's headers ask for (RFC 9110, RFC 7240), as pure functions.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "picture/image_format.h"

namespace translucube::server {

/// The format with the highest quality value in an Accept header (RFC 9110, 12.5.1); of equals, the
/// first of image_formats. An empty header accepts anything. Empty: none is acceptable.
std::optional<ImageFormat> negotiate_image(std::string_view accept);

/// True for application/json, with or without parameters.
bool is_json(std::string_view content_type);

/// Whether a list of entity tags, or "*", has this one: compared weakly, as If-None-Match does, or
/// strongly, as If-Match does (RFC 9110, 8.8.3.2).
bool etag_matches(std::string_view list, std::string_view etag);
bool etag_matches_strongly(std::string_view list, std::string_view etag);

/// The seconds of `wait` in a Prefer header (RFC 7240, 4.3); empty where it is not there or is no
/// number: a preference that is not understood is ignored.
std::optional<int> preferred_wait(std::string_view prefer);

struct WholeBody {};
struct ByteRange {
  std::uint64_t first = 0, length = 0;
};
struct UnsatisfiableRange {};
/// A Range header (RFC 9110, 14.1.2) for a body of `size` bytes. What is malformed, of another unit
/// or asks for several ranges is answered with the whole body, as the RFC allows.
std::variant<WholeBody, ByteRange, UnsatisfiableRange> requested_range(std::string_view range,
                                                                       std::uint64_t size);

/// Last-Event-ID of an event stream. Anything but a number of ours starts from the beginning.
std::uint64_t last_event_id(std::string_view text);

/// An Idempotency-Key: 1 to 255 visible ASCII characters.
bool is_idempotency_key(std::string_view text);

}  // namespace translucube::server

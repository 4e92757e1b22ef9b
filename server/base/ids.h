#pragma once

#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <string_view>

namespace translucube::server {

/// Two hexadecimal digits for each byte, in lower case.
std::string hex(std::span<const unsigned char> bytes);

/// Random bytes of the operating system, as hexadecimal digits.
std::string random_hex(int bytes);

/// A fingerprint of bytes for an entity tag, 16 hexadecimal digits.
std::string content_hash(std::string_view bytes);

/// True for the form of an id: 26 characters of Crockford's base 32. Nothing else of what a client
/// sends may become part of a path.
bool is_id(std::string_view text);

/// Ids in the manner of ULID: 48 bits of time [ms], 80 random bits. They sort by creation, also
/// within a millisecond and when the clock is set back. Safe to share by threads.
class IdSource {
 public:
  /// Ids sort behind `last`, the newest one of an earlier run; ignored if it is no id.
  explicit IdSource(std::string_view last = {});
  std::string next(std::int64_t now_ms);

 private:
  __extension__ using Bits = unsigned __int128;
  std::mutex mutex_;
  Bits last_ = 0;
};

}  // namespace translucube::server

#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <functional>
#include <string>

namespace translucube::server {

inline constexpr std::int64_t day_ms = 86'400'000;

/// Milliseconds since 1970, UTC. Injected where tests turn the clock.
using Clock = std::function<std::int64_t()>;

inline std::int64_t system_clock_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

/// Milliseconds since some moment: goes on through changes of the system's clock and its sleep.
inline std::int64_t monotonic_clock_ms() {
  timespec now{};
  clock_gettime(CLOCK_BOOTTIME, &now);
  return std::int64_t{now.tv_sec} * 1000 + now.tv_nsec / 1'000'000;
}

/// RFC 3339 in UTC with milliseconds.
std::string rfc3339(std::int64_t unix_ms);

}  // namespace translucube::server

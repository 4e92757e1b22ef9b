#pragma once

namespace translucube {

/// Whether this is compiled for a sanitizer, under which a render takes ten to fifty times as long.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool sanitized = true;
#else
inline constexpr bool sanitized = false;
#endif

}  // namespace translucube

#pragma once

// Another absorber for a render that is done: what an explorable film is developed for.

#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "api/base/result.h"
#include "api/request/catalog.h"
#include "renderer/scene/spec.h"

namespace translucube::api {

/// What is left out stays as the render's request has it.
struct Redevelopment {
  std::optional<double> absorption{};  ///< the cube's, [0, 1]
  /// A name of the catalog, or JSON text of an absorber as a request has it ({"rgb": ...}).
  std::optional<std::string> absorber{};

  bool asked() const { return absorption || absorber; }
  auto operator<=>(const Redevelopment&) const = default;
};

/// The whole text as a number in [0, 1], or nothing.
std::optional<double> absorption_number(std::string_view text);

struct Redeveloped {
  Absorption absorption;
  std::string request;  ///< canonical: rendered anew, it would give the same picture
};

/// Faults have the pointers "?absorption" and "?absorber". Only the material of the request is read
/// again: its environment may have gone since.
Result<Redeveloped> redevelop(std::string_view canonical_request, const Redevelopment& asked,
                              const Catalog& catalog);

/// The canonical request with another quality: this many samples.
std::string with_samples(std::string_view canonical_request, std::uint32_t samples);

}  // namespace translucube::api

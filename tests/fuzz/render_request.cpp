// The parser of render requests takes any bytes; what it accepts has a canonical form that means
// the same.

#include "api/answer/material_report.h"
#include "api/request/canonical.h"
#include "api/request/parse.h"
#include "tests/fuzz/requests.h"

using namespace translucube;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto parsed = api::parse_render_request(text, fuzz::catalog());
  if (!parsed) {
    fuzz::check(parsed.problem());
    return 0;
  }
  const auto& request = *parsed;
  const std::string canonical = api::canonical_json(request);
  const auto same = api::parse_render_request(canonical, fuzz::catalog());
  fuzz::require(same && *same == request, "the canonical form is the same request");
  fuzz::require(api::canonical_json(*same) == canonical, "there is one canonical form");
  fuzz::require(!api::material_report(request, fuzz::catalog()).empty(), "there is a report");
  return 0;
}

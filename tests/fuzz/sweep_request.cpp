// The parser of sweeps takes any bytes; what it accepts has a canonical form that means the same,
// and each of its points is traced once.

#include "api/request/canonical.h"
#include "api/request/parse.h"
#include "api/request/sweep.h"
#include "tests/fuzz/requests.h"

using namespace translucube;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto parsed = api::parse_sweep_request(text, fuzz::catalog());
  if (!parsed) {
    fuzz::check(parsed.problem());
    return 0;
  }
  const auto& sweep = *parsed;
  const std::string canonical = api::canonical_json(sweep);
  const auto same = api::parse_sweep_request(canonical, fuzz::catalog());
  fuzz::require(same && *same == sweep, "the canonical form is the same sweep");
  fuzz::require(sweep.point_count() <= fuzz::catalog().limits.points, "the points are bounded");
  fuzz::require(!api::counts_json(sweep, fuzz::catalog().limits).empty(), "it can be counted");

  std::vector<int> traced(sweep.point_count());
  for (const auto& image : api::traced_images(sweep, fuzz::catalog().limits))
    for (const std::size_t point : image) ++traced.at(point);
  for (const int times : traced) fuzz::require(times == 1, "each point is traced once");
  // Any point will do: the last one.
  const api::RenderRequest point = api::point_request(sweep, sweep.point_count() - 1);
  const auto alone = api::parse_render_request(api::canonical_json(point), fuzz::catalog());
  fuzz::require(bool(alone), "a point is a render");
  return 0;
}

#include "server/store/submission.h"

#include "api/answer/material_report.h"
#include "api/request/canonical.h"
#include "api/request/parse.h"
#include "server/store/content.h"

namespace translucube::server {
namespace {

std::optional<std::uint32_t> total_samples(const api::RenderRequest& request) {
  const auto* target = std::get_if<SampleTarget>(&request.quality);
  return target ? std::optional(target->samples) : std::nullopt;
}

/// The lanes of each traced image. Where the quality says how many samples to take, a point has the
/// content of the same render alone; else the least absorbing point of its image decides.
std::vector<std::vector<Picture>> pictures_of(const api::Sweep& sweep,
                                              const api::Catalog& catalog) {
  const bool alone = total_samples(sweep.base).has_value();
  std::vector<std::vector<Picture>> images;
  for (const std::vector<std::size_t>& points : api::traced_images(sweep, catalog.limits)) {
    std::string first;
    std::vector<Picture>& lanes = images.emplace_back();
    for (const std::size_t point : points) {
      const api::RenderRequest request = api::point_request(sweep, point);
      const std::string canonical = api::canonical_json(request);
      lanes.push_back(
          {static_cast<std::uint32_t>(point), content_key(request, canonical, catalog, first)});
      if (first.empty() && !alone) first = canonical;
    }
  }
  return images;
}

}  // namespace

NewJob new_job(const api::RenderRequest& request, const api::Catalog& catalog,
               const std::optional<std::string>& idempotency_key) {
  std::string canonical = api::canonical_json(request);
  std::string content = content_key(request, canonical, catalog);
  return {std::move(canonical),   api::material_report(request, catalog), idempotency_key,
          total_samples(request), planned_pass(request, 0).value(),       std::move(content)};
}

NewSweep new_sweep(const api::Sweep& sweep, const api::Catalog& catalog,
                   const std::optional<std::string>& idempotency_key) {
  return {api::canonical_json(sweep), idempotency_key, total_samples(sweep.base),
          planned_pass(sweep.base, 0).value(), pictures_of(sweep, catalog)};
}

api::Result<api::RenderRequest> submitted_render(const std::string& canonical,
                                                 const api::Catalog& catalog) {
  return api::parse_render_request(canonical, api::without_limits(catalog));
}

api::Result<api::Sweep> submitted_sweep(const std::string& canonical, const api::Catalog& catalog) {
  return api::parse_sweep_request(canonical, api::without_limits(catalog));
}

std::optional<Pass> planned_pass(const api::RenderRequest& request, std::uint32_t index) {
  const auto pixels = std::uint64_t(request.width) * std::uint64_t(request.height);
  return plan_pass(index, pixels, total_samples(request));
}

}  // namespace translucube::server

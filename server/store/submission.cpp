#include "server/store/submission.h"

#include "api/answer/material_report.h"
#include "api/request/canonical.h"
#include "api/request/parse.h"
#include "server/base/ids.h"
#include "server/base/sha256.h"
#include "server/store/content.h"
#include "server/store/needs.h"

namespace translucube::server {
namespace {

std::optional<std::uint32_t> total_samples(const api::RenderRequest& request) {
  const auto* target = std::get_if<SampleTarget>(&request.quality);
  return target ? std::optional(target->samples) : std::nullopt;
}

/// An absorber as it stands in a key: a long spectrum by its hash, in a form that is no name, so
/// that the points of a sweep do not each carry, print and hash it whole.
api::AbsorberRequest short_absorber(const api::AbsorberRequest& absorber) {
  const auto* spectrum = std::get_if<SpectralAbsorber>(&absorber);
  if (spectrum == nullptr) return absorber;
  const auto hash_of = [](const std::vector<double>& values) {
    return hex(
        sha256({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)}));
  };
  return '@' + hash_of(spectrum->wavelengths_nm) + hash_of(spectrum->values);
}

std::string short_key(const api::RenderRequest& request, const api::Catalog& catalog,
                      std::string_view traced_with) {
  return content_key(request, api::canonical_json(request), catalog, traced_with);
}

/// The lanes of each traced image. Where the quality says how many samples to take, a point has the
/// content of the same render alone; else the least absorbing point of its image decides.
std::vector<std::vector<Picture>> pictures_of(const api::Sweep& whole,
                                              const api::Catalog& catalog) {
  api::Sweep sweep = whole;
  sweep.base.material.absorber = std::string();
  for (api::AbsorberRequest& absorber : sweep.absorbers) absorber = short_absorber(absorber);
  const bool alone = total_samples(sweep.base).has_value();
  std::vector<std::vector<Picture>> images;
  for (const std::vector<std::size_t>& points : api::traced_images(sweep, catalog.limits)) {
    std::string first;
    std::vector<Picture>& lanes = images.emplace_back();
    for (const std::size_t point : points) {
      const api::RenderRequest request = api::point_request(sweep, point);
      lanes.push_back({static_cast<std::uint32_t>(point), short_key(request, catalog, first)});
      if (first.empty() && !alone) first = api::canonical_json(request);
    }
  }
  return images;
}

}  // namespace

NewJob new_job(const api::RenderRequest& request, const api::Catalog& catalog,
               const std::optional<std::string>& idempotency_key) {
  std::string canonical = api::canonical_json(request);
  api::RenderRequest brief = request;
  brief.material.absorber = short_absorber(request.material.absorber);
  std::string content = short_key(brief, catalog, {});
  return {std::move(canonical),     api::material_report(request, catalog), idempotency_key,
          total_samples(request),   planned_pass(request, 0).value(),       std::move(content),
          picture_bytes(request, 1)};
}

NewSweep new_sweep(const api::Sweep& sweep, const api::Catalog& catalog,
                   const std::optional<std::string>& idempotency_key) {
  return {api::canonical_json(sweep),  idempotency_key,
          total_samples(sweep.base),   planned_pass(sweep.base, 0).value(),
          pictures_of(sweep, catalog), picture_bytes(sweep.base, 1)};
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

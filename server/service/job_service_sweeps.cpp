#include "api/base/text.h"
#include "api/request/canonical.h"
#include "api/request/sweep.h"
#include "server/pictures/sheet_artifact.h"
#include "server/service/job_service_parts.h"
#include "server/store/content.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;
using api::Result;

Problem no_such_sweep() { return {ProblemCode::not_found, "There is no sweep of this id.", {}}; }

Result<api::Sweep> parsed(const std::string& canonical, const api::Catalog& catalog) {
  return api::parse_sweep_request(canonical, api::without_limits(catalog));
}

/// The lanes of each traced image. Where the quality says how many samples to take, a point has the
/// content of the same render alone; else the least absorbing point of its image decides.
std::vector<std::vector<Picture>> pictures_of(const api::Sweep& sweep,
                                              const api::Catalog& catalog) {
  const bool alone = std::holds_alternative<SampleTarget>(sweep.base.quality);
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

Result<api::SweepStatus> status_of(const StoredSweep& stored, const JobStore& store,
                                   const api::Catalog& catalog) {
  auto sweep = parsed(stored.request, catalog);
  if (!sweep) return sweep.problem();
  api::SweepStatus status;
  status.id = stored.id;
  status.state = stored.state;
  status.created_at = rfc3339(stored.created_ms);
  if (stored.started_ms) status.started_at = rfc3339(*stored.started_ms);
  if (stored.finished_ms) status.finished_at = rfc3339(*stored.finished_ms);
  status.sweep = *std::move(sweep);
  for (SweepImageState& image : store.sweep_images(stored.id))
    status.images.push_back({std::move(image.points), image.state, std::move(image.stats),
                             std::move(image.error), image.cached});
  return status;
}

}  // namespace

Result<std::string> JobService::count_sweep(std::string_view document) const {
  const auto sweep = api::parse_sweep_request(document, catalog_);
  if (!sweep) return sweep.problem();
  return api::counts_json(*sweep, catalog_.limits);
}

Result<SweepSubmission> JobService::submit_sweep(
    std::string_view document, const std::optional<std::string>& idempotency_key) {
  if (const auto problem = refusal()) return *problem;
  auto request = api::parse_sweep_request(document, catalog_);
  if (!request) return request.problem();
  const auto& sweep = *request;

  NewSweep job;
  job.request = api::canonical_json(sweep);
  job.idempotency_key = idempotency_key;
  if (const auto* target = std::get_if<SampleTarget>(&sweep.base.quality))
    job.total_samples = target->samples;
  const std::uint64_t pixels = std::uint64_t(sweep.base.width) * std::uint64_t(sweep.base.height);
  job.first_pass = plan_pass(0, pixels, job.total_samples).value();
  job.images = pictures_of(sweep, catalog_);

  return guarded([&]() -> Result<SweepSubmission> {
    auto outcome = store_.submit(job);
    if (!outcome) return outcome.problem();
    const auto& submitted = *outcome;
    if (submitted.created) workers_->wake();
    auto status = status_of(submitted.stored, store_, catalog_);
    if (!status) return status.problem();
    for (const api::SweepImageStatus& image : status->images)
      if (submitted.created && image.cached) metrics_.count_cache_hit();
    return SweepSubmission{*std::move(status), submitted.created};
  });
}

Result<api::SweepStatus> JobService::get_sweep(const std::string& id) const {
  return guarded([&]() -> Result<api::SweepStatus> {
    const std::optional<StoredSweep> sweep = store_.find_sweep(id);
    if (!sweep) return no_such_sweep();
    return status_of(*sweep, store_, catalog_);
  });
}

Result<ToldText> JobService::tell_sweep(const std::string& id) const {
  const auto status = get_sweep(id);
  if (!status) return status.problem();
  return told(*status);
}

Result<SweepPage> JobService::list_sweeps(const ListQuery& query) const {
  const auto filter = page_filter(query);
  if (!filter) return filter.problem();
  return guarded([&]() -> Result<SweepPage> {
    std::vector<StoredSweep> sweeps = store_.list_sweeps(*filter);
    SweepPage page;
    page.next_cursor = cut_page(sweeps, query.limit);
    for (const StoredSweep& sweep : sweeps)
      page.sweeps.push_back(
          {sweep.id, sweep.state, rfc3339(sweep.created_ms),
           sweep.started_ms ? std::optional(rfc3339(*sweep.started_ms)) : std::nullopt,
           sweep.finished_ms ? std::optional(rfc3339(*sweep.finished_ms)) : std::nullopt,
           sweep.points, sweep.images});
    return page;
  });
}

Result<api::SweepStatus> JobService::cancel_sweep(const std::string& id) {
  return guarded([&]() -> Result<api::SweepStatus> {
    if (!store_.find_sweep(id)) return no_such_sweep();
    store_.cancel(id);
    const std::optional<StoredSweep> sweep = store_.find_sweep(id);
    if (!sweep) return no_such_sweep();
    if (sweep->state == api::JobState::canceled) {
      for (const SweepImageState& image : store_.sweep_images(id)) {
        if (image.state != api::JobState::canceled) continue;
        workers_->stop_job(image.job_id);
        discard_files(image.job_id);
      }
      changed();
    }
    return status_of(*sweep, store_, catalog_);
  });
}

std::optional<Problem> JobService::remove_sweep(const std::string& id) {
  struct Removed {
    std::vector<SweepImageState> images;
    std::vector<StoredResult> unused;
  };
  const auto result = guarded([&]() -> Result<Removed> {
    const std::vector<SweepImageState> images = store_.sweep_images(id);
    if (!store_.find_sweep(id)) return no_such_sweep();
    const auto unused = store_.remove(id);
    if (!unused) return no_such_sweep();
    return Removed{images, *unused};
  });
  if (!result) return result.problem();
  const auto& [images, unused] = *result;
  for (const SweepImageState& image : images) {
    workers_->stop_job(image.job_id);
    discard_files(image.job_id);
  }
  for (const StoredResult& result_of_it : unused) discard_result(result_of_it);
  discard_files(id);
  changed();
  return std::nullopt;
}

Result<ImageFile> JobService::point_image(const std::string& id, const std::string& point,
                                          const ImageQuery& query) {
  return guarded([&]() -> Result<ImageFile> {
    const std::optional<StoredSweep> stored = store_.find_sweep(id);
    if (!stored) return no_such_sweep();
    const auto number = api::number_of<std::uint32_t>(point);
    const auto picture = number ? store_.picture_of_point(id, *number) : std::nullopt;
    if (!picture) return Problem{ProblemCode::not_found, "The sweep has no such point.", {}};
    if (auto problem = no_picture(picture->state)) return std::move(*problem);
    const auto sweep = parsed(stored->request, catalog_);
    if (!sweep) return sweep.problem();
    return image_artifact(darkroom_, picture->content,
                          api::canonical_json(api::point_request(*sweep, *number)), query);
  });
}

Result<ImageFile> JobService::sheet(const std::string& id, const ImageQuery& query) {
  return guarded([&]() -> Result<ImageFile> {
    const auto status = get_sweep(id);
    if (!status) return status.problem();
    return sheet_artifact(darkroom_, *status, query);
  });
}

}  // namespace translucube::server

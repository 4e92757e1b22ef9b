#include <algorithm>

#include "api/base/text.h"
#include "api/request/canonical.h"
#include "api/request/sweep.h"
#include "server/pictures/sheet_artifact.h"
#include "server/service/answers.h"
#include "server/service/job_service.h"
#include "server/store/submission.h"
#include "server/store/upload_store.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;
using api::Result;

Problem no_such_sweep() { return {ProblemCode::not_found, "There is no sweep of this id.", {}}; }

Result<api::SweepStatus> status_of(const StoredSweep& stored, const JobStore& store,
                                   const api::Catalog& catalog) {
  auto sweep = submitted_sweep(stored.request, catalog);
  if (!sweep) return sweep.problem();
  auto status = status_from<api::SweepStatus>(stored);
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
  const auto request = api::parse_sweep_request(document, catalog_);
  if (!request) return request.problem();
  const NewSweep sweep = new_sweep(*request, catalog_, idempotency_key);
  const std::size_t most_lanes =
      std::ranges::max(sweep.images, {}, &std::vector<Picture>::size).size();
  if (const auto problem = too_large(request->base, most_lanes, "/base/image")) return *problem;
  for (const auto& file : api::uploads_of(request->base, catalog_)) touch_upload(file);
  return guarded([&]() -> Result<SweepSubmission> {
    if (const auto problem = no_room(request->point_count() * sweep.picture_bytes)) return *problem;
    for (const std::vector<Picture>& lanes : sweep.images)
      for (const Picture& lane : lanes)
        whole_result(store_, darkroom_.artifacts, lane.content, Look::quick);
    const auto outcome = store_.submit(sweep);
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

Result<ToldText> JobService::tell_sweep(const std::string& id) {
  const auto moment = moment_of_sweep(id);
  if (!moment) return moment.problem();
  // One at a time: a sweep of many points is long, and who waits for this finds it told.
  const std::lock_guard lock(telling_);
  if (auto known = told_sweeps_.find({id, moment->version})) return std::move(*known);
  const auto now = told_sweeps_.now();
  const auto status = get_sweep(id);
  if (!status) return status.problem();
  ToldText text = told(*status);
  told_sweeps_.keep({id, moment->version}, text, now);
  return text;
}

Result<Moment> JobService::moment_of_sweep(const std::string& id) const {
  return guarded([&]() -> Result<Moment> {
    // The event first: what comes after it is seen next time.
    const std::uint64_t event = store_.last_event(id);
    const std::optional<StoredSweep> sweep = store_.find_sweep(id);
    if (!sweep) return no_such_sweep();
    return Moment{sweep->state, std::to_string(event)};
  });
}

Result<SweepPage> JobService::list_sweeps(const ListQuery& query) const {
  const auto filter = page_filter(query);
  if (!filter) return filter.problem();
  return guarded([&]() -> Result<SweepPage> {
    std::vector<StoredSweep> sweeps = store_.list_sweeps(*filter);
    SweepPage page;
    page.next_cursor = cut_page(sweeps, query.limit);
    for (const StoredSweep& sweep : sweeps) {
      page.sweeps.push_back(status_from<api::SweepSummary>(sweep));
      page.sweeps.back().points = sweep.points;
      page.sweeps.back().traced_images = sweep.images;
    }
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
      for (const SweepImageState& image : store_.sweep_images(id))
        if (image.state == api::JobState::canceled) stop_work(image.job_id);
      changes_.tell();
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
  for (const SweepImageState& image : images) stop_work(image.job_id);
  discard(unused);
  janitor_.discard(id);
  changes_.tell();
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
    const auto sweep = submitted_sweep(stored->request, catalog_);
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

Result<JobService::Events> JobService::events_of_sweep(const std::string& id,
                                                       std::uint64_t after) const {
  return guarded([&]() -> Result<Events> {
    const std::optional<StoredSweep> sweep = store_.find_sweep(id);
    if (!sweep) return no_such_sweep();
    return Events{store_.events_after(id, after), api::is_end(sweep->state)};
  });
}

}  // namespace translucube::server

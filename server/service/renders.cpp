#include "api/request/parse.h"
#include "server/pictures/developed_image.h"
#include "server/service/answers.h"
#include "server/service/job_service.h"
#include "server/store/submission.h"
#include "server/store/upload_store.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;
using api::Result;

// A file that is held open takes its place on the disk though it be removed.
constexpr std::uint64_t largest_at_hand = 1 << 20;

Problem no_such_render() { return {ProblemCode::not_found, "There is no render of this id.", {}}; }

api::RenderStatus status_of(const Job& job) {
  auto status = status_from<api::RenderStatus>(job);
  status.progress = job.progress;
  status.request = job.request;
  status.material = job.material;
  status.stats = job.stats;
  status.error = job.error;
  status.cached = job.cached;
  return status;
}

/// An image of a sweep is no render.
std::optional<Job> find_render(const JobStore& store, const std::string& id) {
  std::optional<Job> job = store.find(id);
  return job && !job->sweep_image ? job : std::nullopt;
}

}  // namespace

Result<Submission> JobService::submit(std::string_view document,
                                      const std::optional<std::string>& idempotency_key) {
  if (const auto problem = refusal()) return *problem;
  const auto request = api::parse_render_request(document, catalog_);
  if (!request) return request.problem();
  if (const auto problem = too_large(*request, 1, "/image")) return *problem;
  for (const auto& file : api::uploads_of(*request, catalog_)) touch_upload(file);
  const NewJob job = new_job(*request, catalog_, idempotency_key);
  return guarded([&]() -> Result<Submission> {
    if (const auto problem = no_room(job.picture_bytes)) return *problem;
    whole_result(store_, darkroom_.artifacts, job.content, Look::quick);
    const auto outcome = store_.submit(job);
    if (!outcome) return outcome.problem();
    const auto& submitted = *outcome;
    if (submitted.created) {
      if (submitted.stored.cached)
        metrics_.count_cache_hit();
      else
        metrics_.count_cache_miss();
      workers_->wake();
    }
    return Submission{status_of(submitted.stored), submitted.created};
  });
}

Result<api::RenderStatus> JobService::get(const std::string& id) const {
  return guarded([&]() -> Result<api::RenderStatus> {
    const std::optional<Job> job = find_render(store_, id);
    if (!job) return no_such_render();
    return status_of(*job);
  });
}

Result<ToldText> JobService::tell(const std::string& id) {
  if (auto known = ended_.find(id)) return std::move(*known);
  const auto now = ended_.now();
  const auto status = get(id);
  if (!status) return status.problem();
  ToldText text = told(*status);
  if (api::is_end(text->state)) ended_.keep(id, text, now);
  return text;
}

Result<Moment> JobService::moment(const std::string& id) {
  const auto text = tell(id);
  if (!text) return text.problem();
  return Moment{(*text)->state, (*text)->etag};
}

Result<RenderPage> JobService::list(const ListQuery& query) const {
  const auto filter = page_filter(query);
  if (!filter) return filter.problem();
  return guarded([&]() -> Result<RenderPage> {
    std::vector<Job> jobs = store_.list(*filter);
    RenderPage page;
    page.next_cursor = cut_page(jobs, query.limit);
    for (const Job& job : jobs) page.renders.push_back(status_of(job));
    return page;
  });
}

Result<api::RenderStatus> JobService::cancel(const std::string& id) {
  return guarded([&]() -> Result<api::RenderStatus> {
    if (!find_render(store_, id)) return no_such_render();
    store_.cancel(id);
    const std::optional<Job> job = store_.find(id);
    if (!job) return no_such_render();
    if (job->state == api::JobState::canceled) {
      stop_work(id);
      changes_.tell();
    }
    return status_of(*job);
  });
}

std::optional<Problem> JobService::remove(const std::string& id) {
  using Unused = std::vector<StoredResult>;
  const auto unused = guarded([&]() -> Result<Unused> {
    if (!find_render(store_, id)) return no_such_render();
    std::optional<Unused> results = store_.remove(id);
    if (!results) return no_such_render();
    return *std::move(results);
  });
  if (!unused) return unused.problem();
  ended_.forget();
  stop_work(id);
  discard(*unused);
  changes_.tell();
  return std::nullopt;
}

Result<ImageFile> JobService::image(const std::string& id, const ImageQuery& query) {
  if (auto known = pictures_.find({id, query}); known && known->file->is_as_opened())
    return std::move(*known);
  const auto now = pictures_.now();
  auto made = guarded([&]() -> Result<ImageFile> {
    const std::optional<Job> job = find_render(store_, id);
    if (!job) return no_such_render();
    if (query.partial && !api::is_end(job->state))
      if (const auto live = live_films_.find(id)) {
        auto partial = partial_image(darkroom_, *live, id, job->request, query);
        if (partial) return std::move(*partial);
      }
    if (auto problem = no_picture(job->state)) return std::move(*problem);
    return image_artifact(darkroom_, store_.pictures(id).at(0).content, job->request, query);
  });
  // Removed while it was read: then that is the answer.
  if (!made && made.problem().code == ProblemCode::gone && !store_.find(id))
    return no_such_render();
  // Perhaps for want of a descriptor: those that are held open give way.
  if (!made && made.problem().code == ProblemCode::storage_failure) pictures_.forget();
  if (made && made->file->size() <= largest_at_hand) pictures_.keep({id, query}, *made, now);
  return made;
}

Result<JobService::Events> JobService::events_of_render(const std::string& id,
                                                        std::uint64_t after) const {
  return guarded([&]() -> Result<Events> {
    // The state first: events that come after it are told next time.
    const std::optional<Job> job = find_render(store_, id);
    if (!job) return no_such_render();
    return Events{store_.events_after(id, after), api::is_end(job->state)};
  });
}

}  // namespace translucube::server

#include "server/worker/traced_job.h"

#include "api/request/canonical.h"
#include "api/request/parse.h"
#include "api/request/sweep.h"

namespace translucube::server {

api::Result<TracedJob> traced_job(const Job& job, const JobStore& store,
                                  const api::Catalog& current) {
  const api::Catalog catalog = api::without_limits(current);
  TracedJob traced;
  const std::vector<Picture> lanes = store.pictures(job.id);
  for (const Picture& lane : lanes) traced.contents.push_back(lane.content);
  if (!job.sweep_image) {
    auto parsed = api::parse_render_request(job.request, catalog);
    if (!parsed) return parsed.problem();
    traced.requests = {*std::move(parsed)};
    traced.canonical = {job.request};
  } else {
    const std::optional<StoredSweep> stored = store.find_sweep(job.sweep_image->sweep_id);
    auto parsed = api::parse_sweep_request(stored ? stored->request : "", catalog);
    if (!parsed) return parsed.problem();
    const auto& sweep = *parsed;
    for (const Picture& lane : lanes) {
      if (lane.point >= sweep.point_count()) break;
      traced.requests.push_back(api::point_request(sweep, lane.point));
      traced.canonical.push_back(api::canonical_json(traced.requests.back()));
    }
  }
  if (traced.requests.empty() || traced.requests.size() != traced.contents.size())
    return api::Problem{api::ProblemCode::internal, "The request of the render is lost.", {}};
  return traced;
}

}  // namespace translucube::server

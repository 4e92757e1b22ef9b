#include "server/worker/traced_job.h"

#include "api/request/canonical.h"
#include "api/request/parse.h"

namespace translucube::server {

api::Result<TracedJob> traced_job(const Job& job, const JobStore& store,
                                  const api::Catalog& catalog) {
  TracedJob traced;
  const std::vector<Picture> lanes = store.pictures(job.id);
  for (const Picture& lane : lanes) traced.contents.push_back(lane.content);
  if (!job.sweep_image) {
    auto request = submitted_render(job.request, catalog);
    if (!request) return request.problem();
    traced.requests = {*std::move(request)};
    traced.canonical = {job.request};
  } else {
    const std::optional<StoredSweep> stored = store.find_sweep(job.sweep_image->sweep_id);
    const auto sweep = submitted_sweep(stored ? stored->request : "", catalog);
    if (!sweep) return sweep.problem();
    for (const Picture& lane : lanes) {
      if (lane.point >= sweep->point_count()) break;
      traced.requests.push_back(api::point_request(*sweep, lane.point));
      traced.canonical.push_back(api::canonical_json(traced.requests.back()));
    }
  }
  if (traced.requests.empty() || traced.requests.size() != traced.contents.size())
    return api::Problem{api::ProblemCode::internal, "The request of the render is lost.", {}};
  return traced;
}

}  // namespace translucube::server

#pragma once

#include <string>
#include <vector>

#include "api/base/result.h"
#include "api/request/catalog.h"
#include "server/store/job_store.h"
#include "server/store/submission.h"

namespace translucube::server {

/// A job as the renderer sees it: the requests whose pictures are the lanes of its one film. A
/// render has one; an image of a sweep one for each of its points. Never empty.
struct TracedJob {
  std::vector<api::RenderRequest> requests;
  std::vector<std::string> canonical;  ///< of each
  std::vector<std::string> contents;   ///< of each: where its picture goes

  const Quality& quality() const { return requests.front().quality; }
  std::optional<Pass> pass(std::uint32_t index) const {
    return planned_pass(requests.front(), index);
  }
};

/// A problem where what the job names has gone since it was accepted. Throws StoreError.
api::Result<TracedJob> traced_job(const Job& job, const JobStore& store,
                                  const api::Catalog& catalog);

}  // namespace translucube::server

#pragma once

// From a request to what the store keeps of it, and back. Whoever works on an accepted request or
// answers for it reads it again from its canonical text, in this process or in a later one: there
// is no second way by which a request could reach a worker.

#include <optional>
#include <string>

#include "api/base/result.h"
#include "api/request/catalog.h"
#include "api/request/sweep.h"
#include "server/store/job.h"

namespace translucube::server {

NewJob new_job(const api::RenderRequest& request, const api::Catalog& catalog,
               const std::optional<std::string>& idempotency_key);
NewSweep new_sweep(const api::Sweep& sweep, const api::Catalog& catalog,
                   const std::optional<std::string>& idempotency_key);

/// What was submitted and accepted stays legal, whatever the limits are now. A problem where what
/// it names has gone since.
api::Result<api::RenderRequest> submitted_render(const std::string& canonical,
                                                 const api::Catalog& catalog);
api::Result<api::Sweep> submitted_sweep(const std::string& canonical, const api::Catalog& catalog);

/// The pass of this index of the request's image; empty past the last one.
std::optional<Pass> planned_pass(const api::RenderRequest& request, std::uint32_t index);

}  // namespace translucube::server

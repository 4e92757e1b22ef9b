#pragma once

// What the parts of the job store (job_store*.cpp) share: rows as values, and small statements.

#include "api/answer/event.h"
#include "server/store/job_store.h"
#include "server/store/refusals.h"
#include "server/store/sqlite/job_store_sqlite.h"

namespace translucube::server::rows {

inline constexpr const char* select_job =
    "SELECT id, state, request, material, created_ms, started_ms, finished_ms, passes, samples, "
    "total_samples, relative_error, seconds, eta_seconds, stats, error, cached, sweep_id, "
    "image_index FROM jobs ";
/// Of a row of `select_job`. Throws StoreError where it is none of ours.
Job job_of(const sql::Statement& row);

std::string text(api::JobState state);
api::JobState state_of(const std::string& name);

void insert_task(sql::Connection& writer, const std::string& job_id, const Pass& pass,
                 Priority priority);
void delete_open_tasks(sql::Connection& writer, const std::string& job_id);
std::vector<std::string> contents_of(sql::Connection& writer, const std::string& where,
                                     const std::string& id);

/// The points of a sweep in each state.
api::StateCounts point_counts(sql::Connection& connection, const std::string& sweep_id);

using Lock = std::lock_guard<std::mutex>;

}  // namespace translucube::server::rows

#pragma once

// What the service does, free of HTTP: the routes call this and nothing below it.

#include <chrono>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "api/catalog.h"
#include "api/problem.h"
#include "api/render_status.h"
#include "renderer/color.h"
#include "server/artifact_store.h"
#include "server/image_artifacts.h"
#include "server/job_store.h"
#include "server/worker.h"

namespace translucube::server {

template <typename T>
using Result = std::variant<T, api::Problem>;

struct Submission {
  api::RenderStatus status;
  bool created = false;  ///< false: the idempotency key named it already
};

struct RenderPage {
  std::vector<api::RenderStatus> renders;
  std::optional<std::string> next_cursor;
};

struct ListQuery {
  std::optional<api::JobState> state;
  std::optional<std::string> cursor;
  int limit = 50;
};

/// Accepts, reports, cancels and removes renders, and owns the workers that trace them. Safe to
/// share by threads. The catalog, colours and stores outlive it.
class JobService {
 public:
  JobService(const api::Catalog& catalog, const ColorConfig& colors, JobStore& store,
             ArtifactStore& artifacts, Engine engine = {});
  ~JobService();

  Result<Submission> submit(std::string_view document,
                            const std::optional<std::string>& idempotency_key);
  Result<api::RenderStatus> get(const std::string& id) const;
  Result<RenderPage> list(const ListQuery& query) const;
  /// A render that has ended stays as it ended.
  Result<api::RenderStatus> cancel(const std::string& id);
  /// Cancels if needed and removes all data.
  std::optional<api::Problem> remove(const std::string& id);
  /// The status at the render's end, or when the time is over or the service stops.
  Result<api::RenderStatus> wait(const std::string& id, std::chrono::milliseconds time);
  Result<ImageFile> image(const std::string& id, const ImageQuery& query);

  /// Empty if the service can take work, else the reason why not.
  std::optional<std::string> unready_reason();

  /// Refuses new work, ends all waiting, stops the workers at their next tile and gives their tasks
  /// back to the store.
  void shut_down();

 private:
  std::optional<api::Problem> refusal() const;
  void clean_artifacts();
  void discard_files(const std::string& id);
  void changed();

  const api::Catalog& catalog_;
  const ColorConfig& colors_;
  JobStore& store_;
  ArtifactStore& artifacts_;

  mutable std::mutex mutex_;
  std::condition_variable change_;
  std::uint64_t changes_ = 0;
  bool stopping_ = false;

  std::mutex probe_mutex_;
  std::chrono::steady_clock::time_point probed_at_{};
  std::optional<std::string> probe_failure_;

  Darkroom darkroom_;
  std::unique_ptr<WorkerPool> workers_;
};

}  // namespace translucube::server

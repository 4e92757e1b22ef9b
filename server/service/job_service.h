#pragma once

// The room of what can be asked of the service, free of HTTP: it turns documents and ids of clients
// into work and answers. Calls come in here and nowhere below; how a request travels, and how a
// picture is traced, stays out.

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "api/answer/render_status.h"
#include "api/answer/sweep_status.h"
#include "api/base/result.h"
#include "api/request/catalog.h"
#include "picture/color.h"
#include "server/base/ids.h"
#include "server/base/recent.h"
#include "server/base/server_config.h"
#include "server/pictures/explorable_cache.h"
#include "server/pictures/image_artifacts.h"
#include "server/pictures/live_films.h"
#include "server/service/changes.h"
#include "server/service/disk_probe.h"
#include "server/service/janitor.h"
#include "server/service/page.h"
#include "server/store/artifact_store.h"
#include "server/store/data_folder.h"
#include "server/store/job_store.h"
#include "server/worker/worker_pool.h"

namespace translucube::server {

template <typename Status>
struct SubmissionOf {
  Status status;
  bool created = false;  ///< false: the idempotency key named it already
};
using Submission = SubmissionOf<api::RenderStatus>;
using SweepSubmission = SubmissionOf<api::SweepStatus>;

/// The state of a render or sweep, as a client is told it.
struct Told {
  api::JobState state = api::JobState::queued;
  std::string json, etag;
};
using ToldText = std::shared_ptr<const Told>;
template <typename Status>
ToldText told(const Status& status) {
  std::string json = to_json(status);
  std::string etag = '"' + content_hash(json) + '"';
  return std::make_shared<const Told>(Told{status.state, std::move(json), std::move(etag)});
}

/// What tells cheaply whether a render or sweep has ended or changed.
struct Moment {
  api::JobState state = api::JobState::queued;
  std::string version;  ///< another one after each change
};

struct RenderPage {
  std::vector<api::RenderStatus> renders;
  std::optional<std::string> next_cursor;
};
struct SweepPage {
  std::vector<api::SweepSummary> sweeps;
  std::optional<std::string> next_cursor;
};

/// Accepts, reports, cancels and removes renders and sweeps, and owns the workers that trace them.
/// Safe to share by threads. The catalog, config, colours, stores, folder and metrics outlive it.
class JobService {
 public:
  JobService(const api::Catalog& catalog, const ServerConfig& config, const ColorConfig& colors,
             JobStore& store, ArtifactStore& artifacts, const DataFolder& folder, Metrics& metrics,
             Engine engine = renderer_engine());
  ~JobService();

  // Renders (renders.cpp).
  api::Result<Submission> submit(std::string_view document,
                                 const std::optional<std::string>& idempotency_key);
  api::Result<api::RenderStatus> get(const std::string& id) const;
  /// `get` as text, without a look into the store where the render has ended and was asked for.
  api::Result<ToldText> tell(const std::string& id);
  api::Result<Moment> moment(const std::string& id);
  api::Result<RenderPage> list(const ListQuery& query) const;
  /// A render that has ended stays as it ended.
  api::Result<api::RenderStatus> cancel(const std::string& id);
  /// Cancels if needed and removes all data.
  std::optional<api::Problem> remove(const std::string& id);
  api::Result<ImageFile> image(const std::string& id, const ImageQuery& query);
  /// Samples of what `image` with `partial` shows of a render that is being traced; 0: nothing.
  std::uint32_t samples_to_see(const std::string& id) const { return live_films_.samples(id); }

  // Sweeps (sweeps.cpp).
  /// What a dry run answers, JSON text.
  api::Result<std::string> count_sweep(std::string_view document) const;
  api::Result<SweepSubmission> submit_sweep(std::string_view document,
                                            const std::optional<std::string>& idempotency_key);
  api::Result<api::SweepStatus> get_sweep(const std::string& id) const;
  /// `get_sweep` as text, made once for all who ask until the sweep changes.
  api::Result<ToldText> tell_sweep(const std::string& id);
  api::Result<Moment> moment_of_sweep(const std::string& id) const;
  api::Result<SweepPage> list_sweeps(const ListQuery& query) const;
  api::Result<api::SweepStatus> cancel_sweep(const std::string& id);
  std::optional<api::Problem> remove_sweep(const std::string& id);
  /// `point`: a client's text.
  api::Result<ImageFile> point_image(const std::string& id, const std::string& point,
                                     const ImageQuery& query);

  /// The contact sheet, of what is there so far.
  api::Result<ImageFile> sheet(const std::string& id, const ImageQuery& query);

  // Watching.
  /// Those after `number`, and whether the last of them is the end of the render or sweep.
  struct Events {
    std::vector<Event> events;
    bool ended = false;
  };
  api::Result<Events> events_of_render(const std::string& id, std::uint64_t after) const;
  api::Result<Events> events_of_sweep(const std::string& id, std::uint64_t after) const;
  /// Ended with the service.
  Changes& changes() { return changes_; }

  /// Empty if the service can take work, else the reason why not.
  std::optional<std::string> unready_reason();

  /// For /metrics.
  struct Figures {
    ArtifactStore::Figures artifacts;
    std::uint64_t set_back = 0;  ///< jobs that wait for the world
  };
  Figures figures() const { return {darkroom_.artifacts.figures(), setbacks_.count()}; }

  /// Refuses new work and ends all waiting. Passes under way may take `drain` to end, so that they
  /// are kept; then stops the workers at their next tile and gives their tasks back to the store.
  void shut_down(std::chrono::milliseconds drain = {});

 private:
  std::optional<api::Problem> refusal() const;
  std::optional<api::Problem> no_room(std::uint64_t picture_bytes);
  std::optional<api::Problem> too_large(const api::RenderRequest& request, std::uint64_t lanes,
                                        const char* pointer) const;
  Intake intake(int others) const;
  void keep_house(std::stop_token ended);
  void stop_work(const std::string& job_id);
  void discard(const std::vector<StoredResult>& unused);

  const api::Catalog& catalog_;
  const ServerConfig& config_;
  JobStore& store_;
  const DataFolder& folder_;
  Metrics& metrics_;
  Changes changes_;
  Janitor janitor_;
  DiskProbe probe_;
  LiveFilms live_films_;
  ExplorableCache explorables_;
  Darkroom darkroom_;
  // What is asked again and again. A render that has ended stays as it is until it is removed; of a
  // picture, it is seen once in a while that it still lies there, and is used.
  Recent<std::string, ToldText> ended_{4096};
  Recent<std::pair<std::string, ImageQuery>, ImageFile> pictures_;
  Recent<std::pair<std::string, std::string>, ToldText> told_sweeps_{8};  // by id and version
  std::mutex telling_;
  Setbacks setbacks_;
  MemoryBudget memory_;
  std::atomic<std::uint64_t> room_ = 0;  ///< on the disk, for a job that is worked on
  std::unique_ptr<WorkerPool> workers_;
  std::jthread house_keeper_;
};

}  // namespace translucube::server

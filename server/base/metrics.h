#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace translucube::server {

/// What the store holds at the moment of a scrape.
struct StoreGauges {
  std::map<std::string, std::uint64_t> renders;          ///< by state; images of sweeps among them
  std::map<std::string, std::uint64_t> sweeps;           ///< by state
  std::map<std::string, std::uint64_t> tasks;            ///< that wait, by priority
  std::uint64_t queue_depth = 0;                         ///< renders that wait for a worker
  double oldest_queued_age_s = 0;                        ///< 0 where none waits
  std::uint64_t results = 0, result_bytes = 0;           ///< finished pictures that are kept
  std::uint64_t artifact_bytes = 0;                      ///< all files: films and sheets too
  std::uint64_t upload_bytes = 0;                        ///< as the quota counts them
  std::uint64_t unknown_folders = 0, unknown_bytes = 0;  ///< that the store does not know
  std::uint64_t damaged_files = 0;                       ///< found since the start
  std::uint64_t set_back = 0;                            ///< renders that wait for the world
  std::uint64_t lost_log_lines = 0;                      ///< since the start
};

/// What one pass over an image did.
struct PassFigures {
  double seconds = 0;
  std::uint64_t camera_samples = 0;
  std::uint64_t path_events = 0;  ///< flights, boundary events and connections
  std::uint64_t nan_samples = 0;
};

/// The service's own figures for Prometheus. Safe to share by threads; counting takes no lock that
/// a scrape holds for long.
class Metrics {
 public:
  Metrics();
  ~Metrics();
  Metrics(const Metrics&) = delete;
  Metrics& operator=(const Metrics&) = delete;

  /// `route` is a pattern such as /v1/renders/{id}, so that its values are few.
  void count_request(std::string_view method, std::string_view route, int status, double seconds);
  /// An event stream is open as long as the value lives, which must end before the metrics do.
  std::shared_ptr<void> open_stream();

  void count_pass(const PassFigures& pass);
  void count_render(double seconds);  ///< from its first pass to its image
  void count_cache_hit();             ///< a request answered by what was rendered before
  void count_cache_miss();
  void count_traced_image();     ///< an image that cost paths
  void count_developed_image();  ///< an image developed from paths traced before

  /// Asked at each scrape. A callback that throws leaves its gauges out.
  void set_store_gauges(std::function<StoreGauges()> gauges);

  /// Prometheus text format 0.0.4.
  std::string text() const;
  static constexpr const char* content_type = "text/plain; version=0.0.4; charset=utf-8";

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace translucube::server

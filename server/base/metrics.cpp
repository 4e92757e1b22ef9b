#include "server/base/metrics.h"

#include <prometheus/counter.h>
#include <prometheus/gauge.h>
#include <prometheus/histogram.h>
#include <prometheus/registry.h>
#include <prometheus/text_serializer.h>
#include <spdlog/spdlog.h>

#include <iterator>
#include <map>
#include <mutex>
#include <sstream>
#include <tuple>
#include <vector>

#include "picture/version.h"

namespace translucube::server {
namespace {

using prometheus::BuildCounter;
using prometheus::BuildGauge;
using prometheus::BuildHistogram;
using prometheus::Counter;
using prometheus::Family;
using prometheus::Gauge;
using prometheus::Histogram;
using prometheus::MetricFamily;
using prometheus::Registry;

// [s]
const Histogram::BucketBoundaries request_buckets{.0005, .001, .0025, .005, .01, .025, .05, .1,
                                                  .25,   .5,   1,     2.5,  5,   10,   30,  60};
const Histogram::BucketBoundaries render_buckets{.01, .025, .05, .1, .25, .5,  1,   2.5,
                                                 5,   10,   25,  60, 150, 300, 900, 3600};

Family<Counter>& counters(Registry& registry, const char* name, const char* help) {
  return BuildCounter().Name(name).Help(help).Register(registry);
}

Family<Histogram>& histograms(Registry& registry, const char* name, const char* help) {
  return BuildHistogram().Name(name).Help(help).Register(registry);
}

void add_gauge(std::vector<MetricFamily>& all, const char* name, const char* help,
               const char* label, const std::map<std::string, std::uint64_t>& counts) {
  MetricFamily family{name, help, prometheus::MetricType::Gauge, {}};
  for (const auto& [value, count] : counts) {
    prometheus::ClientMetric metric;
    metric.label.push_back({label, value});
    metric.gauge.value = static_cast<double>(count);
    family.metric.push_back(std::move(metric));
  }
  all.push_back(std::move(family));
}

void add_gauge(std::vector<MetricFamily>& all, const char* name, const char* help, double value) {
  prometheus::ClientMetric metric;
  metric.gauge.value = value;
  all.push_back({name, help, prometheus::MetricType::Gauge, {metric}});
}

}  // namespace

struct Metrics::Impl {
  Registry registry;
  Family<Counter>& requests =
      counters(registry, "translucube_http_requests_total",
               "HTTP requests answered, by method, route pattern and status.");
  Family<Histogram>& request_seconds =
      histograms(registry, "translucube_http_request_duration_seconds",
                 "Time from the headers of a request to the last byte of its answer, by method and "
                 "route pattern; waits and event streams count to their end.");
  Gauge& streams = BuildGauge()
                       .Name("translucube_event_streams_open")
                       .Help("Event streams that clients listen to.")
                       .Register(registry)
                       .Add({});
  Histogram& pass_seconds = histograms(registry, "translucube_pass_duration_seconds",
                                       "Time that a pass over an image took to trace.")
                                .Add({}, render_buckets);
  Histogram& render_seconds =
      histograms(registry, "translucube_render_duration_seconds",
                 "Time from the first pass of a render to its stored image.")
          .Add({}, render_buckets);
  Counter& camera_samples = counters(registry, "translucube_camera_samples_total",
                                     "Samples of pixels traced: one camera ray each.")
                                .Add({});
  Counter& path_events = counters(registry, "translucube_path_events_total",
                                  "Events of light paths: flights inside bodies, boundary events "
                                  "and connections to the environment.")
                             .Add({});
  Counter& nan_samples = counters(registry, "translucube_nan_samples_total",
                                  "Samples that were no finite number: a fault of the renderer.")
                             .Add({});
  Family<Counter>& lookups =
      counters(registry, "translucube_cache_lookups_total",
               "Requests looked up among the results of earlier ones, by result.");
  Counter& hits = lookups.Add({{"result", "hit"}});
  Counter& misses = lookups.Add({{"result", "miss"}});
  Family<Counter>& images =
      counters(registry, "translucube_images_total",
               "Images made, by origin: traced, or developed from paths traced before.");
  Counter& traced = images.Add({{"origin", "traced"}});
  Counter& developed = images.Add({{"origin", "developed"}});

  struct OfRequest {
    Counter& count;
    Histogram& seconds;
  };
  /// The figures by method, route and status: the registry's look-up builds texts and hashes them.
  std::map<std::tuple<std::string, std::string, int>, OfRequest, std::less<>> of_requests;
  std::mutex of_requests_mutex;

  OfRequest of_request(std::string_view method, std::string_view route, int status) {
    const std::lock_guard lock(of_requests_mutex);
    const auto known = of_requests.find(std::tuple(method, route, status));
    if (known != of_requests.end()) return known->second;
    const std::string a(method), b(route);
    const OfRequest made{
        requests.Add({{"method", a}, {"route", b}, {"status", std::to_string(status)}}),
        request_seconds.Add({{"method", a}, {"route", b}}, request_buckets)};
    return of_requests.emplace(std::tuple(a, b, status), made).first->second;
  }

  std::mutex mutex;
  std::function<StoreGauges()> store_gauges;

  void add_store_gauges(std::vector<MetricFamily>& all) {
    std::function<StoreGauges()> ask;
    {
      const std::lock_guard lock(mutex);
      ask = store_gauges;
    }
    if (!ask) return;
    StoreGauges store;
    try {
      store = ask();
    } catch (const std::exception& error) {
      spdlog::error("the store's figures are missing from a scrape: {}", error.what());
      return;
    }
    add_gauge(all, "translucube_renders", "Renders and traced images of sweeps, by state.", "state",
              store.renders);
    add_gauge(all, "translucube_sweeps", "Sweeps, by state.", "state", store.sweeps);
    add_gauge(all, "translucube_tasks_waiting", "Passes that wait for a worker, by priority.",
              "priority", store.tasks);
    add_gauge(all, "translucube_results", "Finished pictures that are kept.",
              static_cast<double>(store.results));
    add_gauge(all, "translucube_result_bytes", "What they take on the disk.",
              static_cast<double>(store.result_bytes));
    add_gauge(
        all, "translucube_artifact_bytes",
        "What all files take on the disk that artifact_bytes bounds: pictures, what is derived "
        "of them, sheets of sweeps, films of renders under way.",
        static_cast<double>(store.artifact_bytes));
    add_gauge(all, "translucube_upload_bytes", "What uploads take of upload_quota_bytes.",
              static_cast<double>(store.upload_bytes));
    add_gauge(all, "translucube_unknown_folders",
              "Folders of files that the job store did not know at the start, left as they are.",
              static_cast<double>(store.unknown_folders));
    add_gauge(all, "translucube_unknown_bytes", "What they take on the disk.",
              static_cast<double>(store.unknown_bytes));
    add_gauge(all, "translucube_damaged_files",
              "Files whose bytes were found changed since the start; kept aside.",
              static_cast<double>(store.damaged_files));
    add_gauge(all, "translucube_renders_set_back",
              "Renders and images of sweeps that wait for a disk, a file, memory or a thread.",
              static_cast<double>(store.set_back));
    add_gauge(all, "translucube_log_lines_lost",
              "Lines of the log that nobody read in time, since the start.",
              static_cast<double>(store.lost_log_lines));
    add_gauge(all, "translucube_queue_depth", "Renders that wait for a worker.",
              static_cast<double>(store.queue_depth));
    add_gauge(all, "translucube_queue_oldest_age_seconds",
              "How long the oldest queued render has waited; 0 where none waits.",
              store.oldest_queued_age_s);
  }
};

Metrics::Metrics() : impl_(std::make_unique<Impl>()) {
  BuildGauge()
      .Name("translucube_build_info")
      .Help("Always 1; its label is the version that runs.")
      .Register(impl_->registry)
      .Add({{"version", std::string(project_version())}})
      .Set(1);
}

Metrics::~Metrics() = default;

void Metrics::count_request(std::string_view method, std::string_view route, int status,
                            double seconds) {
  auto [count, duration] = impl_->of_request(method, route, status);
  count.Increment();
  duration.Observe(seconds);
}

std::shared_ptr<void> Metrics::open_stream() {
  impl_->streams.Increment();
  return {&impl_->streams, [](void* gauge) { static_cast<Gauge*>(gauge)->Decrement(); }};
}

void Metrics::count_pass(const PassFigures& pass) {
  impl_->pass_seconds.Observe(pass.seconds);
  impl_->camera_samples.Increment(static_cast<double>(pass.camera_samples));
  impl_->path_events.Increment(static_cast<double>(pass.path_events));
  impl_->nan_samples.Increment(static_cast<double>(pass.nan_samples));
}

void Metrics::count_render(double seconds) { impl_->render_seconds.Observe(seconds); }
void Metrics::count_cache_hit() { impl_->hits.Increment(); }
void Metrics::count_cache_miss() { impl_->misses.Increment(); }
void Metrics::count_traced_image() { impl_->traced.Increment(); }
void Metrics::count_developed_image() { impl_->developed.Increment(); }

void Metrics::set_store_gauges(std::function<StoreGauges()> gauges) {
  const std::lock_guard lock(impl_->mutex);
  impl_->store_gauges = std::move(gauges);
}

std::string Metrics::text() const {
  std::vector<MetricFamily> all = impl_->registry.Collect();
  impl_->add_store_gauges(all);
  std::ostringstream out;
  prometheus::TextSerializer().Serialize(out, all);
  return out.str();
}

}  // namespace translucube::server

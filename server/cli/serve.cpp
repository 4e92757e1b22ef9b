// The verb that serves: here the parts of the service are put together.

#include <malloc.h>
#include <spdlog/spdlog.h>
#include <sys/stat.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <mutex>
#include <thread>

#include "picture/image_io.h"
#include "server/base/crash_mark.h"
#include "server/base/descriptors.h"
#include "server/base/log.h"
#include "server/base/signals.h"
#include "server/calls/front.h"
#include "server/calls/router.h"
#include "server/cli/command.h"
#include "server/cli/config.h"
#include "server/cli/verbs.h"
#include "server/http/server.h"
#include "server/store/data_folder.h"

namespace translucube::server {
namespace {

// All that was promised is on the disk at any time: what has not ended by then may be cut off.
constexpr std::chrono::seconds longest_shutdown(8);

struct ServeOptions {
  std::string config;
  std::optional<std::string> host;
  std::optional<int> port, threads, workers;
  std::optional<std::filesystem::path> data, tokens;
};

Configuration configured(const ServeOptions& options) {
  Configuration configuration = load_configuration(options.config);
  ServerConfig& server = configuration.server;
  server.host = options.host.value_or(server.host);
  server.port = options.port.value_or(server.port);
  server.threads_per_worker = options.threads.value_or(server.threads_per_worker);
  server.workers = options.workers.value_or(server.workers);
  server.data_folder = options.data.value_or(server.data_folder);
  if (options.tokens) server.tokens_file = options.tokens;
  return configuration;
}

/// Ends the process if it outlives the time it has.
class Watchdog {
 public:
  explicit Watchdog(std::chrono::seconds time)
      : thread_([time](std::stop_token ended) {
          std::mutex mutex;
          std::condition_variable_any condition;
          std::unique_lock lock(mutex);
          condition.wait_for(lock, ended, time, [] { return false; });
          if (ended.stop_requested()) return;
          spdlog::warn("not drained in time: ends as it is");
          flush_log();
          std::_Exit(0);
        }) {}

 private:
  std::jthread thread_;
};

HttpOptions http_options(const ServerConfig& config, const api::Limits& limits) {
  HttpOptions http;
  http.host = config.host;
  http.port = config.port;
  http.body_bytes = limits.body_bytes;
  // What may take long is bounded by places of its own: http_threads are left for all else.
  http.answering = config.http_threads;
  http.in_line = 4 * config.http_threads;
  http.threads = config.http_threads + config.waiting_requests + config.event_streams +
                 config.uploads + config.transfers;
  http.transfers = config.transfers;
  http.connections = config.connections;
  http.header_timeout = std::chrono::seconds(config.header_timeout_s);
  http.idle_timeout = std::chrono::seconds(config.idle_timeout_s);
  http.transfer_timeout = std::chrono::seconds(config.transfer_timeout_s);
  return http;
}

StoreGauges gauges_of(const QueueGauges& queue, const JobService::Figures& figures) {
  StoreGauges gauges;
  for (const api::JobState state : api::all_job_states) {
    const auto index = static_cast<std::size_t>(state);
    gauges.renders[std::string(name(state))] = queue.jobs[index];
    gauges.sweeps[std::string(name(state))] = queue.sweeps[index];
  }
  gauges.tasks = {{"interactive", queue.waiting_tasks[0]}, {"batch", queue.waiting_tasks[1]}};
  gauges.queue_depth = gauges.renders["queued"];
  gauges.oldest_queued_age_s = queue.oldest_waiting_s;
  gauges.results = queue.results;
  gauges.result_bytes = queue.result_bytes;
  gauges.artifact_bytes = figures.artifacts.bytes;
  gauges.unknown_folders = figures.artifacts.unknown;
  gauges.unknown_bytes = figures.artifacts.unknown_bytes;
  gauges.damaged_files = figures.artifacts.damaged;
  gauges.set_back = figures.set_back;
  gauges.lost_log_lines = lost_log_lines();
  return gauges;
}

int serve_or_throw(const ServeOptions& options, std::atomic<int>& signal) {
  // An arena for each of a hundred threads would keep what any of them once needed.
  ::mallopt(M_ARENA_MAX, 4);
  // What a film or the state of a large sweep took goes back to the system. Left to itself, the
  // library raises both as soon as it has met one.
  ::mallopt(M_MMAP_THRESHOLD, 1 << 20);
  ::mallopt(M_TRIM_THRESHOLD, 1 << 20);
  ::umask(077);  // the queue and the pictures are their user's alone
  prepare_image_codecs();
  auto [catalog, config] = configured(options);
  set_up_log(config.log_format);
  fit_descriptors(config, raise_descriptor_limit());
  AccessPolicy policy = access_policy(config);
  const ColorConfig colors(catalog.display_config);
  const DataFolder folder(config.data_folder);
  catalog.uploads = folder.uploads();
  StoreOptions queue;
  queue.most_queued = config.queue_length;
  queue.interactive_seconds = config.interactive_seconds;
  queue.last_crashed = take_crash_mark(folder.crash_mark());
  mark_crashes(folder.crash_mark());
  const auto store = open_job_store(folder.store_file(), queue);
  ArtifactStore artifacts(folder.artifacts());
  UploadStore upload_store(folder.uploads(), config.upload_quota_bytes);
  Metrics metrics;
  JobService service(catalog, config, colors, *store, artifacts, folder, metrics);
  metrics.set_store_gauges([&] {
    StoreGauges gauges = gauges_of(store->gauges(), service.figures());
    gauges.upload_bytes = upload_store.bytes();
    return gauges;
  });
  // The first look at the disk takes what it takes; from here on nobody waits for one.
  static_cast<void>(service.unready_reason());
  Uploads uploads(config, catalog.limits.upload_bytes, *store, upload_store);
  CallContext context(service, uploads, catalog, colors, config);
  Front front(
      std::move(policy), metrics,
      [&](const HttpRequest& request) { return respond(context, request); },
      [&](HttpRequest& request) { return receive(context, request); });
  HttpServer server(front.handlers(), http_options(config, catalog.limits));

  std::jthread http([&] { server.run(); });
  while (!server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const std::string& host = config.host;
  std::cout << "listening on http://" << (host.find(':') == host.npos ? host : '[' + host + ']')
            << ':' << server.port() << std::endl;

  signal.wait(0);
  spdlog::info("signal {}: shutting down", signal.load());
  const Watchdog watchdog(longest_shutdown);
  service.shut_down(std::chrono::seconds(config.drain_s));
  server.stop();
  http.join();
  return 0;
}

/// Serves until SIGTERM, SIGINT or SIGHUP. One line on standard output says where, once it is
/// ready.
int serve(const ServeOptions& options) {
  std::atomic<int> signal = 0;
  const SignalWatch watch([&](int received) {
    signal = received;
    signal.notify_all();
  });
  try {
    return serve_or_throw(options, signal);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return exit_failure;
  }
}

}  // namespace

Verb add_serve(CLI::App& app) {
  const auto options = std::make_shared<ServeOptions>();
  CLI::App* verb = app.add_subcommand("serve", "Serves renders over HTTP");
  verb->add_option("--config", options->config, "Another service.json");
  verb->add_option("--host", options->host, "Address to listen on");
  verb->add_option("--port", options->port, "Port to listen on; 0: any free one")
      ->check(CLI::Range(0, 65535));
  verb->add_option("--data", options->data, "Folder of the queue and the pictures");
  verb->add_option("--tokens", options->tokens, "File of the tokens that open the service");
  verb->add_option("--threads", options->threads, "Threads for each render; 0: all cores")
      ->check(CLI::Range(0, 4096));
  verb->add_option("--workers", options->workers, "Renders traced at once")
      ->check(CLI::Range(1, 1024));
  return {verb, [options] { return serve(*options); }};
}

}  // namespace translucube::server

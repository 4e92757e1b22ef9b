#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <iostream>
#include <mutex>
#include <thread>

#include "renderer/image_io.h"
#include "server/cli.h"
#include "server/data_folder.h"
#include "server/routes.h"
#include "server/signals.h"

namespace translucube::server {
namespace {

// All that was promised is on the disk at any time: what has not ended by then may be cut off.
constexpr std::chrono::seconds longest_drain(8);

void log_to_stderr() {
  auto logger = spdlog::stderr_logger_mt("translucube");
  logger->set_pattern("%Y-%m-%dT%H:%M:%S.%eZ %l %v", spdlog::pattern_time_type::utc);
  spdlog::set_default_logger(logger);
}

api::Catalog configured(const ServeOptions& options) {
  api::Catalog catalog = api::load_catalog(config_file(options.config));
  api::ServerConfig& server = catalog.server;
  server.host = options.host.value_or(server.host);
  server.port = options.port.value_or(server.port);
  server.threads_per_worker = options.threads.value_or(server.threads_per_worker);
  server.workers = options.workers.value_or(server.workers);
  server.data_folder = options.data.value_or(server.data_folder);
  return catalog;
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
          std::_Exit(0);
        }) {}

 private:
  std::jthread thread_;
};

int serve_or_throw(const ServeOptions& options, std::atomic<int>& signal) {
  prepare_image_codecs();
  const api::Catalog catalog = configured(options);
  const ColorConfig colors(catalog.display_config);
  const DataFolder folder(catalog.server.data_folder);
  StoreOptions queue;
  queue.most_queued = catalog.server.queue_length;
  queue.interactive_seconds = catalog.server.interactive_seconds;
  JobStore store(folder.store_file(), queue);
  ArtifactStore artifacts(folder.artifacts());
  JobService service(catalog, colors, store, artifacts);
  Endpoints endpoints{service, catalog, colors};
  HttpServer server(endpoints, {catalog.server.host, catalog.server.port,
                                catalog.server.http_threads, catalog.limits.body_bytes});

  std::jthread http([&] { server.run(); });
  while (!server.is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const std::string& host = catalog.server.host;
  std::cout << "listening on http://" << (host.find(':') == host.npos ? host : '[' + host + ']')
            << ':' << server.port() << std::endl;

  signal.wait(0);
  spdlog::info("signal {}: shutting down", signal.load());
  const Watchdog watchdog(longest_drain);
  service.shut_down();
  server.stop();
  http.join();
  return 0;
}

}  // namespace

int run_serve(const ServeOptions& options) {
  std::atomic<int> signal = 0;
  const SignalWatch watch([&](int received) {
    signal = received;
    signal.notify_all();
  });
  log_to_stderr();
  try {
    return serve_or_throw(options, signal);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return exit_failure;
  }
}

}  // namespace translucube::server

#pragma once

// A service in a folder of its own, over a renderer that is not there: passes take no time unless
// told to, and their bits say which pass, seed and pixel they are.

#include <gtest/gtest.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "api/base/config_file.h"
#include "api/request/catalog.h"
#include "picture/color.h"
#include "renderer/film/film_error.h"
#include "server/base/file.h"
#include "server/base/places.h"
#include "server/base/server_config.h"
#include "server/service/job_service.h"
#include "server/service/uploads.h"
#include "server/store/artifact_store.h"
#include "server/store/data_folder.h"
#include "server/store/job_store.h"
#include "server/worker/engine.h"
#include "tests/server/temp_folder.h"
#include "tests/support/repository.h"

namespace translucube::server::test {

/// Made before any thread is, as main() does: spdlog is not instrumented, so ThreadSanitizer does
/// not see that its registry is made once, by whoever logs first.
inline const std::shared_ptr<spdlog::logger> made_before_threads = spdlog::default_logger();

inline const std::string config_path = in_repository("config/service.json");

/// A request of `samples` samples per pixel of a tiny image: 4 samples make a pass at first.
inline std::string small_request(int samples, int seed = 1, int size = 8) {
  return R"({"material":{"cube":{"absorption":0.3,"roughness":0.3,"scattering":0.5}},)"
         R"("image":{"width":)" +
         std::to_string(size) + R"(,"height":)" + std::to_string(size) +
         R"(},"quality":{"samples":)" + std::to_string(samples) + R"(},"seed":)" +
         std::to_string(seed) + "}";
}

/// What the fake renderer does and has done.
struct FakeRenderer {
  std::atomic<int> passes = 0, builds = 0, tracing = 0, most_tracing = 0;
  std::atomic<int> milliseconds_per_pass = 0;
  std::function<void(const Pass&)> before_pass = [](const Pass&) {};  ///< may throw
  std::function<void(PassFilm&)> after_pass = [](PassFilm&) {};
  std::function<void(const SceneSpec&)> before_build = [](const SceneSpec&) {};

  Engine engine() {
    return [this](const SceneSpec& spec) { return build(spec); };
  }

 private:
  struct Picture {
    int width, height, lanes;
    std::uint64_t seed;
  };

  TracedScene build(const SceneSpec& spec) {
    ++builds;
    before_build(spec);
    const Picture picture{spec.width, spec.height,
                          1 + static_cast<int>(spec.more_absorptions.size()), spec.seed};
    return {[this, picture](const Pass& pass, int, const Patience& patience) {
              return trace(picture, pass, patience.stop);
            },
            stats_of_fake, std::nullopt};
  }

  static RenderStats stats_of_fake(const Film& film, double seconds, int threads) {
    RenderStats stats;
    stats.samples = film.samples;
    stats.seconds = seconds;
    stats.threads = threads;
    stats.relative_error = relative_error(film);
    stats.transport = "walk";
    return stats;
  }

  std::optional<PassFilm> trace(const Picture& picture, const Pass& pass, std::stop_token stop) {
    const int now = ++tracing;
    int most = most_tracing;
    while (now > most && !most_tracing.compare_exchange_weak(most, now)) {
    }
    const struct Leave {
      std::atomic<int>& count;
      ~Leave() { --count; }
    } leave{tracing};
    before_pass(pass);
    const auto end =
        std::chrono::steady_clock::now() + std::chrono::milliseconds(milliseconds_per_pass.load());
    while (std::chrono::steady_clock::now() < end && !stop.stop_requested())
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    if (stop.stop_requested()) return {};
    PassFilm film;
    film.width = picture.width;
    film.height = picture.height;
    film.lanes = picture.lanes;
    film.pass = pass;
    for (int i = 0; i < 3 * picture.width * picture.height * picture.lanes; ++i)
      film.sum.push_back(
          static_cast<float>(pass.count) *
          (1.0f + 0.1f * static_cast<float>((pass.index * 7 + i + picture.seed) % 11)));
    film.counters.camera_samples = pass.count;
    film.cpu_seconds = 0.001;
    after_pass(film);
    ++passes;
    return film;
  }
};

struct ServiceOptions {
  int workers = 1;
  StoreOptions store{};
  std::uint64_t memory_bytes = 0;
  std::uint64_t artifact_bytes = std::uint64_t{20} << 30;
  int keep_days = 36'500;  // stores of old versions are of old dates
  std::uint64_t upload_bytes = 1 << 20, upload_quota_bytes = std::uint64_t{4} << 30;
};

/// The whole service but its socket.
class TestService {
 public:
  TestService(const std::filesystem::path& folder, Engine engine, ServiceOptions options = {})
      : data(folder),
        catalog(with_uploads(api::load_catalog(config_path), data.uploads())),
        config(configured(options)),
        colors(catalog.display_config),
        own_store(open_job_store(data.store_file(), options.store)),
        store(*own_store),
        artifacts(data.artifacts()),
        upload_store(data.uploads(), options.upload_quota_bytes),
        uploads(config, options.upload_bytes, store, upload_store),
        service(catalog, config, colors, store, artifacts, data, metrics, std::move(engine)) {}

  api::RenderStatus submit(const std::string& document, std::optional<std::string> key = {}) {
    auto result = service.submit(document, key);
    if (!result) {
      ADD_FAILURE() << to_text(result.problem());
      return {};
    }
    return result->status;
  }

  api::RenderStatus wait(const std::string& id, int seconds = 120) {
    auto result = service.get(id);
    service.changes().watch(std::chrono::seconds(seconds), [&] {
      result = service.get(id);
      return !result || api::is_end(result->state);
    });
    if (!result) {
      ADD_FAILURE() << to_text(result.problem());
      return {};
    }
    return *result;
  }

  api::JobState state(const std::string& id) {
    const auto result = service.get(id);
    return result->state;
  }

  std::string exr(const std::string& id) {
    auto result = service.image(id, {ImageFormat::exr, {}, {}, {}});
    if (!result) {
      ADD_FAILURE() << to_text(result.problem());
      return {};
    }
    return result->file->read_all();
  }

  /// The folder of a render's picture.
  std::string content(const std::string& id) { return store.pictures(id).at(0).content; }

  DataFolder data;
  api::Catalog catalog;
  ServerConfig config;
  ColorConfig colors;
  std::unique_ptr<JobStore> own_store;
  JobStore& store;
  ArtifactStore artifacts;
  UploadStore upload_store;
  Uploads uploads;
  Metrics metrics;
  JobService service;

 private:
  static api::Catalog with_uploads(api::Catalog catalog, const std::filesystem::path& folder) {
    catalog.uploads = folder;
    return catalog;
  }

  static ServerConfig configured(const ServiceOptions& options) {
    api::ConfigFile file(config_path);
    ServerConfig config = read_server_config(file);
    config.workers = options.workers;
    config.threads_per_worker = 1;
    config.retry_ms = 100;
    config.memory_bytes = options.memory_bytes;
    config.artifact_bytes = options.artifact_bytes;
    config.keep_days = options.keep_days;
    return config;
  }
};

/// Takes places until so many are left; they are given back with what this gives.
inline std::vector<Places::Place> take_all_but(int left, Places& places) {
  std::vector<Places::Place> taken;
  while (places.free() > left) taken.push_back(places.take());
  return taken;
}

/// Waits until `done`, or for long even on a busy machine under a sanitizer; says which.
inline bool eventually(const std::function<bool()>& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(120);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  return true;
}

}  // namespace translucube::server::test

#include "renderer/render.h"

#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <new>
#include <nlohmann/json.hpp>
#include <stop_token>

#include "api/answer/render_status.h"
#include "api/request/parse.h"
#include "renderer/film/explorable_file.h"
#include "server/base/file.h"
#include "server/base/signals.h"
#include "server/cli/input.h"
#include "server/cli/outputs.h"
#include "server/cli/verbs.h"

namespace translucube::server {
namespace {

namespace fs = std::filesystem;

/// One line on a terminal that writes over itself; nothing where standard error is no terminal.
class ProgressLine {
 public:
  void show(const Progress& progress) {
    if (!terminal_) return;
    std::string total, error = "-", eta = "-";
    char number[32];
    if (progress.total_samples) total = '/' + std::to_string(*progress.total_samples);
    if (std::isfinite(progress.relative_error)) {
      std::snprintf(number, sizeof number, "%.4f", progress.relative_error);
      error = number;
    }
    if (progress.eta_seconds) {
      std::snprintf(number, sizeof number, "%.0f s", *progress.eta_seconds);
      eta = number;
    }
    std::fprintf(stderr, "\r\x1b[Kpass %u  samples %u%s  error %s  %.0f s  eta %s", progress.passes,
                 progress.samples, total.c_str(), error.c_str(), progress.seconds, eta.c_str());
    std::fflush(stderr);
    shown_ = true;
  }
  ~ProgressLine() {
    if (shown_) std::fputs("\r\x1b[K", stderr);
  }

 private:
  const bool terminal_ = isatty(STDERR_FILENO) != 0;
  bool shown_ = false;
};

std::string stats_document(const RenderStats& stats, const api::RenderRequest& request,
                           const api::Catalog& catalog) {
  nlohmann::json document = nlohmann::json::parse(api::stats_json(stats));
  document["material"] = nlohmann::json::parse(api::material_report(request, catalog));
  return document.dump(2) + '\n';
}

int explain(const Scene& scene, const RenderOptions& options, const api::RenderRequest& request) {
  const auto [x, y] = *options.pixel;
  if (x < 0 || y < 0 || x >= request.width || y >= request.height)
    throw Refusal{exit_bad_request, "--pixel: lies outside of the image\n"};
  std::cout << explain_sample(scene, x, y, options.sample) << std::flush;
  return 0;
}

int render_or_throw(const RenderOptions& options, std::stop_token stop,
                    const std::atomic<int>& signal) {
  api::Catalog catalog = api::load_catalog(config_file(options.config));
  catalog.any_file = true;  // the caller's own files
  const auto parsed =
      api::parse_render_request(read_input(options.request, catalog.limits.body_bytes), catalog);
  if (!parsed) throw refusal_of(parsed.problem());
  const auto& request = *parsed;
  const ColorConfig colors(catalog.display_config);
  const std::vector<Output> outputs =
      checked_outputs(options.outputs, options.display, options.view, colors);
  if (options.stats) check_output_place(*options.stats);
  if (options.explorable_out) {
    if (!request.explorable)
      throw Refusal{exit_bad_request, "--explorable-out: the request is not explorable\n"};
    check_output_place(*options.explorable_out);
  }

  const std::shared_ptr<const Scene> scene = build_scene(api::scene_spec(request, catalog));
  if (options.pixel) return explain(*scene, options, request);

  const RenderResult result = [&] {
    ProgressLine line;
    return render(*scene, request.quality, options.threads, stop,
                  [&](const Progress& progress) { line.show(progress); });
  }();
  if (result.stopped) return 128 + signal;
  if (result.stats.nan_samples > 0)
    throw Refusal{exit_failure, "The renderer made " + std::to_string(result.stats.nan_samples) +
                                    " samples that are not finite: a bug, please report it.\n"};
  const std::string canonical = api::canonical_json(request);
  Image picture;
  if (request.explorable) {
    const ExplorableFilm film = explorable_film(*scene, result.film);
    if (options.explorable_out)
      write_atomically(*options.explorable_out, [&](const fs::path& temporary) {
        write_explorable(temporary, film, canonical);
      });
    picture = develop_explorable(film, *scene, options.threads);
  } else {
    picture = develop(result.film);
  }
  write_outputs(outputs, picture, colors, canonical);
  if (options.stats)
    write_atomically(*options.stats, stats_document(result.stats, request, catalog));
  return 0;
}

}  // namespace

int run_render(const RenderOptions& options) {
  std::stop_source stop;
  std::atomic<int> signal = 0;
  const SignalWatch watch([&](int received) {
    signal = received;
    stop.request_stop();
  });
  return ended_command([&] { return render_or_throw(options, stop.get_token(), signal); });
}

}  // namespace translucube::server

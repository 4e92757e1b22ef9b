// Renders one request to files, or explains one sample of one pixel.

#include "renderer/render.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "api/answer/material_report.h"
#include "api/answer/render_status.h"
#include "api/base/text.h"
#include "api/request/canonical.h"
#include "api/request/parse.h"
#include "api/request/scene_spec.h"
#include "renderer/film/explorable_develop.h"
#include "renderer/film/explorable_file.h"
#include "server/cli/command.h"
#include "server/cli/config.h"
#include "server/cli/input.h"
#include "server/cli/options.h"
#include "server/cli/outputs.h"
#include "server/cli/verbs.h"

namespace translucube::server {
namespace {

namespace fs = std::filesystem;

struct RenderOptions {
  std::string request;  ///< a file, or "-" for standard input
  std::vector<fs::path> outputs;
  std::optional<fs::path> stats, explorable_out;
  std::optional<std::string> pixel;  ///< "x,y"
  std::uint32_t sample = 0;
  DisplayChoice display;
  Setting setting;
};

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

struct Pixel {
  int x = 0, y = 0;
};

Pixel pixel_of(std::string_view text) {
  const std::size_t comma = text.find(',');
  const auto x = api::number_of<int>(text.substr(0, comma));
  const auto y = comma == text.npos ? std::nullopt : api::number_of<int>(text.substr(comma + 1));
  if (!x || !y) throw Refusal{exit_bad_request, "--pixel: must be x,y\n"};
  return {*x, *y};
}

int explain(const Scene& scene, Pixel pixel, std::uint32_t sample,
            const api::RenderRequest& request) {
  const auto [x, y] = pixel;
  if (x < 0 || y < 0 || x >= request.width || y >= request.height)
    throw Refusal{exit_bad_request, "--pixel: lies outside of the image\n"};
  print(explain_sample(scene, x, y, sample));
  return 0;
}

/// The picture; of an explorable request, its film goes to a file where one is named.
Image developed(const Scene& scene, const Film& film, const RenderOptions& options,
                const api::RenderRequest& request, const std::string& canonical,
                OutputFiles& files) {
  if (!request.explorable) return develop(film);
  const ExplorableFilm explorable = explorable_film(scene, film);
  if (options.explorable_out)
    files.write(*options.explorable_out, [&](const fs::path& temporary) {
      write_explorable(temporary, explorable, canonical);
    });
  return develop_explorable(explorable, explorable_basis(scene)->own, options.setting.threads);
}

/// What the picture shows but does not say.
void note_surprises(const RenderStats& stats) {
  if (stats.camera_inside) std::fputs("The camera is inside the body.\n", stderr);
  constexpr double visible = 1e-3;
  if (stats.truncated_energy > visible)
    std::fprintf(stderr, "%.1f %% of the light was given up: its paths were too long.\n",
                 100 * stats.truncated_energy);
}

void check_places(const RenderOptions& options, const api::RenderRequest& request,
                  OutputFiles& files) {
  files.reads(options.request);
  if (!options.setting.config.empty()) files.reads(options.setting.config);
  const auto* mesh = std::get_if<api::MeshRequest>(&request.object);
  if (mesh && !mesh->file.empty()) files.reads(mesh->file);
  if (const auto* map = std::get_if<api::FileEnvironment>(&request.environment.source))
    files.reads(map->file);
  if (options.stats) files.writes(*options.stats);
  if (!options.explorable_out) return;
  if (!request.explorable)
    throw Refusal{exit_bad_request, "--explorable-out: the request is not explorable\n"};
  files.writes(*options.explorable_out);
}

int render_or_throw(const RenderOptions& options, const Interruption& interruption) {
  if (options.pixel)
    pixel_of(*options.pixel);
  else if (options.outputs.empty())
    throw Refusal{exit_bad_request, "-o: at least one output is needed\n"};
  const api::Catalog catalog = command_line_catalog(options.setting.config);
  const api::RenderRequest request = accepted(
      api::parse_render_request(read_input(options.request, catalog.limits.body_bytes), catalog));
  const ColorConfig colors(catalog.display_config);
  OutputFiles files;
  check_places(options, request, files);
  const std::vector<Output> outputs =
      checked_outputs(options.outputs, options.display, colors, files);

  const std::shared_ptr<const Scene> scene = build_scene(api::scene_spec(request, catalog));
  if (options.pixel) return explain(*scene, pixel_of(*options.pixel), options.sample, request);
  const RenderResult result = [&] {
    ProgressLine line;
    return render(*scene, request.quality, options.setting.threads, interruption.stop,
                  [&](const Progress& progress) { line.show(progress); });
  }();
  if (result.stopped) return interruption.exit_status();
  refuse_nan(result.stats);
  note_surprises(result.stats);
  const std::string canonical = api::canonical_json(request);
  write_outputs(outputs, developed(*scene, result.film, options, request, canonical, files), colors,
                canonical, files);
  if (options.stats) files.write(*options.stats, stats_document(result.stats, request, catalog));
  return files.status();
}

}  // namespace

Verb add_render(CLI::App& app) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App* verb = app.add_subcommand("render", "Renders one request to files");
  verb->add_option("request", options->request, "The request, JSON; - reads standard input")
      ->required();
  add_pictures(*verb, options->outputs,
               "A picture: " + list_formats(&ImageFormatRow::extension, " or ") +
                   "; may be given several times");
  verb->add_option("--stats", options->stats, "Writes samples, seconds, error, ... as JSON");
  verb->add_option("--explorable-out", options->explorable_out,
                   "Writes the path lengths of an explorable request, for develop");
  add_setting(*verb, options->setting);
  add_display(*verb, options->display, list_display_formats(&ImageFormatRow::title, " and "));
  CLI::Option* pixel = verb->add_option(
      "--pixel", options->pixel, "x,y: explains one sample of this pixel and renders nothing");
  verb->add_option("--sample", options->sample, "Which sample of the pixel")->needs(pixel);
  return {verb, [options] {
            return interruptible_command("render", [&](const Interruption& interruption) {
              return render_or_throw(*options, interruption);
            });
          }};
}

}  // namespace translucube::server

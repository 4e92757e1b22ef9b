#include "api/request/sweep.h"

#include <unistd.h>

#include <atomic>
#include <cstdio>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <stop_token>

#include "api/answer/render_status.h"
#include "api/answer/sweep_status.h"
#include "api/request/parse.h"
#include "renderer/light/environment_cache.h"
#include "renderer/render.h"
#include "server/base/file.h"
#include "server/base/signals.h"
#include "server/cli/input.h"
#include "server/cli/outputs.h"
#include "server/cli/verbs.h"
#include "server/pictures/sweep_sheet.h"

namespace translucube::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void show_progress(std::size_t image, std::size_t images, const Progress& progress) {
  std::fprintf(stderr, "\r\x1b[Ktraced image %zu of %zu  pass %u  samples %u  %.0f s", image + 1,
               images, progress.passes, progress.samples, progress.seconds);
  std::fflush(stderr);
}

/// "a0.25-r0.5-s0.75-red-glass": what it is, in the order of the sheet's axes.
std::string point_name(const api::Sweep& sweep, std::size_t point) {
  const api::SweepPlace place = api::place_of(sweep, point);
  std::string absorber = api::absorber_label(sweep, place.absorber);
  for (char& c : absorber)
    if (c == ' ') c = '-';
  const auto text = [](double value) { return json(value).dump(); };
  return 'a' + text(sweep.absorption[place.absorption]) + "-r" +
         text(sweep.roughness[place.roughness]) + "-s" + text(sweep.scattering[place.scattering]) +
         '-' + absorber;
}

struct Sheets {
  SweepSheet png, exr;
};

int sweep_or_throw(const SweepOptions& options, std::stop_token stop,
                   const std::atomic<int>& signal) {
  api::Catalog catalog = api::load_catalog(config_file(options.config));
  catalog.any_file = true;  // the caller's own files
  const auto parsed =
      api::parse_sweep_request(read_input(options.request, catalog.limits.body_bytes), catalog);
  if (!parsed) throw refusal_of(parsed.problem());
  const auto& sweep = *parsed;
  if (options.dry_run) {
    std::cout << api::counts_json(sweep, catalog.limits) << std::endl;
    return 0;
  }
  prepare_image_codecs();
  const ColorConfig colors(catalog.display_config);
  const auto form = [&](ImageFormat format) {
    ImageQuery query{format, {}, {}, {}};
    if (format == ImageFormat::png) {
      query.display = options.display;
      query.view = options.view;
    }
    const auto checked = image_form(query, colors.displays());
    if (!checked) throw refusal_of(checked.problem());
    return *checked;
  };
  const ImageForm png = form(ImageFormat::png), exr = form(ImageFormat::exr);
  Sheets sheets{{sweep, png, colors}, {sweep, exr, colors}};
  fs::create_directories(options.folder);

  const auto images = api::traced_images(sweep, catalog.limits);
  const bool terminal = isatty(STDERR_FILENO) != 0;
  EnvironmentCache environments;
  json points = json::array();
  RenderStats total;
  total.traced_images = 0;
  for (std::size_t image = 0; image < images.size(); ++image) {
    std::vector<api::RenderRequest> lanes;
    for (const std::size_t point : images[image]) lanes.push_back(api::point_request(sweep, point));
    const auto scene = build_scene(api::scene_spec(lanes, catalog), &environments);
    const RenderResult result =
        render(*scene, sweep.base.quality, options.threads, stop, [&](const Progress& progress) {
          if (terminal) show_progress(image, images.size(), progress);
        });
    if (result.stopped) return 128 + signal;
    if (result.stats.nan_samples > 0)
      throw Refusal{exit_failure, "The renderer made " + std::to_string(result.stats.nan_samples) +
                                      " samples that are not finite: a bug, please report it.\n"};
    for (std::size_t lane = 0; lane < lanes.size(); ++lane) {
      const Image picture = develop(result.film, static_cast<int>(lane));
      const std::size_t point = images[image][lane];
      const std::string canonical = api::canonical_json(lanes[lane]),
                        name = point_name(sweep, point);
      write_outputs(
          {{options.folder / (name + ".exr"), exr}, {options.folder / (name + ".png"), png}},
          picture, colors, canonical);
      sheets.png.place(point, picture);
      sheets.exr.place(point, picture);
      points.push_back({{"point", point},
                        {"name", name},
                        {"request", json::parse(canonical)},
                        {"stats", json::parse(api::stats_json(result.stats))}});
    }
    total.seconds += result.stats.seconds;
    total.cpu_seconds += result.stats.cpu_seconds;
    ++total.traced_images;
  }
  if (terminal) std::fputs("\r\x1b[K", stderr);
  const std::string canonical = api::canonical_json(sweep);
  write_atomically(options.folder / "sheet.png",
                   [&](const fs::path& file) { sheets.png.write(file, canonical); });
  write_atomically(options.folder / "sheet.exr",
                   [&](const fs::path& file) { sheets.exr.write(file, canonical); });
  const json document{{"request", json::parse(canonical)},    {"points", sweep.point_count()},
                      {"traced_images", total.traced_images}, {"seconds", total.seconds},
                      {"cpu_seconds", total.cpu_seconds},     {"results", std::move(points)}};
  write_atomically(options.folder / "sweep.json", document.dump(1) + '\n');
  return 0;
}

}  // namespace

int run_sweep(const SweepOptions& options) {
  std::stop_source stop;
  std::atomic<int> signal = 0;
  const SignalWatch watch([&](int received) {
    signal = received;
    stop.request_stop();
  });
  return ended_command([&] { return sweep_or_throw(options, stop.get_token(), signal); });
}

}  // namespace translucube::server

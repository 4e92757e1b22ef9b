// Renders a sweep into a folder: each point as EXR and PNG, the contact sheet as sheet.exr and
// sheet.png, and what was made of what as sweep.json.

#include "api/request/sweep.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>

#include "api/answer/render_status.h"
#include "api/answer/sweep_status.h"
#include "api/request/canonical.h"
#include "api/request/scene_spec.h"
#include "renderer/light/environment_cache.h"
#include "renderer/render.h"
#include "server/cli/command.h"
#include "server/cli/config.h"
#include "server/cli/input.h"
#include "server/cli/options.h"
#include "server/cli/outputs.h"
#include "server/cli/verbs.h"
#include "server/pictures/sweep_sheet.h"

namespace translucube::server {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct SweepOptions {
  std::string request;  ///< a file, or "-" for standard input
  fs::path folder;
  bool dry_run = false;
  DisplayChoice display;
  Setting setting;
};

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

ImageForm form_of(ImageFormat format, const DisplayChoice& display, const ColorConfig& colors) {
  ImageQuery query{format, {}, {}, {}};
  if (!is_scene_linear(format)) {
    query.display = display.display;
    query.view = display.view;
  }
  return accepted(image_form(query, colors.displays()));
}

/// The pictures of a sweep's points, the sheets that they make, and the account of them.
class SweepFolder {
 public:
  SweepFolder(const api::Sweep& sweep, const SweepOptions& options, const ColorConfig& colors)
      : sweep_(sweep),
        folder_(options.folder),
        colors_(colors),
        png_(form_of(ImageFormat::png, options.display, colors)),
        exr_(form_of(ImageFormat::exr, options.display, colors)),
        png_sheet_(sweep, png_, colors),
        exr_sheet_(sweep, exr_, colors) {
    fs::create_directories(folder_);
    files_.reads(options.request);
    for (const char* name : {"sheet.png", "sheet.exr", "sweep.json"}) files_.writes(folder_ / name);
  }

  int status() const { return files_.status(); }

  void add_point(std::size_t point, const Image& picture, const RenderStats& stats) {
    const std::string canonical = api::canonical_json(api::point_request(sweep_, point)),
                      name = point_name(sweep_, point);
    write_outputs({{folder_ / (name + ".exr"), exr_}, {folder_ / (name + ".png"), png_}}, picture,
                  colors_, canonical, files_);
    png_sheet_.place(point, picture);
    exr_sheet_.place(point, picture);
    points_.push_back({{"point", point},
                       {"name", name},
                       {"request", json::parse(canonical)},
                       {"stats", json::parse(api::stats_json(stats))}});
  }

  void add_image(const RenderStats& stats) {
    seconds_ += stats.seconds;
    cpu_seconds_ += stats.cpu_seconds;
    ++traced_images_;
  }

  void finish() {
    const std::string canonical = api::canonical_json(sweep_);
    files_.write(folder_ / "sheet.png",
                 [&](const fs::path& file) { png_sheet_.write(file, canonical); });
    files_.write(folder_ / "sheet.exr",
                 [&](const fs::path& file) { exr_sheet_.write(file, canonical); });
    const json document{{"request", json::parse(canonical)}, {"points", sweep_.point_count()},
                        {"traced_images", traced_images_},   {"seconds", seconds_},
                        {"cpu_seconds", cpu_seconds_},       {"results", points_}};
    files_.write(folder_ / "sweep.json", document.dump(1) + '\n');
  }

 private:
  const api::Sweep& sweep_;
  const fs::path folder_;
  OutputFiles files_;
  const ColorConfig& colors_;
  const ImageForm png_, exr_;
  SweepSheet png_sheet_, exr_sheet_;
  json points_ = json::array();
  int traced_images_ = 0;
  double seconds_ = 0, cpu_seconds_ = 0;
};

int sweep_or_throw(const SweepOptions& options, const Interruption& interruption) {
  if (options.folder.empty() && !options.dry_run)
    throw Refusal{exit_bad_request, "-o: a folder is needed\n"};
  const api::Catalog catalog = command_line_catalog(options.setting.config);
  const api::Sweep sweep = accepted(
      api::parse_sweep_request(read_input(options.request, catalog.limits.body_bytes), catalog));
  if (options.dry_run) {
    print(api::counts_json(sweep, catalog.limits) + '\n');
    return 0;
  }
  prepare_image_codecs();
  const ColorConfig colors(catalog.display_config);
  SweepFolder folder(sweep, options, colors);
  const auto images = api::traced_images(sweep, catalog.limits);
  const bool terminal = isatty(STDERR_FILENO) != 0;
  EnvironmentCache environments;
  for (std::size_t image = 0; image < images.size(); ++image) {
    std::vector<api::RenderRequest> lanes;
    for (const std::size_t point : images[image]) lanes.push_back(api::point_request(sweep, point));
    const auto scene = build_scene(api::scene_spec(lanes, catalog), &environments);
    const RenderResult result = render(*scene, sweep.base.quality, options.setting.threads,
                                       interruption.stop, [&](const Progress& progress) {
                                         if (terminal)
                                           show_progress(image, images.size(), progress);
                                       });
    if (result.stopped) return interruption.exit_status();
    refuse_nan(result.stats);
    for (std::size_t lane = 0; lane < lanes.size(); ++lane)
      folder.add_point(images[image][lane], develop(result.film, static_cast<int>(lane)),
                       result.stats);
    folder.add_image(result.stats);
  }
  if (terminal) std::fputs("\r\x1b[K", stderr);
  folder.finish();
  return folder.status();
}

}  // namespace

Verb add_sweep(CLI::App& app) {
  const auto options = std::make_shared<SweepOptions>();
  CLI::App* verb = app.add_subcommand("sweep", "Renders a sweep over the cube to a folder");
  verb->add_option("request", options->request, "The sweep, JSON; - reads standard input")
      ->required();
  CLI::Option* folder =
      verb->add_option("-o,--output", options->folder,
                       "A folder for the pictures, the contact sheet and sweep.json");
  verb->add_flag("--dry-run", options->dry_run, "Only counts points and traced images")
      ->excludes(folder);
  add_setting(*verb, options->setting);
  add_display(*verb, options->display, "PNG");
  return {verb, [options] {
            return interruptible_command("render", [&](const Interruption& interruption) {
              return sweep_or_throw(*options, interruption);
            });
          }};
}

}  // namespace translucube::server

// Measures a flat slab of a material: its reflectance, transmittance and haze, as JSON.

#include <CLI/CLI.hpp>
#include <memory>

#include "api/answer/appearance_report.h"
#include "api/request/appearance_request.h"
#include "api/request/scene_spec.h"
#include "server/cli/command.h"
#include "server/cli/config.h"
#include "server/cli/input.h"
#include "server/cli/options.h"
#include "server/cli/output_files.h"
#include "server/cli/verbs.h"

namespace translucube::server {
namespace {

namespace fs = std::filesystem;

struct AppearanceOptions {
  std::string request;             ///< a file, or "-" for standard input
  std::optional<fs::path> output;  ///< standard output where it is not given
  Setting setting;
};

int appearance_or_throw(const AppearanceOptions& options) {
  const api::Catalog catalog = command_line_catalog(options.setting.config);
  const api::AppearanceRequest request = accepted(api::parse_appearance_request(
      read_input(options.request, catalog.limits.body_bytes), catalog));
  OutputFiles files;
  files.reads(options.request);
  if (options.output) files.writes(*options.output);
  const Material material = scene_spec(render_request(request, catalog), catalog).material;
  const SlabAppearance appearance =
      slab_appearance(material, request.thickness_mm, request.standard_error, request.seed,
                      options.setting.threads);
  const std::string answer = appearance_json(request, appearance, catalog);
  if (options.output)
    files.write(*options.output, answer);
  else
    print(answer);
  return files.status();
}

}  // namespace

Verb add_appearance(CLI::App& app) {
  const auto options = std::make_shared<AppearanceOptions>();
  CLI::App* verb = app.add_subcommand(
      "appearance", "Measures a flat slab of the material: reflectance, transmittance, haze, ...");
  verb->add_option("request", options->request, "The request, JSON; - reads standard input")
      ->required();
  verb->add_option("-o,--output", options->output,
                   "A file for the answer, JSON; else it goes to standard output");
  add_setting(*verb, options->setting);
  return {verb, [options] {
            return ended_command("slab", [&] { return appearance_or_throw(*options); });
          }};
}

}  // namespace translucube::server

// Develops an explorable film for another absorber.

#include <CLI/CLI.hpp>
#include <memory>

#include "api/request/redevelop.h"
#include "renderer/film/explorable_develop.h"
#include "renderer/film/explorable_file.h"
#include "server/cli/command.h"
#include "server/cli/config.h"
#include "server/cli/options.h"
#include "server/cli/outputs.h"
#include "server/cli/verbs.h"

namespace translucube::server {
namespace {

struct DevelopOptions {
  std::filesystem::path film;  ///< an explorable film, of --explorable-out
  std::vector<std::filesystem::path> outputs;
  std::optional<std::string> absorber;
  std::optional<double> absorption;
  DisplayChoice display;
  Setting setting;
};

StoredExplorable read_film(const std::filesystem::path& file) {
  try {
    return read_explorable(file);
  } catch (const ImageError& error) {
    throw Refusal{exit_bad_request, std::string(error.what()) + '\n'};
  }
}

/// What was asked of a request's material stands in an option here.
Refusal refusal_of_options(const api::Problem& problem) {
  if (problem.faults.empty()) return refusal_of(problem);
  std::string message;
  for (const api::Fault& fault : problem.faults) {
    const bool option = fault.pointer.starts_with('?');
    message += (option ? "--" + fault.pointer.substr(1) : fault.pointer) + ": " + fault.detail;
    message += '\n';
  }
  return {exit_bad_request, message};
}

int develop_or_throw(const DevelopOptions& options) {
  const api::Catalog catalog = command_line_catalog(options.setting.config);
  const ColorConfig colors(catalog.display_config);
  OutputFiles files;
  files.reads(options.film);
  const std::vector<Output> outputs =
      checked_outputs(options.outputs, options.display, colors, files);
  const StoredExplorable stored = read_film(options.film);
  const auto made = api::redevelop(stored.request, {options.absorption, options.absorber}, catalog);
  if (!made) throw refusal_of_options(made.problem());
  const auto& [absorption, request] = *made;
  write_outputs(outputs,
                develop_explorable(stored.film, absorption.absorber, absorption.sigma_a_peak,
                                   options.setting.threads),
                colors, request, files);
  return files.status();
}

}  // namespace

Verb add_develop(CLI::App& app) {
  const auto options = std::make_shared<DevelopOptions>();
  CLI::App* verb =
      app.add_subcommand("develop", "Develops an explorable film for another absorber");
  verb->add_option("film", options->film, "A file of render's --explorable-out")->required();
  verb->add_option("--absorption", options->absorption, "The cube's absorption")
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--absorber", options->absorber, "A name of config/absorbers");
  add_pictures(*verb, options->outputs, "A picture, as for render")->required();
  add_setting(*verb, options->setting);
  add_display(*verb, options->display, list_display_formats(&ImageFormatRow::title, " and "));
  return {verb,
          [options] { return ended_command("film", [&] { return develop_or_throw(*options); }); }};
}

}  // namespace translucube::server

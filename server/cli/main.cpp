#include <CLI/CLI.hpp>
#include <charconv>
#include <iostream>

#include "picture/image_format.h"
#include "server/cli/appearance.h"
#include "server/cli/verbs.h"

namespace {

using namespace translucube::server;

std::optional<std::pair<int, int>> pixel_of(const std::string& text) {
  int x = 0, y = 0;
  const char* end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, x);
  if (first.ec != std::errc() || first.ptr == end || *first.ptr != ',') return std::nullopt;
  const auto second = std::from_chars(first.ptr + 1, end, y);
  if (second.ec != std::errc() || second.ptr != end) return std::nullopt;
  return std::pair(x, y);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Renders translucent materials and serves the pictures.", "translucube");
  app.set_version_flag("--version", "translucube " TRANSLUCUBE_VERSION);
  app.require_subcommand(1);
  const std::string for_displays =
      "For " + translucube::list_display_formats(&translucube::ImageFormatRow::title, " and ");

  RenderOptions render;
  std::string pixel;
  CLI::App* render_verb = app.add_subcommand("render", "Renders one request to files");
  render_verb->add_option("request", render.request, "The request, JSON; - reads standard input")
      ->required();
  CLI::Option* outputs = render_verb
                             ->add_option("-o,--output", render.outputs,
                                          "A picture: " +
                                              translucube::list_formats(
                                                  &translucube::ImageFormatRow::extension, " or ") +
                                              "; may be given several times")
                             ->expected(1)
                             ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  render_verb->add_option("--stats", render.stats, "Writes samples, seconds, error, ... as JSON");
  render_verb->add_option("--explorable-out", render.explorable_out,
                          "Writes the path lengths of an explorable request, for develop");
  render_verb->add_option("--threads", render.threads, "At most this many threads; 0: all cores")
      ->check(CLI::Range(0, 4096));
  render_verb->add_option("--config", render.config, "Another service.json");
  render_verb->add_option("--display", render.display, for_displays);
  render_verb->add_option("--view", render.view, for_displays);
  CLI::Option* pixel_option = render_verb->add_option(
      "--pixel", pixel, "x,y: explains one sample of this pixel and renders nothing");
  render_verb->add_option("--sample", render.sample, "Which sample of the pixel")
      ->needs(pixel_option);

  SweepOptions sweep;
  CLI::App* sweep_verb = app.add_subcommand("sweep", "Renders a sweep over the cube to a folder");
  sweep_verb->add_option("request", sweep.request, "The sweep, JSON; - reads standard input")
      ->required();
  CLI::Option* folder = sweep_verb->add_option(
      "-o,--output", sweep.folder, "A folder for the pictures, the contact sheet and sweep.json");
  sweep_verb->add_flag("--dry-run", sweep.dry_run, "Only counts points and traced images")
      ->excludes(folder);
  sweep_verb->add_option("--threads", sweep.threads, "At most this many threads; 0: all cores")
      ->check(CLI::Range(0, 4096));
  sweep_verb->add_option("--config", sweep.config, "Another service.json");
  sweep_verb->add_option("--display", sweep.display, "For PNG");
  sweep_verb->add_option("--view", sweep.view, "For PNG");

  DevelopOptions develop;
  CLI::App* develop_verb =
      app.add_subcommand("develop", "Develops an explorable film for another absorber");
  develop_verb->add_option("film", develop.film, "A file of render's --explorable-out")->required();
  develop_verb->add_option("--absorption", develop.absorption, "The cube's absorption")
      ->check(CLI::Range(0.0, 1.0));
  develop_verb->add_option("--absorber", develop.absorber, "A name of config/absorbers");
  develop_verb->add_option("-o,--output", develop.outputs, "A picture, as for render")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
      ->required();
  develop_verb->add_option("--threads", develop.threads, "At most this many threads; 0: all cores")
      ->check(CLI::Range(0, 4096));
  develop_verb->add_option("--config", develop.config, "Another service.json");
  develop_verb->add_option("--display", develop.display, for_displays);
  develop_verb->add_option("--view", develop.view, for_displays);

  AppearanceOptions appearance;
  CLI::App* appearance_verb = app.add_subcommand(
      "appearance", "Measures a flat slab of the material: reflectance, transmittance, haze, ...");
  appearance_verb
      ->add_option("request", appearance.request, "The request, JSON; - reads standard input")
      ->required();
  appearance_verb->add_option("-o,--output", appearance.output,
                              "A file for the answer, JSON; else it goes to standard output");
  appearance_verb
      ->add_option("--threads", appearance.threads, "At most this many threads; 0: all cores")
      ->check(CLI::Range(0, 4096));
  appearance_verb->add_option("--config", appearance.config, "Another service.json");

  ServeOptions serve;
  CLI::App* serve_verb = app.add_subcommand("serve", "Serves renders over HTTP");
  serve_verb->add_option("--config", serve.config, "Another service.json");
  serve_verb->add_option("--host", serve.host, "Address to listen on");
  serve_verb->add_option("--port", serve.port, "Port to listen on; 0: any free one")
      ->check(CLI::Range(0, 65535));
  serve_verb->add_option("--data", serve.data, "Folder of the queue and the pictures");
  serve_verb->add_option("--tokens", serve.tokens, "File of the tokens that open the service");
  serve_verb->add_option("--threads", serve.threads, "Threads for each render; 0: all cores")
      ->check(CLI::Range(0, 4096));
  serve_verb->add_option("--workers", serve.workers, "Renders traced at once")
      ->check(CLI::Range(1, 1024));

  std::string token_name;
  CLI::App* token_verb = app.add_subcommand("token", "Makes a token for who may use the service");
  token_verb->add_option("--name", token_name, "Who will have it")->required();

  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : exit_bad_request;
  }
  if (token_verb->parsed()) return run_token(token_name);
  if (serve_verb->parsed()) return run_serve(serve);
  if (appearance_verb->parsed()) return run_appearance(appearance);
  if (sweep_verb->parsed()) {
    if (sweep.folder.empty() && !sweep.dry_run) {
      std::cerr << "-o: a folder is needed\n";
      return exit_bad_request;
    }
    return run_sweep(sweep);
  }
  if (develop_verb->parsed()) return run_develop(develop);
  if (pixel_option->count() > 0) {
    render.pixel = pixel_of(pixel);
    if (!render.pixel) {
      std::cerr << "--pixel: must be x,y\n";
      return exit_bad_request;
    }
  } else if (outputs->count() == 0) {
    std::cerr << "-o: at least one output is needed\n";
    return exit_bad_request;
  }
  return run_render(render);
}

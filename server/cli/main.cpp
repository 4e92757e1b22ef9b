#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <csignal>
#include <iostream>

#include "picture/image_io.h"
#include "picture/version.h"
#include "server/cli/command.h"
#include "server/cli/verbs.h"

int main(int argc, char** argv) {
  using namespace translucube;
  using namespace translucube::server;
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of its writer
  CLI::App app("Renders translucent materials and serves the pictures.", "translucube");
  app.set_version_flag("--version", "translucube " + std::string(project_version()));
  app.require_subcommand(1);
  const std::array verbs{add_render(app),     add_sweep(app), add_develop(app),
                         add_appearance(app), add_serve(app), add_token(app)};
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error) == 0 ? 0 : exit_bad_request;
    if (std::cout.flush()) return status;
    std::cerr << "standard output cannot be written\n";
    return exit_failure;
  }
  const auto given =
      std::ranges::find_if(verbs, [](const Verb& verb) { return verb.command->parsed(); });
  const int status = given->run();
  finish_image_codecs();
  return status;
}

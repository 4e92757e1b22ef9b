#include "server/cli/appearance.h"

#include <iostream>

#include "api/request/appearance_request.h"
#include "server/base/file.h"
#include "server/cli/input.h"
#include "server/cli/verbs.h"

namespace translucube::server {
namespace {

namespace fs = std::filesystem;

int appearance_or_throw(const AppearanceOptions& options) {
  const api::Catalog catalog = api::load_catalog(config_file(options.config));
  const auto parsed = api::parse_appearance_request(
      read_input(options.request, catalog.limits.body_bytes), catalog);
  if (!parsed) {
    std::cerr << to_text(parsed.problem());
    return exit_bad_request;
  }
  // The finished file takes the place of what is there: never of a device, a pipe, a folder.
  if (options.output && fs::exists(*options.output) && !fs::is_regular_file(*options.output)) {
    std::cerr << options.output->string() << ": is not an ordinary file\n";
    return exit_failure;
  }
  const auto& request = *parsed;
  const std::string answer =
      appearance_json(request, measure(request, catalog, options.threads), catalog);
  if (options.output) {
    write_atomically(*options.output, answer);
    return 0;
  }
  std::cout << answer << std::flush;
  if (std::cout) return 0;
  std::cerr << "standard output cannot be written\n";
  return exit_failure;
}

}  // namespace

int run_appearance(const AppearanceOptions& options) {
  try {
    return appearance_or_throw(options);
  } catch (const InputError& error) {
    std::cerr << error.what() << '\n';
    return exit_bad_request;
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
  }
  return exit_failure;
}

}  // namespace translucube::server

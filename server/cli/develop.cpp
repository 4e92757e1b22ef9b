#include <iostream>
#include <new>

#include "api/request/redevelop.h"
#include "renderer/film/explorable_develop.h"
#include "renderer/film/explorable_file.h"
#include "server/cli/outputs.h"
#include "server/cli/verbs.h"

namespace translucube::server {
namespace {

void develop_or_throw(const DevelopOptions& options) {
  const api::Catalog catalog = api::load_catalog(config_file(options.config));
  const ColorConfig colors(catalog.display_config);
  const std::vector<Output> outputs =
      checked_outputs(options.outputs, options.display, options.view, colors);
  const StoredExplorable stored = [&] {
    try {
      return read_explorable(options.film);
    } catch (const ImageError& error) {
      throw Refusal{exit_bad_request, std::string(error.what()) + '\n'};
    }
  }();
  const auto made = api::redevelop(stored.request, {options.absorption, options.absorber}, catalog);
  if (!made) {
    if (made.problem().faults.empty()) throw refusal_of(made.problem());
    std::string message;
    for (const api::Fault& fault : made.problem().faults) {
      const bool option = fault.pointer.starts_with('?');
      message += (option ? "--" + fault.pointer.substr(1) : fault.pointer) + ": " + fault.detail;
      message += '\n';
    }
    throw Refusal{exit_bad_request, message};
  }
  const auto& [absorption, request] = *made;
  write_outputs(outputs,
                develop_explorable(stored.film, absorption.absorber, absorption.sigma_a_peak,
                                   options.threads),
                colors, request);
}

}  // namespace

int run_develop(const DevelopOptions& options) {
  try {
    develop_or_throw(options);
    return 0;
  } catch (const Refusal& refusal) {
    std::cerr << refusal.message;
    return refusal.status;
  } catch (const std::bad_alloc&) {
    std::cerr << "There is not enough memory for a film of this size.\n";
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
  }
  return exit_failure;
}

}  // namespace translucube::server

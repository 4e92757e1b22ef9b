#include "server/cli/options.h"

#include <CLI/CLI.hpp>

namespace translucube::server {

void add_setting(CLI::App& verb, Setting& setting) {
  verb.add_option("--threads", setting.threads, "At most this many threads; 0: all cores")
      ->check(CLI::Range(0, 4096));
  verb.add_option("--config", setting.config, "Another service.json");
}

void add_display(CLI::App& verb, DisplayChoice& choice, const std::string& formats) {
  verb.add_option("--display", choice.display, "For " + formats);
  verb.add_option("--view", choice.view, "For " + formats);
}

CLI::Option* add_pictures(CLI::App& verb, std::vector<std::filesystem::path>& files,
                          const std::string& description) {
  return verb.add_option("-o,--output", files, description)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

}  // namespace translucube::server

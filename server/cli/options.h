#pragma once

// Options that several verbs have.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace translucube::server {

/// --threads and --config.
struct Setting {
  int threads = 0;     ///< 0: all cores
  std::string config;  ///< another service.json
};
void add_setting(CLI::App& verb, Setting& setting);

/// --display and --view; `formats` says what for.
struct DisplayChoice {
  std::optional<std::string> display, view;
};
void add_display(CLI::App& verb, DisplayChoice& choice, const std::string& formats);

/// -o, as often as there are pictures.
CLI::Option* add_pictures(CLI::App& verb, std::vector<std::filesystem::path>& files,
                          const std::string& description);

}  // namespace translucube::server

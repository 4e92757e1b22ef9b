#include "server/cli/config.h"

#include <cstdlib>
#include <filesystem>

#include "api/base/config_file.h"

namespace translucube::server {
namespace {

namespace fs = std::filesystem;

fs::path config_file(const std::string& named) {
  if (!named.empty()) return named;
  if (const char* variable = std::getenv("TRANSLUCUBE_CONFIG"); variable && *variable)
    return variable;
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  if (!error) {
    // <source>/build/<preset>/bin/translucube
    const fs::path beside =
        executable.parent_path().parent_path().parent_path().parent_path() / "config/service.json";
    if (fs::is_regular_file(beside, error)) return beside;
  }
  return fs::path(TRANSLUCUBE_SOURCE_DIR) / "config/service.json";
}

}  // namespace

Configuration load_configuration(const std::string& named) {
  api::ConfigFile file(config_file(named));
  // The catalog last: it refuses the faults of the whole file.
  ServerConfig server = read_server_config(file);
  return {api::load_catalog(file), std::move(server)};
}

api::Catalog command_line_catalog(const std::string& named) {
  api::Catalog catalog = load_configuration(named).catalog;
  catalog.any_file = true;
  return catalog;
}

}  // namespace translucube::server

#include <cstdlib>

#include "server/cli/verbs.h"

namespace translucube::server {

std::filesystem::path config_file(const std::string& named) {
  namespace fs = std::filesystem;
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

}  // namespace translucube::server

#pragma once

#include <string>

#include "api/request/catalog.h"
#include "server/base/server_config.h"

namespace translucube::server {

/// service.json, read whole.
struct Configuration {
  api::Catalog catalog;
  ServerConfig server;
};

/// Reads the file that `--config` names, else $TRANSLUCUBE_CONFIG, else the one beside the build
/// tree of this executable, else the one of the source tree. Throws ConfigError.
Configuration load_configuration(const std::string& named);

/// The catalog of who works on the command line: documents may name any file.
api::Catalog command_line_catalog(const std::string& named);

}  // namespace translucube::server

#pragma once

#include <filesystem>

namespace translucube {

/// A file of this repository by its path within it, e.g. "config/service.json".
std::filesystem::path in_repository(const std::filesystem::path& file);

}  // namespace translucube

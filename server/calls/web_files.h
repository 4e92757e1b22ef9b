#pragma once

// The web explorer (server/web/), which travels inside the binary.

#include <span>
#include <string>
#include <string_view>

namespace translucube::server {

struct WebFile {
  std::string_view name;  ///< "cube.js"
  std::string_view bytes;
};

/// All of them, by name; written by CMake (web_files.cmake).
std::span<const WebFile> web_files();

/// nullptr where there is none of this name.
const WebFile* find_web_file(std::string_view name);

/// The media type that the name's extension stands for.
std::string_view web_content_type(std::string_view name);

}  // namespace translucube::server

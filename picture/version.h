#pragma once

#include <string_view>

namespace translucube {

/// The version of the project, which CMakeLists.txt gives it: "0.2.0".
std::string_view project_version();

}  // namespace translucube

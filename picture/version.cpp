#include "picture/version.h"

namespace translucube {

std::string_view project_version() { return TRANSLUCUBE_VERSION; }

}  // namespace translucube

#include "tests/support/repository.h"

namespace translucube {

std::filesystem::path in_repository(const std::filesystem::path& file) {
  return TRANSLUCUBE_SOURCE_DIR / file;
}

}  // namespace translucube

// In the renderer's place: a mesh that a request names is the business of Assimp, and would bring
// the whole renderer with it.

#include "renderer/scene/spec.h"

namespace translucube {
void check_mesh(const std::filesystem::path&) {}
}  // namespace translucube

#include "renderer/light_list.h"

#include "renderer/sampler.h"

namespace translucube {

LightList::LightList(const Environment& environment, std::uint64_t key) {
  const auto* image = std::get_if<ImageEnvironment>(&environment);
  if (image == nullptr) return;
  Rng rng(key);
  for (auto* floats : {&x, &y, &z, &pdf}) floats->resize(size);
  radiance.resize(size);
  for (std::uint32_t i = 0; i < size; ++i) {
    const EnvironmentSample light = image->sample({(i + rng.uniform()) / size, rng.uniform()});
    x[i] = static_cast<float>(light.direction.x);
    y[i] = static_cast<float>(light.direction.y);
    z[i] = static_cast<float>(light.direction.z);
    pdf[i] = static_cast<float>(light.value.pdf);
    radiance[i] = light.value.radiance;
  }
}

}  // namespace translucube

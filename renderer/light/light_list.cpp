#include "renderer/light/light_list.h"

#include "renderer/base/sampler.h"

namespace translucube {

LightList::LightList(const Lighting& lighting, std::uint64_t key) {
  if (lighting.uniform()) return;
  Rng rng(key);
  radiance.resize(size);
  const std::vector<EnvironmentSample> lights = lighting.sample_each(size, rng);
  for (std::uint32_t i = 0; i < size; ++i) {
    direction.set(i, lights[i].direction);
    pdf[i] = static_cast<float>(lights[i].value.pdf);
    radiance[i] = lights[i].value.radiance;
  }
}

}  // namespace translucube

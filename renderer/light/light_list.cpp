#include "renderer/light/light_list.h"

#include "renderer/base/sampler.h"

namespace translucube {

LightList::LightList(const Environment& environment, std::uint64_t key) {
  const auto* image = std::get_if<ImageEnvironment>(&environment);
  if (image == nullptr) return;
  Rng rng(key);
  radiance.resize(size);
  std::vector<Sample2> numbers;
  numbers.reserve(size);
  for (std::uint32_t i = 0; i < size; ++i)
    numbers.push_back({(i + rng.uniform()) / size, rng.uniform()});
  const std::vector<EnvironmentSample> lights = image->sample(numbers);
  for (std::uint32_t i = 0; i < size; ++i) {
    direction.set(i, lights[i].direction);
    pdf[i] = static_cast<float>(lights[i].value.pdf);
    radiance[i] = lights[i].value.radiance;
  }
}

}  // namespace translucube

// A sun of 33,664 in the environment, which paths alone would hardly ever find: what noise and
// fireflies are left.

#include "renderer/scene/scene.h"
#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"
#include "tests/bench/speed/sunrise.h"

namespace translucube::speed {
namespace {

constexpr int sun_size = 96, references = 4;
constexpr Quantity trimmed_cost{"trimmed × CPU s"}, largest{"largest pixel / converged", "%.2f"};

struct Rendered {
  Image image;
  double cpu_seconds = 0;
};
Rendered render_once(Run& run, const PeerMaterial& material, std::uint32_t samples) {
  SceneSpec spec = peer_scene(material.coefficients, sun_size, run.next_seed());
  spec.environment.source = ImageEnvironmentSpec{sunrise(run)};
  Snapshot end = std::move(trace(*build_scene(spec), {samples}, run.threads).front());
  return {std::move(end.image), end.cpu_seconds};
}

struct Cost {
  double trimmed, untrimmed;  ///< relMSE x CPU s
};
Cost cost_of(const Rendered& a, const Rendered& b, const Image& reference) {
  const RelMse error = rel_mse_of_pair(a.image, b.image, reference);
  const double seconds = (a.cpu_seconds + b.cpu_seconds) / 2;
  return {error.trimmed * seconds, error.untrimmed * seconds};
}

}  // namespace

Tables hard_sun(Run& run) {
  Table table{
      "sun", "A hard sun",
      "The peers' scene under sunrise.exr (peak 33,664), 96 × 96 pixels, 256 samples at full "
      "effort: relMSE × CPU seconds, and the largest pixel of one render over its converged value "
      "(the mean of 4 others; of at least 0.01), which should not be above 10. Errors relative to "
      "that mean, smoothed. By paths alone, without next-event estimation, the untrimmed products "
      "were 3.1, 14.8, 24.7 and 25.8 (commit 890f60d): 65, 141, 20,000 and 8,600 times as large."};
  if (sunrise(run).empty()) {
    table.remark =
        "Not measured: sunrise.exr is neither in config/environments nor where --sun says.";
    return {table};
  }
  const std::uint32_t samples = run.samples(256);
  for (const char* name : {"S01", "S1", "S10", "M"}) {
    if (!run.chosen(name)) continue;
    const PeerMaterial& material = peer_material(name);
    std::vector<Rendered> renders;
    std::vector<Image> others;
    for (int i = 0; i <= references; ++i) {
      renders.push_back(render_once(run, material, samples));
      if (i > 0) others.push_back(renders.back().image);
    }
    const Image converged = mean_of(others), reference = test::smoothed(converged);
    const Cost found = cost_of(renders[0], renders[1], reference);
    table.add(name, trimmed_cost, found.trimmed);
    table.add(name, untrimmed_cost, found.untrimmed);
    table.add(name, largest, largest_ratio(renders[0].image, converged), at_most(10));
  }
  return {table};
}

}  // namespace translucube::speed

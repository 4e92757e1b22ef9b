// Other absorbers on the same traced image: a lane of the film each.

#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"
#include "tests/support/absorbers.h"

namespace translucube::speed {
namespace {

constexpr Quantity each{"each further lane", "%.2f %%"};
constexpr int counts[] = {1, 2, 4, 8, 16, 17, 32};

/// The peers' scene with so many absorptions, spectral as the service's are.
std::shared_ptr<const Scene> scene_with(const PeerMaterial& material, int lanes,
                                        std::uint64_t seed) {
  SceneSpec spec = peer_scene(material.coefficients, 128, seed);
  spec.material.absorber = red_glass();
  spec.material.coefficients.sigma_a_peak = 0.05;
  for (int i = 1; i < lanes; ++i)
    spec.more_absorptions.push_back(
        {i % 2 ? Absorber(narrow_band()) : red_glass(), 0.05 + 0.1 * i});
  return build_scene(spec);
}

}  // namespace

Tables lanes(Run& run) {
  Table table{
      "lanes", "Lanes",
      "CPU time over the number of absorptions that are developed while the image is traced "
      "(film lanes, spectral absorbers), 128 × 128 pixels. 16 more absorbers may cost 5 % "
      "of the trace each; the median of interleaved repetitions."};
  const std::uint32_t samples = run.samples(16);
  const int repetitions = run.repetitions(3);
  for (const char* name : {"A0", "R10", "S1", "S10"}) {
    if (!run.chosen(name)) continue;
    const std::uint64_t seed = run.next_seed();
    std::vector<std::vector<double>> times(std::size(counts));
    for (int repetition = 0; repetition < repetitions; ++repetition)
      for (std::size_t i = 0; i < std::size(counts); ++i) {
        TraceCounters counters;
        const Snapshot end = trace(*scene_with(peer_material(name), counts[i], seed), {samples},
                                   run.threads, &counters)
                                 .front();
        times[i].push_back(1e9 * end.cpu_seconds / static_cast<double>(counters.camera_samples));
      }
    const double alone = median(times[0]);
    for (std::size_t i = 0; i < std::size(counts); ++i) {
      const std::string row = text("%s, lanes %d", name, counts[i]);
      table.add(row, ns_a_sample, median(times[i]));
      if (counts[i] == 1) continue;
      table.add(row, each, 100 * (median(times[i]) / alone - 1) / (counts[i] - 1),
                counts[i] == 17 ? std::optional(at_most(5)) : std::nullopt);
    }
  }
  table.plots.push_back({"lanes", "Time of a sample over the number of lanes"});
  return {table};
}

}  // namespace translucube::speed

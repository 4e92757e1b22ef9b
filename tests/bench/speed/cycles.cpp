// Cycles in the same run on the same machine, so that the ratio holds wherever it is measured.

#include <algorithm>

#include "tests/bench/speed/blender.h"
#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"

namespace translucube::speed {
namespace {

constexpr int cycles_size = 256;
constexpr Quantity samples_of_cycles{"samples", "%.0f"}, theirs{"Cycles, relMSE × CPU s"},
    ours{"ours"}, cycles_over_ours{"Cycles / ours", "%.1f"}, brightness{"mean, of ours", "%.3f"};

/// CPU ns of a sample in Cycles (docs/speed.md): tells how many samples are affordable.
struct Expected {
  const char* material;
  double ns;
};
constexpr Expected expected[] = {{"A0", 737},     {"A2", 723},       {"R05", 3'770}, {"R10", 4'770},
                                 {"R25", 4'980},  {"R50", 5'190},    {"S01", 3'000}, {"S1", 8'960},
                                 {"S10", 57'700}, {"S100", 257'000}, {"M", 37'400},  {"C", 40'000}};
constexpr double cpu_seconds_each = 20;

std::uint32_t affordable(const Expected& material, double effort) {
  const double samples =
      effort * cpu_seconds_each / (1e-9 * material.ns * cycles_size * cycles_size);
  return static_cast<std::uint32_t>(std::clamp(samples, 4.0, 64.0));
}

}  // namespace

Tables cycles(Run& run) {
  Table table{"cycles", "Cycles on the same machine",
              "The same scene and materials in Blender's Cycles (`blender -b -P "
              "tests/bench/cycles.py`), two seeds, as many samples as 20 CPU seconds allow (4 to "
              "64): its relMSE × CPU seconds, scene building left out, over ours of this run. Its "
              "rough glass scatters once, ours many times between microfacets; its body is made of "
              "triangles. The mean of its image over ours shows that both render the same."};
  table.remark = why_not_cycles(run);
  if (!table.remark.empty()) return {table};
  const SceneSpec scene = peer_scene({}, cycles_size, 1);
  std::vector<CyclesTask> tasks;
  for (const Expected& material : expected)
    if (run.chosen(material.material))
      tasks.push_back({material.material, affordable(material, run.effort)});
  const CyclesAnswer answer = render_in_cycles(
      run, std::get<ImageEnvironmentSpec>(scene.environment.source).file, cycles_size, tasks);
  table.remark = "Blender " + answer.version + ".";
  for (const auto& [name, samples] : tasks) {
    const CyclesPair& peer = answer.pairs.at(name);
    const Coefficients& c = peer_material(name).coefficients;
    const double error =
        rel_mse_of_pair(peer.images.at(0), peer.images.at(1), reference_of(peer.images, c)).trimmed;
    const Pair pair = render_pair(run, peer_scene(c, cycles_size, 0), run.samples(64));
    const double cost = pair.error().trimmed * pair.cpu_seconds;
    table.add(name, samples_of_cycles, peer.samples);
    table.add(name, cpu_seconds, peer.cpu_seconds);
    table.add(name, ns_a_sample,
              1e9 * peer.cpu_seconds / (double(peer.samples) * cycles_size * cycles_size));
    table.add(name, theirs, error * peer.cpu_seconds);
    table.add(name, ours, cost);
    table.add(name, cycles_over_ours, error * peer.cpu_seconds / cost);
    table.add(name, brightness, mean_value(peer.images) / mean_value({pair.a, pair.b}));
  }
  return {table};
}

}  // namespace translucube::speed

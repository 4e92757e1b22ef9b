// The same render on more threads.

#include <algorithm>

#include "renderer/base/parallel.h"
#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"

namespace translucube::speed {
namespace {

constexpr Quantity wall{"wall s", "%.3f"}, speedup{"times one thread", "%.2f"};

}  // namespace

Tables cores(Run& run) {
  Table table{"cores", "Cores",
              "Wall seconds of a render at 256 × 256 pixels over the number of threads; the median "
              "of interleaved repetitions. Two threads must be 1.9 times as fast as one."};
  const int available = thread_count(0);
  if (available < 2) {
    table.remark = "This machine has one core: nothing measured.";
    return {table};
  }
  std::vector<int> threads;
  for (int n = 1; n <= available; n *= 2) threads.push_back(n);
  const SampleTarget samples{run.samples(8)};
  const int repetitions = run.repetitions(5);
  for (const char* name : {"A0", "R10", "S10", "S100", "M"}) {
    if (!run.chosen(name)) continue;
    const auto scene =
        build_scene(peer_scene(peer_material(name).coefficients, 256, run.next_seed()));
    std::vector<std::vector<double>> times(threads.size());
    for (int repetition = 0; repetition < repetitions; ++repetition)
      for (std::size_t i = 0; i < threads.size(); ++i)
        times[i].push_back(render(*scene, samples, threads[i]).stats.seconds);
    for (std::size_t i = 0; i < threads.size(); ++i) {
      const std::string row = text("%s, threads %d", name, threads[i]);
      table.add(row, wall, median(times[i]));
      table.add(row, speedup, median(times[0]) / median(times[i]),
                threads[i] == 2 ? std::optional(at_least(1.9)) : std::nullopt);
    }
  }
  table.plots.push_back({"cores", "Speed over the number of threads"});
  return {table};
}

}  // namespace translucube::speed

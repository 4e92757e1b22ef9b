// Large pictures: time in proportion to the pixels, memory no more than the film's.

#include <malloc.h>

#include <algorithm>
#include <fstream>
#include <stdexcept>

#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"
#include "tests/server/process/process.h"

namespace translucube::speed {
namespace {

constexpr Quantity wall_ns{"wall ns a sample", "%.0f"}, cpu_ns{"CPU ns a sample", "%.0f"},
    growth{"CPU, of 256 × 256", "%.2f"};
constexpr Quantity mib{"peak MiB", "%.1f"}, arithmetic_mib{"film's MiB", "%.1f"},
    memory_ratio{"peak / film", "%.3f"};
constexpr int sizes[] = {64, 256, 1024, 2048, 4096};
/// Linear within what caches and a machine's other work disturb.
constexpr double linear = 1.1;

std::string row_of(int size) { return text("%d × %d", size, size); }

Table times(Run& run) {
  Table table{
      "pixels", "Pixels",
      "Time of a sample of A0 over the size of the picture; small ones repeated, the median "
      "of 3. Linear: within 10 % of 256 × 256."};
  const std::uint32_t samples = run.effort < 0.5 ? 1 : 4;
  for (const int size : sizes) {
    const auto scene = build_scene(peer_scene({}, size, run.next_seed()));
    std::vector<double> wall, used;
    for (int repetition = 0; repetition < (size > 1024 ? 1 : 3); ++repetition) {
      double seconds = 0, cpu_seconds = 0;
      const int renders = std::max(1, 512 * 512 / (size * size));
      for (int i = 0; i < renders; ++i) {
        const RenderStats stats = render(*scene, SampleTarget{samples}, run.threads).stats;
        seconds += stats.seconds;
        cpu_seconds += stats.cpu_seconds;
      }
      const double per_sample = 1e9 / (double(samples) * size * size * renders);
      wall.push_back(seconds * per_sample);
      used.push_back(cpu_seconds * per_sample);
    }
    table.add(row_of(size), wall_ns, median(wall));
    table.add(row_of(size), cpu_ns, median(used));
  }
  for (const int size : sizes)
    table.add(row_of(size), growth,
              table.value(row_of(size), cpu_ns) / table.value(row_of(256), cpu_ns),
              size > 256 ? std::optional(at_most(linear)) : std::nullopt);
  return table;
}

/// The most memory that this process has held [bytes].
double peak_memory() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return 1024 * std::stod(line.substr(6));
  throw std::runtime_error("no VmHWM in /proc/self/status");
}

/// Measured in a process of its own, whose peak is its own.
double memory_of(int size, int lanes, int threads) {
  server::test::Process process({"/proc/self/exe", "--film-memory", std::to_string(size),
                                 std::to_string(lanes), "--threads", std::to_string(threads)});
  const std::string bytes = process.line();
  if (process.wait() != 0) throw std::runtime_error("--film-memory: " + process.errors());
  return std::stod(bytes);
}

Table memory(Run& run) {
  Table table{"memory", "Film",
              "Peak memory of a render above that of a tiny one, over what the picture needs while "
              "a pass is merged: for each pixel and channel a float for each lane's sum, one for "
              "each lane's pass and one for the variance."};
  constexpr double mebi = 1 << 20;
  for (const auto& [size, lanes] : {std::pair{1024, 1}, {2048, 1}, {4096, 1}, {1024, 8}}) {
    if (run.effort < 0.5 && size > 2048) continue;
    const double pixels = double(size) * size;
    const double needed = pixels * 3 * sizeof(float) * (2 * lanes + 1);
    const double used = memory_of(size, lanes, run.threads);
    const std::string row = text("%d × %d, %d lane%s", size, size, lanes, lanes > 1 ? "s" : "");
    table.add(row, arithmetic_mib, needed / mebi);
    table.add(row, mib, used / mebi);
    table.add(row, memory_ratio, used / needed, at_most(1.1));
  }
  return table;
}

}  // namespace

double film_memory(int size, int lanes, int threads) {
  const auto render_at = [&](int pixels) {
    SceneSpec spec = peer_scene({}, pixels, 1);
    for (int i = 1; i < lanes; ++i) spec.more_absorptions.push_back({RgbAbsorber{}, 0.1 * i});
    render(*build_scene(spec), SampleTarget{8}, threads);
  };
  render_at(16);
  ::malloc_trim(0);
  const double before = peak_memory();
  render_at(size);
  return peak_memory() - before;
}

Tables pixels(Run& run) { return {times(run), memory(run)}; }

}  // namespace translucube::speed

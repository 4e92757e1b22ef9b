#pragma once

#include <map>
#include <string>
#include <vector>

#include "picture/image.h"
#include "tests/bench/speed/figures.h"
#include "tests/support/peers.h"

namespace translucube::speed {

/// What Cycles is asked for: a material of the peers' list with so many samples.
struct CyclesTask {
  const char* material;
  std::uint32_t samples;
};
/// Two renders of it with independent seeds.
struct CyclesPair {
  std::vector<Image> images;
  double cpu_seconds = 0;  ///< of one, scene building left out
  std::uint32_t samples = 0;
};
struct CyclesAnswer {
  std::string version;
  std::map<std::string, CyclesPair> pairs;  ///< by material
};

/// Why Cycles is not asked in this run; empty if it is.
std::string why_not_cycles(const Run& run);

/// Renders in Blender (tests/bench/cycles.py) under an environment. `options`: of its command line.
CyclesAnswer render_in_cycles(const Run& run, const std::filesystem::path& environment, int size,
                              const std::vector<CyclesTask>& tasks,
                              const std::string& options = {});

}  // namespace translucube::speed

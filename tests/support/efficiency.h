#pragma once

// What a camera sample of the peers' materials is worth and what it takes, by counting: the same on
// every machine, but for chance where instruction sets round differently.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/relative_mse.h"

namespace translucube::test {

struct Measure {
  const char* name;
  double value;
};
using Efficiency = std::array<Measure, 4>;

inline Efficiency efficiency(const PeerMaterial& material, std::uint64_t seed) {
  constexpr int renders = 4, size = 64;
  constexpr std::uint32_t samples = 16;
  constexpr double aside = 0.02;  // fireflies tell more about chance than about the renderer
  std::vector<Image> images;
  TraceCounters counters;
  for (int i = 0; i < renders; ++i) {
    const SceneSpec spec = peer_scene(material.coefficients, size, hash_combine(seed, i));
    const Film film = trace(*build_scene(spec), samples);
    images.push_back(develop(film));
    counters += film.counters;
  }
  const Image reference = reference_of(images, material.coefficients);
  double error = 0;
  for (int i = 0; i < renders; i += 2)
    error += rel_mse_of_pair(images[i], images[i + 1], reference, aside).trimmed / (renders / 2);
  const auto n = static_cast<double>(counters.camera_samples);
  return {{{"relative variance", error * samples},
           {"flights", static_cast<double>(counters.flights) / n},
           {"boundary events", static_cast<double>(counters.boundary_events) / n},
           {"next-event estimations", static_cast<double>(counters.light_samples) / n}}};
}

}  // namespace translucube::test

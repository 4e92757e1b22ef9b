// The peers' scene and materials: error x time next to theirs, and the work behind it.

#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"

namespace translucube::speed {
namespace {

constexpr Quantity trimmed{"relMSE", "%.3g", 0.3}, untrimmed{"untrimmed", "%.3g", 1.0},
    cost{"relMSE × CPU s"}, peer{"best peer", "%g"}, peers_over_ours{"peer / ours"};
constexpr Quantity events{"boundary events", "%.2f", 0.02}, red{"mean R", "%.4f"},
    green{"mean G", "%.4f"}, blue{"mean B", "%.4f"};

/// relMSE x CPU s at 256 x 256.
struct Aim {
  const char* material;
  double target;
  double best_peer;  ///< of Cycles, Mitsuba 0.6 and pbrt-v4
};
constexpr Aim aims[] = {{"A0", 3e-4, .0086}, {"A2", 1e-4, .0044}, {"R05", .008, .26},
                        {"R10", .008, .29},  {"R25", .006, .25},  {"R50", .004, .16},
                        {"S01", .006, .36},  {"S1", .01, 2.1},    {"S10", .02, 11.5},
                        {"S100", .03, 44},   {"M", .02, 3.6},     {"C", .01, 9.5}};

Pair render_material(Run& run, const PeerMaterial& material, bool multiple_scattering) {
  SceneSpec spec = peer_scene(material.coefficients, 256, 0);
  spec.material.multiple_scattering = multiple_scattering;
  return render_pair(run, spec, run.material_samples > 0 ? run.material_samples : run.samples(64));
}

void add_costs(Table& table, const PeerMaterial& material, const Pair& pair, double best_peer,
               std::optional<Target> target) {
  const RelMse error = pair.error();
  const double seconds = pair.cpu_seconds;
  table.add(material.name, cpu_seconds, seconds);
  table.add(material.name, ns_a_sample, pair.ns_per_sample());
  table.add(material.name, trimmed, error.trimmed);
  table.add(material.name, untrimmed, error.untrimmed);
  table.add(material.name, untrimmed_cost, error.untrimmed * seconds);
  table.add(material.name, cost, error.trimmed * seconds, target);
  table.add(material.name, peer, best_peer);
  table.add(material.name, peers_over_ours, best_peer / (error.trimmed * seconds));
}

void add_work(Table& table, const char* name, const Pair& pair) {
  const auto samples = static_cast<double>(pair.counters.camera_samples);
  table.add(name, flights, static_cast<double>(pair.counters.flights) / samples);
  table.add(name, events, static_cast<double>(pair.counters.boundary_events) / samples);
  table.add(name, connections, static_cast<double>(pair.counters.light_samples) / samples);
  double mean[3] = {};
  for (const Image* image : {&pair.a, &pair.b})
    for (std::size_t i = 0; i < image->pixels.size(); ++i)
      mean[i % 3] += 1.5 * image->pixels[i] / static_cast<double>(image->pixels.size());
  table.add(name, red, mean[0]);
  table.add(name, green, mean[1]);
  table.add(name, blue, mean[2]);
}

}  // namespace

Tables materials(Run& run) {
  Table costs{"materials", "Error × time on the peers' materials",
              "A sphere of 1 mm in the forest, 256 × 256 pixels, 64 camera samples at full effort. "
              "Rough interfaces with multiple scattering between their microfacets, where the "
              "peers' figures are without."};
  Table work{"work", "Work a sample",
             "What each camera sample of those renders takes: free flights and large steps, "
             "Fresnel or microfacet events, next-event estimations; and the mean of the image."};
  for (const Aim& aim : aims) {
    if (!run.chosen(aim.material)) continue;
    const PeerMaterial& material = peer_material(aim.material);
    const Pair pair = render_material(run, material, true);
    add_costs(costs, material, pair, aim.best_peer, at_most(aim.target));
    add_work(work, material.name, pair);
  }
  return {costs, work};
}

Tables single_scattering(Run& run) {
  Table table{"single", "Single scattering between microfacets",
              "The rough interfaces as the peers have them: light that meets a second microfacet "
              "is lost."};
  for (const Aim& aim : aims) {
    const PeerMaterial& material = peer_material(aim.material);
    if (!run.chosen(aim.material) || material.name[0] != 'R') continue;
    add_costs(table, material, render_material(run, material, false), aim.best_peer, {});
  }
  return {table};
}

}  // namespace translucube::speed

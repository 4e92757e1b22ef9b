// Dense bodies: neither the time nor the error of a sample may follow the density.

#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"

namespace translucube::speed {
namespace {

constexpr Quantity time_growth{"time, of σR = 30"},
    noise_of_sample{"relMSE × samples", "%.3g", 0.3}, error_growth{"error, of σR = 30"};
constexpr double densities[] = {30, 100, 300, 1e3, 1e4, 1e5, 1e6};
/// Two renders tell the error to a few percent.
constexpr double noise = 1.05;

}  // namespace

Tables density(Run& run) {
  Table table{
      "density", "Density",
      "The peers' scene at 128 × 128 pixels, smooth, over the optical radius σ_s R: from 30 "
      "to 1e6 a sample may take 1.5 times as long, and its error may not grow (5 % are left "
      "to the noise of the measurement)."};
  for (const double sigma_s : densities) {
    const Pair pair = render_pair(run, peer_scene({0, 0, sigma_s}, 128, 0), run.samples(64));
    const std::string row = text("σR %g", sigma_s);
    const auto samples = static_cast<double>(pair.counters.camera_samples);
    table.add(row, ns_a_sample, pair.ns_per_sample());
    table.add(row, time_growth, table.value(row, ns_a_sample) / table.value("σR 30", ns_a_sample),
              at_most(1.5));
    table.add(row, noise_of_sample, pair.error().trimmed * pair.samples);
    table.add(row, error_growth,
              table.value(row, noise_of_sample) / table.value("σR 30", noise_of_sample),
              at_most(noise));
    table.add(row, flights, static_cast<double>(pair.counters.flights) / samples);
    table.add(row, connections, static_cast<double>(pair.counters.light_samples) / samples);
  }
  table.plots.push_back({"density", "Time and error of a sample over the density"});
  return {table};
}

}  // namespace translucube::speed

// The peers' materials: image means against exact transport, and developed explorable films.

#include <algorithm>
#include <array>

#include "tests/bench/accuracy/images.h"
#include "tests/bench/accuracy/sections.h"
#include "tests/support/explorable_error.h"

namespace translucube::accuracy {

using namespace test;

Table image_means(Run& run) {
  Table table{
      "means", "Image means of the peers' materials",
      "Mean of each channel over the image of a sphere of 1 mm in the forest, against exact "
      "transport by other programs, whose stated errors are taken as standard errors. "
      "alpha, sigma_s and sigma_a [1/mm], the latter times (0.15, 1, 1). The rough ones with "
      "single scattering, as the peers have it."};
  struct Peer {
    const char* name;
    Coefficients coefficients;
    std::array<double, 3> mean;
    double error;
    const char* source;
  };
  const char *const three = "Mitsuba, pbrt-v4, independent program",
                    *const both = "Mitsuba, pbrt-v4", *const own = "independent program";
  const Peer peers[] = {
      {"A0", {0, 0, 0}, {.2259, .2303, .1832}, 1e-4, three},
      {"A2", {1, 0, 0}, {.1887, .1133, .0787}, 1e-4, "Mitsuba, independent program"},
      {"R05", {0, .05, 0}, {.2268, .2304, .1827}, 3e-4, both},
      {"R10", {0, .1, 0}, {.2220, .2250, .1778}, 3e-4, both},
      {"R25", {0, .25, 0}, {.1952, .1976, .1526}, 5e-4, both},
      {"S01", {0, 0, .1}, {.2424, .2474, .2047}, 2e-4, three},
      {"S1", {0, 0, 1}, {.3142, .3204, .2942}, 2e-4, three},
      {"S10", {0, 0, 10}, {.4065, .3991, .3563}, 3e-4, own},
      {"S100", {0, 0, 100}, {.4453, .4297, .3731}, 3e-4, own},
      {"C", {1, 0, 10}, {.3190, .1937, .1546}, 2e-4, own}};
  for (const Peer& peer : peers) {
    SceneSpec spec = peer_scene(peer.coefficients, 128, run.next_seed());
    spec.material.multiple_scattering = false;
    const auto means = channel_means(
        render(*build_scene(spec), SampleTarget{run.samples(256)}, run.threads()).film);
    for (int c = 0; c < 3; ++c)
      table.add(
          text("%s (%g, %g, %g), %s", peer.name, peer.coefficients.alpha, peer.coefficients.sigma_s,
               peer.coefficients.sigma_a_peak, std::array{"red", "green", "blue"}[c]),
          means[c], {peer.mean[c], peer.error, 0, peer.source});
  }
  return table;
}

Table explorable_films(Run& run) {
  Table table{
      "explorable", "Explorable films",
      "An explorable render keeps path lengths in bins, from which any absorber is developed "
      "later. Its error against exact lanes of the same paths, in units of the clear pixel: "
      "the largest over all pixels and channels, and the mean, over a spectral glass, a dye of "
      "a narrow band and plain RGB, r of 0, 0.3 and 1, and s of 0, 0.1, 0.5, 0.9, 0.99 and "
      "1. Bounds to keep: 0.001 and 0.0002. Most of it is the half floats that the film is kept in "
      "(up to 2^-11 = 0.00049 of a value), whatever the absorption; *bins alone* leaves them out."};
  constexpr double reference_mm = 10, densest = 37 / reference_mm;
  constexpr double axis[] = {0.02, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 0.9999};
  const Absorber absorbers[] = {
      SpectralAbsorber{{400, 560, 620, 700}, {1, 0.8, 0.1, 0.05}},
      SpectralAbsorber{{380, 500, 540, 560, 600, 780}, {0.01, 0.2, 1, 0.8, 0.02, 0}},
      RgbAbsorber{{0.15, 1, 0.5}}};
  std::vector<Absorption> absorptions;
  for (const double a : axis)
    for (const Absorber& absorber : absorbers)
      absorptions.push_back({absorber, from_cube({a, 0, 0}, 0, reference_mm).sigma_a_peak});
  constexpr double rs[] = {0, 0.3, 1}, ss[] = {0, 0.1, 0.5, 0.9, 0.99, 1};
  std::vector<ExplorableError> worst(std::size(axis));
  for (const double r : rs)
    for (const double s : ss) {
      SceneSpec spec;
      spec.material.coefficients = from_cube({0, r, s}, 0, reference_mm);
      spec.material.absorber = absorbers[0];
      spec.width = spec.height = 24;
      spec.environment.source = ConstantEnvironmentSpec{Rgb{1, 0.8f, 0.6f}};
      spec.seed = run.next_seed();
      const std::vector<ExplorableError> errors =
          explorable_errors(spec, absorptions, densest, run.samples(32), run.threads());
      for (std::size_t i = 0; i < errors.size(); ++i) {
        ExplorableError& at = worst[i / std::size(absorbers)];
        const double share = 1.0 / (std::size(absorbers) * std::size(rs) * std::size(ss));
        for (const auto part : {&ExplorableError::film, &ExplorableError::bins}) {
          (at.*part).largest = std::max((at.*part).largest, (errors[i].*part).largest);
          (at.*part).mean += (errors[i].*part).mean * share;
        }
      }
    }
  for (std::size_t i = 0; i < worst.size(); ++i) {
    const std::string row = text("absorption %g", axis[i]);
    const Truth largest{0, 0, 1e-3, "bound"}, mean{0, 0, 2e-4, "bound"};
    table.add_column(row, "largest", {worst[i].film.largest, 0}, largest);
    table.add_column(row, "mean", {worst[i].film.mean, 0}, mean);
    table.add_column(row, "largest, bins alone", {worst[i].bins.largest, 0}, largest);
    table.add_column(row, "mean, bins alone", {worst[i].bins.mean, 0}, mean);
  }
  table.plots.push_back({"explorable", "Error of explorable films over the absorption"});
  return table;
}

}  // namespace translucube::accuracy

#include "renderer/slab/appearance.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "renderer/base/parallel.h"
#include "renderer/slab/adding.h"
#include "renderer/slab/walk.h"

namespace translucube {
namespace {

using namespace slab;

/// Independent estimates whose spread tells the standard error.
constexpr int replicates = 32;

/// All replicates of one incidence.
struct Trial {
  Incidence incidence;
  std::vector<Tally> tallies;
  std::uint64_t histories = 0, wanted = 0;  ///< of each replicate
  Readings readings;

  bool pending() const { return histories < wanted; }
};

/// Histories of a replicate before the first look: light that so many have missed altogether is
/// less than half of the standard error that is asked for.
std::uint64_t first_histories(double standard_error) {
  return std::bit_ceil(static_cast<std::uint64_t>(2 / standard_error / replicates));
}

/// Histories of a replicate after `histories` gave `error`: a little more than it takes, in steps
/// of an eighth of a power of two for the sake of the low-discrepancy points.
std::uint64_t next_histories(std::uint64_t histories, double error, double standard_error) {
  const double ratio = std::min(error / standard_error, 8.0);
  const auto wanted =
      static_cast<std::uint64_t>(1.05 * static_cast<double>(histories) * ratio * ratio);
  const std::uint64_t step = std::max<std::uint64_t>(1, std::bit_floor(wanted) / 8);
  return std::max(histories + histories / 8 + 1, (wanted + step - 1) / step * step);
}

void trace(const Body& body, std::uint64_t seed, std::vector<Trial*> trials, int threads) {
  parallel_for(threads, replicates * static_cast<int>(trials.size()), [&](int i) {
    Trial& trial = *trials[i / replicates];
    const int replicate = i % replicates;
    const std::uint64_t key = hash_combine(
        seed, 2 * std::uint64_t(replicate) + (trial.incidence == Incidence::normal ? 0 : 1));
    walk(body, trial.incidence, key, trial.histories, trial.wanted - trial.histories,
         trial.tallies[replicate]);
  });
  for (Trial* trial : trials) trial->histories = trial->wanted;
}

/// What make_interior() makes, without the tables of the infinitely dense body: all that it
/// reflects is known.
AnyInterior slab_interior(const Material& material, double thickness_mm) {
  const Coefficients& c = material.coefficients;
  if (std::isinf(c.sigma_s) && !std::isinf(c.sigma_a_peak)) return LambertianInterior{};
  return make_interior(material, thickness_mm);
}

/// Pigments of infinite density reflect as a half space. A slab of so many transport mean free
/// paths is one: what it transmits, at most 4/3e-6, bounds what the rest would send back.
Material with_finite_pigment(Material material, double thickness_mm) {
  if (!material.absorption_per_scattering || !std::isinf(material.coefficients.sigma_s))
    return material;
  if (*material.absorption_per_scattering == 0) {
    material.absorption_per_scattering.reset();  // white: the interfaced Lambertian slab
    return material;
  }
  material.coefficients.sigma_s = 1e6 / (1 - material.g) / thickness_mm;
  material.coefficients.sigma_a_peak =
      *material.absorption_per_scattering * material.coefficients.sigma_s;
  return material;
}

/// Both incidences by walks, until every total has the standard error.
std::array<Trial, 2> walk_until(const Body& body, const Channels& channels, double standard_error,
                                std::uint64_t seed, int threads) {
  const double peak = *std::max_element(channels.sigma_a.begin(), channels.sigma_a.end());
  const bool walks = needs_walks(body);
  Developer developer(channels, peak);
  std::array<Trial, 2> trials{Trial{Incidence::normal, {}, 0, 0, {}},
                              Trial{Incidence::diffuse, {}, 0, 0, {}}};
  for (Trial& trial : trials) {
    trial.readings.unwalked = read_unwalked(body, trial.incidence, channels);
    trial.tallies.assign(walks ? replicates : 0, Tally(std::isinf(peak) ? 0 : peak));
    trial.wanted = walks ? first_histories(standard_error) : 0;
  }
  while (trials[0].pending() || trials[1].pending()) {
    std::vector<Trial*> pending;
    for (Trial& trial : trials)
      if (trial.pending()) pending.push_back(&trial);
    trace(body, seed, pending, threads);
    for (Trial* trial : pending) {
      trial->readings.replicates.clear();
      for (const Tally& tally : trial->tallies)
        trial->readings.replicates.push_back(
            developer.develop(tally, static_cast<double>(trial->histories)));
      const double error = largest_error_of_totals(trial->readings);
      if (!std::isfinite(error)) throw std::runtime_error("slab optics that are not finite: a bug");
      if (error > standard_error)
        trial->wanted = next_histories(trial->histories, error, standard_error);
    }
  }
  return trials;
}

}  // namespace

SlabAppearance slab_appearance(const Material& given, double thickness_mm, double standard_error,
                               std::uint64_t seed, int threads) {
  const Material material = with_finite_pigment(given, thickness_mm);
  const auto start = std::chrono::steady_clock::now();
  const Channels channels = make_channels(material, thickness_mm);
  const double least = *std::min_element(channels.sigma_a.begin(), channels.sigma_a.end());
  const Body body{make_interface(material), slab_interior(material, thickness_mm), least};

  SlabAppearance appearance;
  appearance.transport = transport_name(body.interior);
  std::array<Readings, 2> at;
  if (auto added = add_layers(body, channels, standard_error, seed, threads)) {
    at = std::move(added->at);
    appearance.samples = added->samples;
    appearance.transport = "adding-doubling";
  } else {
    auto trials = walk_until(body, channels, standard_error, seed, threads);
    for (const int i : {0, 1}) {
      appearance.samples += trials[i].histories * trials[i].tallies.size();
      at[i] = std::move(trials[i].readings);
    }
  }
  appearance.normal = optics_of(at[0]);
  appearance.diffuse = optics_of(at[1]);
  appearance.haze = haze_of(at[0]);
  appearance.clarity = clarity_of(at[0]);
  appearance.largest_standard_error =
      std::max(largest_error_of_totals(at[0]), largest_error_of_totals(at[1]));
  appearance.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return appearance;
}

}  // namespace translucube

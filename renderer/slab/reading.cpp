#include "renderer/slab/reading.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/spectrum.h"
#include "renderer/slab/direct.h"

namespace translucube {

std::array<double, 3> cielab(const std::array<double, 3>& xyz, const std::array<double, 3>& white) {
  std::array<double, 3> f;
  for (int i = 0; i < 3; ++i) {
    constexpr double knee = 6.0 / 29;
    const double t = xyz[i] / white[i];
    f[i] = t > knee * knee * knee ? std::cbrt(t) : t / (3 * knee * knee) + 4.0 / 29;
  }
  return {116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])};
}

}  // namespace translucube

namespace translucube::slab {
namespace {

template <class Change>
void for_each_part(Reading& a, const Reading& b, Change&& change) {
  const auto merge = [&](std::vector<double>& x, const std::vector<double>& y) {
    for (std::size_t i = 0; i < x.size(); ++i) change(x[i], y[i]);
  };
  merge(a.specular, b.specular);
  merge(a.regular, b.regular);
  for (int exit = 0; exit < exit_count; ++exit) merge(a.diffuse[exit], b.diffuse[exit]);
}

/// a + factor * b
Reading plus(Reading a, const Reading& b, double factor) {
  for_each_part(a, b, [&](double& x, double y) { x += factor * y; });
  return a;
}

Reading empty_read(std::size_t readouts) {
  Reading read;
  read.specular.assign(readouts, 0);
  read.regular.assign(readouts, 0);
  for (std::vector<double>& diffuse : read.diffuse) diffuse.assign(readouts, 0);
  return read;
}

/// All the light, by the mean of the replicates.
Reading mean(const Readings& readings) {
  Reading sum = readings.unwalked;
  for (const Reading& replicate : readings.replicates)
    sum = plus(std::move(sum), replicate, 1.0 / static_cast<double>(readings.replicates.size()));
  return sum;
}

/// What `of` makes of the mean without one replicate, for each.
template <class Of>
auto leave_one_out(const Readings& readings, const Reading& whole, Of&& of) {
  std::vector<decltype(of(whole))> values;
  const double n = static_cast<double>(readings.replicates.size());
  for (const Reading& replicate : readings.replicates) {
    // unwalked + (n m - r) / (n - 1), with m = whole - unwalked
    Reading rest = plus(whole, readings.unwalked, -1);
    rest = plus(std::move(rest), replicate, -1 / n);
    const Reading scaled = std::move(rest);
    values.push_back(of(plus(readings.unwalked, scaled, n / (n - 1))));
  }
  return values;
}

double jackknife(const std::vector<double>& values) {
  if (values.empty()) return 0;
  const double n = static_cast<double>(values.size());
  double centre = 0, squares = 0;
  for (const double v : values) centre += v / n;
  for (const double v : values) squares += (v - centre) * (v - centre);
  return std::sqrt(squares * (n - 1) / n);
}

std::array<double, 3> to_xyz(const std::array<double, 3>& rgb) {
  std::array<double, 3> xyz{};
  for (int row = 0; row < 3; ++row)
    for (int c = 0; c < 3; ++c) xyz[row] += rgb_to_xyz[row][c] * rgb[c];
  return xyz;
}

double luminance_of(const std::vector<double>& readouts) {
  return to_xyz({readouts[0], readouts[1], readouts[2]})[1];
}

SlabLight light_of(const std::vector<double>& direct, const std::vector<double>& diffuse) {
  SlabLight light;
  for (int c = 0; c < 3; ++c) {
    light.direct[c] = direct[c];
    light.diffuse[c] = diffuse[c];
    light.total[c] = direct[c] + diffuse[c];
  }
  light.xyz = to_xyz(light.total);
  light.lab = cielab(light.xyz, to_xyz({1, 1, 1}));
  for (std::size_t i = 3; i < direct.size(); ++i) light.bands.push_back(direct[i] + diffuse[i]);
  return light;
}

SlabOptics optics_of(const Reading& read) {
  const auto at = [&](Exit exit) { return read.diffuse[static_cast<int>(exit)]; };
  std::vector<double> transmitted = at(Exit::core);
  for (const Exit exit : {Exit::ring, Exit::wide})
    for (std::size_t i = 0; i < transmitted.size(); ++i) transmitted[i] += at(exit)[i];
  return {light_of(read.specular, at(Exit::reflected)), light_of(read.regular, transmitted)};
}

/// Calls `visit` for every number of a light, in a fixed order.
template <class Light, class Visit>
void visit_numbers(Light& optics, Visit&& visit) {
  for (auto* light : {&optics.reflected, &optics.transmitted}) {
    for (auto* triple : {&light->direct, &light->diffuse, &light->total, &light->xyz, &light->lab})
      for (auto& number : *triple) visit(number);
    for (auto& number : light->bands) visit(number);
  }
}

/// A ratio and its error; empty where it is not defined for every set of replicates.
template <class Ratio>
std::optional<SlabAppearance::Estimate> estimate_ratio(const Readings& readings, Ratio&& ratio) {
  const Reading whole = mean(readings);
  std::vector<double> values;
  for (const std::optional<double>& v : leave_one_out(readings, whole, ratio)) {
    if (!v) return std::nullopt;
    values.push_back(*v);
  }
  const std::optional<double> value = ratio(whole);
  if (!value) return std::nullopt;
  return SlabAppearance::Estimate{*value, jackknife(values)};
}

}  // namespace

Reading read_unwalked(const Body& body, Incidence incidence, const Channels& channels) {
  Reading read = empty_read(channels.readouts.size());
  const bool dense = std::holds_alternative<LambertianInterior>(body.interior);
  const bool black = std::holds_alternative<BlackInterior>(body.interior);
  if (const auto* smooth = std::get_if<SmoothInterface>(&body.interface)) {
    const auto* scattering = std::get_if<ScatteringInterior>(&body.interior);
    double sigma_s = scattering ? scattering->medium.sigma_s : 0;
    if (dense || black) sigma_s = std::numeric_limits<double>::infinity();
    std::vector<double> specular, regular;
    for (const double sigma_a : channels.sigma_a) {
      const DirectLight light = incidence == Incidence::normal
                                    ? direct_light(smooth->ior, sigma_s + sigma_a, 1)
                                    : direct_light_diffuse(smooth->ior, sigma_s + sigma_a);
      specular.push_back(light.reflected);
      regular.push_back(light.transmitted);
    }
    read.specular = channels.read(specular);
    read.regular = channels.read(regular);
  }
  // The infinitely dense body sends everything back that crosses its interface.
  if (dense) {
    std::vector<double>& diffuse = read.diffuse[static_cast<int>(Exit::reflected)];
    for (std::size_t i = 0; i < diffuse.size(); ++i) diffuse[i] = 1 - read.specular[i];
  }
  return read;
}

Developer::Developer(const Channels& channels, double sigma_a_peak)
    : channels_(channels), sigma_a_peak_(sigma_a_peak) {}

Reading Developer::develop(const Tally& tally, double histories) {
  while (table_.size() < tally.used()) {
    // A single node holds light of all lengths of a body that absorbs none of it.
    const double depth = Tally::depth_at(table_.size());
    std::vector<double> transmitted;
    for (const double sigma_a : channels_.sigma_a)
      transmitted.push_back(depth == 0 ? 1 : std::exp(-sigma_a / sigma_a_peak_ * depth));
    table_.push_back(channels_.read(transmitted));
  }
  Reading read = empty_read(channels_.readouts.size());
  for (int exit = 0; exit < exit_count; ++exit) {
    const std::vector<double>& weights = tally.weights(static_cast<Exit>(exit));
    for (std::size_t node = 0; node < tally.used(); ++node) {
      if (weights[node] == 0) continue;
      const double weight = weights[node] / histories;
      for (std::size_t i = 0; i < table_[node].size(); ++i)
        read.diffuse[exit][i] += weight * table_[node][i];
    }
  }
  return read;
}

SlabAppearance::AtIncidence optics_of(const Readings& readings) {
  const Reading whole = mean(readings);
  SlabAppearance::AtIncidence at{optics_of(whole), optics_of(whole)};
  std::vector<std::vector<double>> values;  // of every number, without each of the replicates
  for (const SlabOptics& optics :
       leave_one_out(readings, whole, [](const Reading& read) { return optics_of(read); })) {
    std::size_t i = 0;
    visit_numbers(optics, [&](double number) {
      if (i == values.size()) values.emplace_back();
      values[i++].push_back(number);
    });
  }
  std::size_t i = 0;
  visit_numbers(at.standard_error,
                [&](double& number) { number = values.empty() ? 0 : jackknife(values[i++]); });
  return at;
}

std::optional<SlabAppearance::Estimate> haze_of(const Readings& readings) {
  return estimate_ratio(readings, [](const Reading& read) -> std::optional<double> {
    const SlabOptics optics = optics_of(read);
    const double total = optics.transmitted.xyz[1];
    if (!(total > 0)) return std::nullopt;
    return luminance_of(read.diffuse[static_cast<int>(Exit::wide)]) / total;
  });
}

std::optional<SlabAppearance::Estimate> clarity_of(const Readings& readings) {
  return estimate_ratio(readings, [](const Reading& read) -> std::optional<double> {
    const double core =
        luminance_of(read.regular) + luminance_of(read.diffuse[static_cast<int>(Exit::core)]);
    const double ring = luminance_of(read.diffuse[static_cast<int>(Exit::ring)]);
    if (!(core + ring > 0)) return std::nullopt;
    return (core - ring) / (core + ring);
  });
}

double largest_error_of_totals(const Readings& readings) {
  const SlabOptics errors = optics_of(readings).standard_error;
  double largest = 0;
  for (const SlabLight* light : {&errors.reflected, &errors.transmitted})
    for (const double error : light->total) {
      if (!std::isfinite(error)) return error;
      largest = std::max(largest, error);
    }
  return largest;
}

}  // namespace translucube::slab

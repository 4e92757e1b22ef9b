// Speed against error on the scene and materials of the peers (docs/speed.md): for each material
// two independent renders, relMSE = mean (a - b)^2 / (2 (ref^2 + 0.01)), with and without the 0.1 %
// largest pixels, times CPU seconds. Prints a table, and JSON where --json FILE asks for it.
//
//   peers [--samples N] [--size N] [--threads N] [--json FILE] [--only A0,S1] [--seed N]
//         [--microfacets multiple|single]   (the peers scatter once only)

#include "tests/support/peers.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace {

using namespace translucube;

struct PeerMaterial {
  const char* name;
  double alpha, sigma_s, sigma_a;
  double best_peer;  ///< relMSE x CPU s of the best of Cycles, Mitsuba 0.6 and pbrt-v4
};
// Coefficients [1/mm] on a sphere of radius 1 mm; absorption times (0.15, 1, 1).
constexpr PeerMaterial materials[] = {
    {"A0", 0, 0, 0, .0086},  {"A2", 0, 0, 1, .0044},  {"R05", .05, 0, 0, .26},
    {"R10", .1, 0, 0, .29},  {"R25", .25, 0, 0, .25}, {"R50", .5, 0, 0, .16},
    {"S01", 0, .1, 0, .36},  {"S1", 0, 1, 0, 2.1},    {"S10", 0, 10, 0, 11.5},
    {"S100", 0, 100, 0, 44}, {"M", .1, 5, .2, 3.6},   {"C", 0, 10, 1, 9.5}};

SceneSpec scene_of(const PeerMaterial& m, bool multiple, int size, std::uint64_t seed) {
  SceneSpec spec = test::peer_scene({m.sigma_a, m.alpha, m.sigma_s}, size, seed);
  spec.material.multiple_scattering = multiple;
  return spec;
}

/// Every pixel by its surroundings.
Image smoothed(const Image& image) {
  Image out(image.width, image.height);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x)
      for (int c = 0; c < 3; ++c)
        out.pixels[3 * (std::size_t(y) * image.width + x) + c] =
            static_cast<float>(test::smoothed(image, x, y, c));
  return out;
}

struct RelMse {
  double trimmed, untrimmed;
};
RelMse rel_mse(const Image& a, const Image& b, bool sharp) {
  Image reference = a;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    reference.pixels[i] = (a.pixels[i] + b.pixels[i]) / 2;
  if (!sharp) reference = smoothed(reference);
  std::vector<double> error(a.pixels.size() / 3, 0);
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const double d = a.pixels[i] - b.pixels[i], r = reference.pixels[i];
    error[i / 3] += d * d / (2 * (r * r + 0.01)) / 3;
  }
  std::ranges::sort(error);
  const std::size_t kept = error.size() - error.size() / 1000;
  double trimmed = 0, all = 0;
  for (std::size_t i = 0; i < error.size(); ++i) {
    all += error[i];
    if (i < kept) trimmed += error[i];
  }
  return {trimmed / static_cast<double>(kept), all / static_cast<double>(error.size())};
}

}  // namespace

int main(int argc, char** argv) {
  std::uint32_t samples = 64;
  int size = 256, threads = 0;
  std::uint64_t seed = 1;
  bool multiple = true;
  std::string json_file, only;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i], value = argv[i + 1];
    if (option == "--samples")
      samples = static_cast<std::uint32_t>(std::stoul(value));
    else if (option == "--size")
      size = std::stoi(value);
    else if (option == "--threads")
      threads = std::stoi(value);
    else if (option == "--json")
      json_file = value;
    else if (option == "--only")
      only = "," + value + ",";
    else if (option == "--seed")
      seed = std::stoull(value);
    else if (option == "--microfacets" && (value == "multiple" || value == "single"))
      multiple = value == "multiple";
    else
      return std::fprintf(stderr, "peers: unknown option %s\n", option.c_str()), 2;
  }
  nlohmann::json report = nlohmann::json::array();
  std::printf("%-5s %7s %8s %8s %10s %10s %10s %9s %7s   %s\n", "", "samples", "CPU s", "ns",
              "relMSE", "untrimmed", "x CPU", "peer", "ratio", "mean R G B");
  for (const PeerMaterial& m : materials) {
    if (!only.empty() && only.find("," + std::string(m.name) + ",") == std::string::npos) continue;
    const SampleTarget target{samples};
    const RenderResult first =
        render(*build_scene(scene_of(m, multiple, size, seed)), target, threads);
    const RenderResult second =
        render(*build_scene(scene_of(m, multiple, size, seed + 1)), target, threads);
    const Image a = develop(first.film), b = develop(second.film);
    const RelMse error = rel_mse(a, b, m.alpha == 0 && m.sigma_s == 0);
    const double cpu = (first.stats.cpu_seconds + second.stats.cpu_seconds) / 2;
    const double ns = 1e9 * cpu / (double(samples) * size * size);
    double mean[3] = {};
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
      mean[i % 3] += (a.pixels[i] + b.pixels[i]) / 2.0 / (double(size) * size);
    const double cost = error.trimmed * cpu;
    std::printf("%-5s %7u %8.3f %8.1f %10.3g %10.3g %10.3g %9.3g %7.1f   %.5f %.5f %.5f\n", m.name,
                samples, cpu, ns, error.trimmed, error.untrimmed, cost, m.best_peer,
                m.best_peer / cost, mean[0], mean[1], mean[2]);
    std::fflush(stdout);
    report.push_back(
        {{"material", m.name},
         {"samples", samples},
         {"size", size},
         {"cpu_seconds", cpu},
         {"ns_per_sample", ns},
         {"relmse", error.trimmed},
         {"relmse_untrimmed", error.untrimmed},
         {"relmse_cpu_seconds", cost},
         {"relmse_untrimmed_cpu_seconds", error.untrimmed * cpu},
         {"relative_error_estimate", first.stats.relative_error},
         {"best_peer", m.best_peer},
         {"mean", {mean[0], mean[1], mean[2]}},
         {"flights_per_sample",
          double(first.film.counters.flights) / double(first.film.counters.camera_samples)},
         {"connections_per_sample",
          double(first.film.counters.connections) / double(first.film.counters.camera_samples)},
         {"boundary_events_per_sample", double(first.film.counters.boundary_events) /
                                            double(first.film.counters.camera_samples)}});
  }
  if (!json_file.empty()) std::ofstream(json_file) << report.dump(2) << "\n";
}

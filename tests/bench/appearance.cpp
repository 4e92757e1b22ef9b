// CPU seconds that slab optics take to a standard error: appearance [--error E] [--full]
// [--seeds N] [--only TEXT] [--json FILE]. The slab is 1 mm thick, its ior 1.5.
//
// "to E" scales the time by (error / E)^2, so that rounds of histories that overshoot the error
// asked for do not blur the estimator's own efficiency. "last" is the quantity with the largest
// error at the end.

#include "renderer/slab/appearance.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

using namespace translucube;

namespace {

struct Plate {
  double alpha, sigma_s, g, sigma_a;  ///< coefficients in 1/mm
};

std::vector<Plate> plates(bool full) {
  using List = std::vector<double>;
  const List alphas = full ? List{0, 0.05, 0.3, 1} : List{0, 0.3};
  const List densities =
      full ? List{0.1, 1, 3, 7, 10, 20, 30, 100, 1e3, 1e4} : List{0.1, 1, 10, 100, 1e3, 1e4};
  const List anisotropies = full ? List{-0.5, 0, 0.5, 0.9, 0.99} : List{0, 0.9, 0.99};
  std::vector<Plate> all;
  for (const double alpha : alphas)
    for (const double g : anisotropies)
      for (const double sigma_s : densities)
        for (const double sigma_a : {0.0, 0.1, 1.0}) all.push_back({alpha, sigma_s, g, sigma_a});
  return all;
}

/// Name of the total with the largest error.
std::string last_to_converge(const SlabAppearance& s) {
  std::string last = "none";
  double largest = 0;
  for (const auto& [incidence, at] : {std::pair{"normal", &s.normal}, {"diffuse", &s.diffuse}})
    for (const auto& [side, light] :
         {std::pair{"R", &at->standard_error.reflected}, {"T", &at->standard_error.transmitted}})
      for (int c = 0; c < 3; ++c)
        if (light->total[c] > largest) {
          largest = light->total[c];
          last = std::string(incidence) + ' ' + side + ' ' + "rgb"[c];
        }
  return last;
}

double cpu_seconds() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

int main(int argc, char** argv) {
  double error = 1e-3;
  int seeds = 1;
  bool full = false;
  std::string json_file, only;
  for (int i = 1; i < argc; ++i) {
    const bool more = i + 1 < argc;
    if (std::strcmp(argv[i], "--full") == 0) full = true;
    if (more && std::strcmp(argv[i], "--error") == 0) error = std::atof(argv[++i]);
    if (more && std::strcmp(argv[i], "--seeds") == 0) seeds = std::atoi(argv[++i]);
    if (more && std::strcmp(argv[i], "--only") == 0) only = argv[++i];
    if (more && std::strcmp(argv[i], "--json") == 0) json_file = argv[++i];
  }
  nlohmann::json rows = nlohmann::json::array();
  double sum = 0, worst = 0;
  int over = 0;
  for (const Plate& p : plates(full)) {
    char name[96];
    std::snprintf(name, sizeof name, "alpha %-4g g %-4g sigma_s %-6g sigma_a %-3g", p.alpha, p.g,
                  p.sigma_s, p.sigma_a);
    if (std::strstr(name, only.c_str()) == nullptr) continue;
    Material m;
    m.coefficients = {p.sigma_a, p.alpha, p.sigma_s};
    m.g = p.g;
    m.absorber = SpectralAbsorber{{380, 500, 600, 780}, {1, 0.6, 0.05, 0}};
    double cpu = 0, scaled = 0;
    SlabAppearance s;
    for (int seed = 0; seed < seeds; ++seed) {
      const double start = cpu_seconds();
      s = slab_appearance(m, 1, error, seed, 2);
      const double took = (cpu_seconds() - start) / seeds;
      cpu += took;
      scaled += took * std::pow(s.largest_standard_error / error, 2);
    }
    const std::string last = last_to_converge(s);
    std::printf("%s  cpu %6.3f s, to %g %6.3f s, %9llu histories, %5.2f us each, last %s\n", name,
                cpu, error, scaled, static_cast<unsigned long long>(s.samples),
                s.samples ? 1e6 * cpu / static_cast<double>(s.samples) : 0, last.c_str());
    std::fflush(stdout);
    rows.push_back({{"alpha", p.alpha},
                    {"g", p.g},
                    {"sigma_s", p.sigma_s},
                    {"sigma_a", p.sigma_a},
                    {"cpu_seconds", cpu},
                    {"cpu_seconds_scaled", scaled},
                    {"samples", s.samples},
                    {"standard_error", s.largest_standard_error},
                    {"last", last}});
    sum += cpu;
    worst = std::max(worst, cpu);
    over += cpu > 2;
  }
  std::printf("sum %.2f CPU s, worst %.2f, %d of %zu above 2 CPU s\n", sum, worst, over,
              rows.size());
  if (!json_file.empty()) std::ofstream(json_file) << rows.dump(1) << '\n';
}

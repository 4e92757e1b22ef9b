#include "tests/bench/speed/guard.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/bench/report/text.h"
#include "tests/support/efficiency.h"

namespace translucube::speed {
namespace {

constexpr int replicates = 8;
/// The test draws once what is averaged here: so many standard deviations of one draw are chance,
/// also where its tail is longer than Gauss's. And at least the least margin: a test that fails for
/// a percent only annoys.
constexpr double deviations = 5, least_margin = 0.02;

/// To four digits.
double rounded(double x) { return std::stod(bench::text("%.4g", x)); }

}  // namespace

std::string guard() {
  nlohmann::ordered_json file;
  for (const test::PeerMaterial& material : test::peer_materials) {
    std::vector<test::Efficiency> draws;
    for (int i = 1; i <= replicates; ++i) draws.push_back(test::efficiency(material, i));
    nlohmann::ordered_json& entry = file[material.name];
    for (std::size_t m = 0; m < draws[0].size(); ++m) {
      double sum = 0, squares = 0;
      for (const test::Efficiency& draw : draws) sum += draw[m].value;
      const double mean = sum / replicates;
      for (const test::Efficiency& draw : draws)
        squares += (draw[m].value - mean) * (draw[m].value - mean);
      const double spread = mean > 0 ? std::sqrt(squares / (replicates - 1)) / mean : 0;
      const double margin = std::max(deviations * spread, least_margin);
      entry[draws[0][m].name] = {{"ceiling", rounded(mean * (1 + margin))},
                                 {"mean", rounded(mean)},
                                 {"relative_spread", rounded(spread)}};
    }
  }
  return file.dump(1) + "\n";
}

}  // namespace translucube::speed

// Simulates how light leaves a ball of isotropic scatterers, for the tables of ball_tables.h; run
// when the project is built: make_ball_tables OUTPUT. Each level walks with the balls of the levels
// below it.

#include <algorithm>
#include <cstdio>
#include <vector>

#include "renderer/base/parallel.h"
#include "renderer/optics/ball_tables.h"

namespace {

using namespace translucube;

using Table = std::vector<BallExit>;

constexpr int walks_per_level = 1 << 19;

struct Exit {
  double mu, length;
};

/// A walk from the centre of a ball with this optical radius to its surface; lengths in mean free
/// paths.
Exit leave_ball(double radius, const std::vector<Table>& below, Rng& rng) {
  Vec3 p;
  double length = 0;
  while (true) {
    Vec3 d;
    const double room = (radius * radius - length_squared(p)) / (2 * radius);
    const int level = std::min(ball_level(room), static_cast<int>(below.size()) - 1);
    if (level >= 0) {
      const BallCrossing crossing = cross_ball(below[level], rng);
      p = p + ball_radius(level) * crossing.outward;
      d = crossing.direction;
      length += crossing.length;
    } else {
      d = sample_isotropic(rng);
    }
    const double flight = -std::log(rng.uniform_positive());
    const Vec3 q = p + flight * d;
    if (length_squared(q) >= radius * radius) {
      const double b = dot(p, d), c = radius * radius - length_squared(p);
      const double t = std::sqrt(b * b + std::fmax(c, 0.0)) - b;
      return {dot(p + t * d, d) / radius, length + t};
    }
    p = q;
    length += flight;
  }
}

std::vector<Exit> simulate(double radius, const std::vector<Table>& below, std::uint64_t key) {
  std::vector<Exit> exits(walks_per_level);
  constexpr int at_once = 1024;
  parallel_for(0, walks_per_level / at_once, [&](int part) {
    for (int i = part * at_once; i < (part + 1) * at_once; ++i) {
      Rng rng(hash_combine(key, i));
      exits[i] = leave_ball(radius, below, rng);
    }
  });
  return exits;
}

/// Equally likely representatives: one drawn from each equal share, in order of length, of each
/// stratum of mu.
Table represent(std::vector<Exit> exits, int level) {
  constexpr int strata = 64, shares = exits_per_ball / strata;
  constexpr int per_stratum = walks_per_level / strata, per_share = per_stratum / shares;
  Rng rng(hash_combine(0x7ab1e, level));
  std::ranges::sort(exits, {}, &Exit::mu);
  Table table;
  for (int s = 0; s < strata; ++s) {
    const auto begin = exits.begin() + s * per_stratum;
    std::sort(begin, begin + per_stratum,
              [](const Exit& a, const Exit& b) { return a.length < b.length; });
    for (int share = 0; share < shares; ++share) {
      const Exit& drawn = begin[share * per_share + static_cast<int>(rng.bits() % per_share)];
      table.push_back({static_cast<float>(drawn.mu), static_cast<float>(drawn.length)});
    }
  }
  // The noise left in the mean would add up over a walk. In the smallest balls much of the light
  // crosses unscattered, in a length that is known, and there is little noise.
  if (level >= 3) {
    double mean = 0;
    for (const BallExit& exit : table) mean += exit.length / table.size();
    for (BallExit& exit : table)
      exit.length = static_cast<float>(exit.length * mean_ball_length(level) / mean);
  }
  return table;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: make_ball_tables OUTPUT\n"), 2;
  std::vector<Table> tables;
  for (int level = 0; level < tabulated_levels; ++level)
    tables.push_back(represent(simulate(ball_radius(level), tables, level + 1), level));
  std::FILE* out = std::fopen(argv[1], "wb");
  if (out == nullptr) return std::perror(argv[1]), 1;
  bool written = true;
  for (const Table& table : tables)
    written &= std::fwrite(table.data(), sizeof(BallExit), table.size(), out) == table.size();
  return std::fclose(out) == 0 && written ? 0 : 1;
}

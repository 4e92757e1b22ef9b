// The time to develop an explorable film for a new absorber: develop [--size N] [--threads N].

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <limits>

#include "renderer/explorable.h"
#include "renderer/half.h"

using namespace translucube;

int main(int argc, char** argv) {
  int size = 1024, threads = 2;
  for (int i = 1; i + 1 < argc; i += 2) {
    if (std::strcmp(argv[i], "--size") == 0) size = std::atoi(argv[i + 1]);
    if (std::strcmp(argv[i], "--threads") == 0) threads = std::atoi(argv[i + 1]);
  }
  ExplorableFilm film;
  film.width = film.height = size;
  film.scales.assign(static_cast<std::size_t>(film.bins.count()), 1.0f / 1024);
  film.halves.resize(std::size_t(3) * film.bins.count() * size * size);
  std::uint32_t state = 1;
  for (std::uint16_t& half : film.halves) {
    state = state * 1664525u + 1013904223u;
    half = float_to_half(static_cast<float>(state >> 17));
  }
  const SpectralAbsorber absorber{{400, 560, 620, 700}, {1, 0.8, 0.1, 0.05}};
  double wall_ms = std::numeric_limits<double>::infinity(), cpu_ms = wall_ms;
  float sum = 0;
  for (int run = 0; run < 15; ++run) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t cpu = std::clock();
    sum += develop_explorable(film, absorber, 0.01 * (run + 1), threads).pixels[size];
    const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start;
    wall_ms = std::min(wall_ms, wall.count());
    cpu_ms = std::min(cpu_ms, 1e3 * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC);
  }
  std::printf("develop %d x %d, %d bins, %d threads: %.1f ms wall, %.1f ms CPU, best of 15 (%g)\n",
              size, size, film.bins.count(), threads, wall_ms, cpu_ms, sum);
}

// A sweep over the cube traces its (roughness, scattering) planes once, and every absorption comes
// of that.

#include <chrono>

#include "renderer/film/explorable_develop.h"
#include "renderer/optics/material_cube.h"
#include "tests/bench/report/files.h"
#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"
#include "tests/support/absorbers.h"

namespace translucube::speed {
namespace {

constexpr Quantity of_plain_images{"of 25 plain images", "%.2f"};
constexpr Quantity wall_ms{"wall ms", "%.1f"}, cpu_ms{"CPU ms", "%.1f"};
constexpr double axis[] = {0, 0.25, 0.5, 0.75, 1};

/// The service's default scene at a point of the cube.
SceneSpec scene_at(const CubePoint& point, std::uint64_t seed) {
  SceneSpec spec = peer_scene(from_cube(point, 0, reference_mm), 64, seed);
  spec.material.absorber = red_glass();
  spec.object = SphereObject{20};
  spec.camera.position_mm = {0, 0, 90};
  return spec;
}

/// CPU seconds of what `work` does, tables and scenes included.
template <class Work>
double cpu_of(Work&& work) {
  const double start = bench::process_cpu_seconds();
  work();
  return bench::process_cpu_seconds() - start;
}

Table grid_sweep(Run& run) {
  Table table{
      "sweeps", "Sweeps",
      "A 5 × 5 × 5 sweep over the cube (absorption, roughness, scattering), 64 × 64 pixels "
      "of the service's default scene: 25 traced images that are developed five times each, "
      "against 25 images of one absorption. By lanes while tracing, where the absorptions "
      "are known, or later from explorable films, where any absorber may be asked for. CPU "
      "seconds of the whole process, scenes and tables included."};
  const SampleTarget samples{run.samples(64)};
  double plain = 0, lanes = 0, explorable = 0;
  for (const double roughness : axis)
    for (const double scattering : axis) {
      const std::uint64_t seed = run.next_seed();
      std::vector<Absorption> absorptions;
      for (const double a : axis)
        absorptions.push_back({red_glass(), from_cube({a, 0, 0}, 0, reference_mm).sigma_a_peak});
      const SceneSpec one = scene_at({axis[2], roughness, scattering}, seed);
      plain += cpu_of([&] { develop(render(*build_scene(one), samples, run.threads).film); });
      SceneSpec several = scene_at({axis[0], roughness, scattering}, seed);
      several.more_absorptions.assign(absorptions.begin() + 1, absorptions.end());
      lanes += cpu_of([&] {
        const Film film = render(*build_scene(several), samples, run.threads).film;
        for (int lane = 0; lane < film.lanes; ++lane) develop(film, lane);
      });
      SceneSpec open = one;
      open.explorable = Explorable{absorptions[3].sigma_a_peak};
      explorable += cpu_of([&] {
        const auto scene = build_scene(open);
        const ExplorableFilm film =
            explorable_film(*scene, render(*scene, samples, run.threads).film);
        for (const Absorption& absorption : absorptions)
          develop_explorable(film, absorption.absorber, absorption.sigma_a_peak, run.threads);
      });
    }
  table.add("25 plain images", cpu_seconds, plain);
  table.add("25 × 5 by lanes", cpu_seconds, lanes);
  table.add("25 × 5 by lanes", of_plain_images, lanes / plain, at_most(1.2));
  table.add("25 × 5 explorable", cpu_seconds, explorable);
  table.add("25 × 5 explorable", of_plain_images, explorable / plain);
  return table;
}

/// How long another absorber takes from a film that is there.
Table developing(Run& run) {
  Table table{"develop", "Developing an explorable film",
              "Another absorber from an explorable film of the peers' S1, nothing traced; the "
              "median of 15."};
  for (const int size : {256, 1024}) {
    SceneSpec spec = peer_scene(peer_material("S1").coefficients, size, run.next_seed());
    spec.explorable = Explorable{1};
    const auto scene = build_scene(spec);
    const ExplorableFilm film =
        explorable_film(*scene, render(*scene, SampleTarget{1}, run.threads).film);
    std::vector<double> wall, used;
    for (int i = 0; i < 15; ++i) {
      const auto start = std::chrono::steady_clock::now();
      used.push_back(1e3 * cpu_of([&] {
                       develop_explorable(film, red_glass(), 0.01 * (i + 1), run.threads);
                     }));
      wall.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
              .count());
    }
    const std::string row = text("%d × %d, %d bins", size, size, film.bins.count());
    table.add(row, wall_ms, median(wall));
    table.add(row, cpu_ms, median(used));
  }
  return table;
}

}  // namespace

Tables sweeps(Run& run) { return {grid_sweep(run), developing(run)}; }

}  // namespace translucube::speed

#include "tests/bench/speed/images.h"

namespace translucube::speed {
std::vector<Snapshot> trace(const Scene& scene, const std::vector<std::uint32_t>& samples,
                            int threads, TraceCounters* counters) {
  const auto pixels = std::uint64_t(scene.width) * std::uint64_t(scene.height);
  Film film(scene.width, scene.height, scene.film_lanes(), scene.spread.has_value());
  std::vector<Snapshot> snapshots;
  while (const auto pass = plan_pass(film.passes, pixels, samples.back())) {
    merge(film, *trace_pass(scene, *pass, threads));
    if (film.samples >= samples[snapshots.size()])
      snapshots.push_back({film.samples, film.cpu_seconds, develop(film)});
  }
  if (counters) *counters = film.counters;
  return snapshots;
}

RelMse Pair::error() const { return rel_mse_of_pair(a, b, reference_of({a, b}, coefficients)); }

Pair render_pair(Run& run, SceneSpec spec, std::uint32_t samples) {
  Pair pair;
  pair.coefficients = spec.material.coefficients;
  for (Image* image : {&pair.a, &pair.b}) {
    spec.seed = run.next_seed();
    Snapshot end =
        std::move(trace(*build_scene(spec), {samples}, run.threads, &pair.counters).front());
    *image = std::move(end.image);
    pair.cpu_seconds += end.cpu_seconds / 2;
    pair.samples = end.samples;
  }
  return pair;
}

}  // namespace translucube::speed

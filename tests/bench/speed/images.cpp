#include "tests/bench/speed/images.h"

#include <algorithm>

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

double mean_value(const std::vector<Image>& images) {
  double sum = 0, count = 0;
  for (const Image& image : images) {
    for (const float p : image.pixels) sum += p;
    count += static_cast<double>(image.pixels.size());
  }
  return sum / count;
}

double largest_ratio(const Image& image, const Image& converged) {
  constexpr float visible = 0.01f;
  double ratio = 0;
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    ratio = std::max(
        ratio, double(image.pixels[i]) / std::max(double(converged.pixels[i]), double(visible)));
  return ratio;
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

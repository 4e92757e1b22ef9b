#include "renderer/render.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <ctime>

#include "renderer/base/deadline.h"
#include "renderer/base/parallel.h"
#include "renderer/film/explorable_develop.h"
#include "renderer/film/film_error.h"
#include "renderer/scene/scene.h"
#include "renderer/transport/transport.h"

namespace translucube {
namespace {

constexpr int tile_size = 16;

double thread_cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

int tile_columns(int width) { return (width + tile_size - 1) / tile_size; }

void store(const Tile& tile, PassFilm& film) {
  const std::size_t lane_size = std::size_t(3) * film.width * film.height;
  for (int lane = 0; lane < film.lanes; ++lane)
    for (int y = 0; y < tile.height; ++y) {
      const float* from = &tile.sum[pixel_floats * tile.width * (lane * tile.height + y)];
      float* to = &film.sum[lane * lane_size +
                            std::size_t(3) * ((tile.y0 + y) * std::size_t(film.width) + tile.x0)];
      for (int x = 0; x < tile.width; ++x, from += pixel_floats, to += 3)
        std::copy(from, from + 3, to);
    }
}

/// One of so many equal shares of the time that is left.
Patience share_of(const Patience& patience, double shares) {
  if (!patience.has_deadline()) return patience;
  const auto now = Patience::Clock::now();
  const auto share = std::chrono::duration_cast<Patience::Clock::duration>(
      (patience.deadline - now) / std::max(shares, 1.0));
  return {patience.stop, now + share};
}

}  // namespace

std::optional<Pass> plan_pass(std::uint32_t index, std::uint64_t pixels,
                              std::optional<std::uint32_t> total_samples) {
  // A pass is half of what lies before it, a power of two: enough replicates to tell the error by,
  // few enough to merge and store, and long enough for low-discrepancy points to pay. Bounded
  // by work, so that checkpoints stay close together.
  const auto largest = static_cast<std::uint32_t>(std::clamp<std::uint64_t>(
      std::bit_floor((std::uint64_t{1} << 22) / std::max<std::uint64_t>(pixels, 1)), 4, 4096));
  std::uint32_t first = 0, count = 4;
  for (std::uint32_t i = 0;; ++i) {
    count = std::clamp(std::bit_floor(std::max(first / 2, 1u)), 4u, largest);
    if (total_samples) {
      if (first >= *total_samples) return {};
      count = std::min(count, *total_samples - first);
    }
    if (i == index) return Pass{index, first, count};
    first += count;
  }
}

std::optional<PassFilm> trace_pass(const Scene& scene, const Pass& pass, int threads,
                                   const Patience& patience) {
  PassFilm film;
  film.width = scene.width;
  film.height = scene.height;
  film.lanes = scene.film_lanes();
  film.shares = scene.spread.has_value();
  film.pass = pass;
  film.sum.resize(std::size_t(3) * film.width * film.height * film.lanes);
  const int columns = tile_columns(film.width), rows = (film.height + tile_size - 1) / tile_size;
  std::vector<TraceCounters> counters(std::size_t(columns) * rows);
  const std::stop_token& stop = patience.stop;
  std::atomic<double> cpu_seconds{0};
  share_turns(threads, columns * rows, [&](Turns& turns) {
    const double start = thread_cpu_seconds();
    Tile tile;  // its memory serves one tile after the other: an explorable one has much
    while (!stop.stop_requested()) {
      const std::optional<int> i = turns.take();
      if (!i) break;
      tile.counters = {};
      tile.index = static_cast<std::uint32_t>(*i);
      tile.x0 = *i % columns * tile_size;
      tile.y0 = *i / columns * tile_size;
      tile.width = std::min(tile_size, film.width - tile.x0);
      tile.height = std::min(tile_size, film.height - tile.y0);
      tile.sum.assign(pixel_floats * tile.width * tile.height * film.lanes, 0.0f);
      const int at_once = std::min(thread_count(threads), columns * rows);
      const double turns_left = std::ceil(double(columns * rows - *i) / at_once);
      for (std::uint32_t s = 0; s < pass.count && !stop.stop_requested(); s += samples_at_once) {
        const double batches = std::ceil(double(pass.count - s) / samples_at_once);
        trace_tile(scene, {pass.index, s, std::min(samples_at_once, pass.count - s)}, tile,
                   share_of(patience, turns_left - 1 + batches));
      }
      store(tile, film);
      counters[*i] = tile.counters;
    }
    cpu_seconds += thread_cpu_seconds() - start;
  });
  if (stop.stop_requested()) return {};
  for (const TraceCounters& c : counters) film.counters += c;
  film.cpu_seconds = cpu_seconds;
  return film;
}

Patience::Clock::time_point deadline_of(const TimeTarget& target,
                                        Patience::Clock::time_point start) {
  constexpr double longest = 1e9;  // seconds: what a clock can count
  return start + std::chrono::duration_cast<Patience::Clock::duration>(
                     std::chrono::duration<double>(std::clamp(target.seconds, 0.0, longest)));
}

bool meets(const Quality& quality, const Film& film, double seconds) {
  struct Meets {
    const Film& film;
    double seconds;
    bool operator()(const SampleTarget& t) const { return film.samples >= t.samples; }
    bool operator()(const ErrorTarget& t) const { return relative_error(film) <= t.relative_error; }
    bool operator()(const TimeTarget& t) const { return film.passes > 0 && seconds >= t.seconds; }
  };
  return std::visit(Meets{film, seconds}, quality);
}

Progress progress_of(const Film& film, const Quality& quality, double seconds) {
  Progress progress;
  progress.passes = film.passes;
  progress.samples = film.samples;
  progress.relative_error = relative_error(film);
  progress.seconds = seconds;
  if (const auto* target = std::get_if<SampleTarget>(&quality)) {
    progress.total_samples = target->samples;
    if (film.samples > 0)
      progress.eta_seconds = seconds * (double(target->samples) / film.samples - 1);
  } else if (const auto* error = std::get_if<ErrorTarget>(&quality)) {
    // The error falls with the square root of the samples.
    const double ratio = progress.relative_error / error->relative_error;
    if (std::isfinite(ratio)) progress.eta_seconds = seconds * std::max(0.0, ratio * ratio - 1);
  } else {
    progress.eta_seconds = std::max(0.0, std::get<TimeTarget>(quality).seconds - seconds);
  }
  return progress;
}

RenderStats stats_of(const Scene& scene, const Film& film, double seconds, int threads) {
  RenderStats stats;
  stats.samples = film.samples;
  stats.seconds = seconds;
  stats.cpu_seconds = film.cpu_seconds;
  stats.threads = thread_count(threads);
  stats.relative_error = relative_error(film);
  stats.transport = transport_name(scene);
  stats.camera_inside = scene.camera_inside;
  stats.mesh = scene.mesh;
  stats.refinement = scene.refinement;
  stats.nan_samples = film.counters.nan_samples;
  stats.truncated_energy =
      film.counters.camera_samples > 0
          ? film.counters.truncated_energy / static_cast<double>(film.counters.camera_samples)
          : 0;
  return stats;
}

RenderResult render(const Scene& scene, const Quality& quality, int threads, std::stop_token stop,
                    const std::function<void(const Progress&)>& on_progress) {
  using Clock = std::chrono::steady_clock;
  const auto start = Clock::now();
  const auto seconds = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  RenderResult result;
  result.film = Film(scene.width, scene.height, scene.film_lanes(), scene.spread.has_value());
  const auto pixels = std::uint64_t(scene.width) * std::uint64_t(scene.height);
  std::optional<std::uint32_t> total;
  if (const auto* target = std::get_if<SampleTarget>(&quality)) total = target->samples;
  const auto* budget = std::get_if<TimeTarget>(&quality);
  while (!meets(quality, result.film, seconds())) {
    const std::optional<Pass> pass = plan_pass(result.film.passes, pixels, total);
    if (!pass) break;
    // A pass that overruns the time is given up; of the first one is kept what came in time.
    std::stop_source pass_stop;
    const std::stop_callback forward(stop, [&] { pass_stop.request_stop(); });
    std::optional<Deadline> deadline;
    if (budget && result.film.passes > 0) deadline.emplace(pass_stop, budget->seconds - seconds());
    Patience patience(pass_stop.get_token());
    if (budget && result.film.passes == 0) patience.deadline = deadline_of(*budget, start);
    const std::optional<PassFilm> film = trace_pass(scene, *pass, threads, patience);
    if (!film) {
      result.stopped = stop.stop_requested();
      break;
    }
    merge(result.film, *film);
    if (on_progress) on_progress(progress_of(result.film, quality, seconds()));
  }
  result.stats = stats_of(scene, result.film, seconds(), threads);
  return result;
}

std::string explain_sample(const Scene& scene, int x, int y, std::uint32_t sample) {
  const auto pixels = std::uint64_t(scene.width) * std::uint64_t(scene.height);
  Pass pass;
  for (std::uint32_t i = 0; pass.first_sample + pass.count <= sample; ++i)
    pass = *plan_pass(i, pixels);
  Tile tile;
  tile.index =
      static_cast<std::uint32_t>(y / tile_size * tile_columns(scene.width) + x / tile_size);
  tile.x0 = x;
  tile.y0 = y;
  tile.width = tile.height = 1;
  tile.sum.assign(pixel_floats * scene.film_lanes(), 0.0f);
  std::string log;
  trace_tile(scene, {pass.index, sample - pass.first_sample, 1}, tile, {}, &log);
  Rgb radiance;
  for (std::size_t lane = 0; lane < (scene.spread ? tile.sum.size() : 1); lane += pixel_floats)
    radiance += Rgb{tile.sum[lane], tile.sum[lane + 1], tile.sum[lane + 2]};
  char line[128];
  std::snprintf(line, sizeof line, "radiance (%.9g, %.9g, %.9g)\n", radiance.r, radiance.g,
                radiance.b);
  return log + line;
}

std::string transport_name(const Scene& scene) { return transport_name(scene.interior); }

std::optional<ExplorableBasis> explorable_basis(const Scene& scene) {
  if (!scene.spread) return std::nullopt;
  return ExplorableBasis{scene.spread->bins(), scene.unit_mm, scene.lanes.front()};
}

ExplorableFilm explorable_film(const Scene& scene, const Film& film) {
  return explorable_film(scene.spread.value().bins(), scene.unit_mm, film);
}

}  // namespace translucube

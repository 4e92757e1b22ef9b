#pragma once

// The renderer's public door. A render is a list of passes; each is traced on its own, on any
// machine, in any order, and merged in order. Progress, cancel, deadline, partial results and
// checkpoints are all this one mechanism.

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <variant>

#include "renderer/base/patience.h"
#include "renderer/film/absorption.h"
#include "renderer/film/explorable.h"
#include "renderer/film/film.h"
#include "renderer/film/length_bins.h"
#include "renderer/scene/spec.h"
#include "renderer/shape/smooth/refine.h"
#include "renderer/shape/triangle_mesh.h"

namespace translucube {

struct ExplorableBasis;

struct SampleTarget {
  std::uint32_t samples = 64;  ///< camera samples per pixel
  friend bool operator==(const SampleTarget&, const SampleTarget&) = default;
};
struct ErrorTarget {
  double relative_error = 0.02;  ///< stop when the estimate of sqrt(relMSE) is this or less
  friend bool operator==(const ErrorTarget&, const ErrorTarget&) = default;
};
struct TimeTarget {
  double seconds = 10;  ///< wall clock of the tracing
  friend bool operator==(const TimeTarget&, const TimeTarget&) = default;
};
using Quality = std::variant<SampleTarget, ErrorTarget, TimeTarget>;

/// Pass `index` of an image with this many pixels: a pure function, so that any worker of any run
/// plans the same passes. Passes start at 4 samples and grow with what lies before them.
/// With `total_samples`, the last pass is cut to fit; empty past the end.
std::optional<Pass> plan_pass(std::uint32_t index, std::uint64_t pixels,
                              std::optional<std::uint32_t> total_samples = {});

/// The transport that the material needs, by its name (interior.h).
std::string transport_name(const Scene& scene);

/// Traces one pass on `threads` threads (0: all cores); the bits do not depend on their number.
/// Empty if stopped before the end; with a deadline every tile gets its share of the time, and the
/// paths that take longer are given up (RenderStats::truncated_energy).
std::optional<PassFilm> trace_pass(const Scene& scene, const Pass& pass, int threads,
                                   const Patience& patience = {});

/// When a time target is over that began at `start`.
Patience::Clock::time_point deadline_of(const TimeTarget& target,
                                        Patience::Clock::time_point start);

/// True when the film meets the target. `seconds`: wall clock spent tracing so far.
bool meets(const Quality& quality, const Film& film, double seconds);

struct Progress {
  std::uint32_t passes = 0, samples = 0;
  std::optional<std::uint32_t> total_samples;  ///< known for a SampleTarget only
  double relative_error = 0;                   ///< estimate so far, NaN before the second pass
  double seconds = 0;                          ///< wall clock so far
  std::optional<double> eta_seconds;           ///< remaining, where it can be told
};
/// What is known after `film`, for a status line or an HTTP answer.
Progress progress_of(const Film& film, const Quality& quality, double seconds);

/// What every answer reports.
struct RenderStats {
  std::uint32_t samples = 0;
  double seconds = 0, cpu_seconds = 0;
  int threads = 0;
  double relative_error = 0;  ///< NaN where fewer than two passes ran
  std::string transport;
  int traced_images = 1;
  std::uint64_t nan_samples = 0;
  double truncated_energy = 0;     ///< mean per camera sample
  bool camera_inside = false;      ///< the camera is in the body
  std::optional<MeshReport> mesh;        ///< what became of the file of a mesh
  std::optional<Refinement> refinement;  ///< and then, where it was made smooth
};

struct RenderResult {
  Film film;
  RenderStats stats;
  bool stopped = false;  ///< by the stop_token: the film holds the passes before it
};

/// Traces passes until the target is met or `stop` is asked for. `on_progress` is called between
/// passes on the calling thread.
RenderResult render(const Scene& scene, const Quality& quality, int threads = 0,
                    std::stop_token stop = {},
                    const std::function<void(const Progress&)>& on_progress = {});

/// Stats of a film rendered by any means.
RenderStats stats_of(const Scene& scene, const Film& film, double seconds, int threads);

/// How the films of an explorable scene are developed; empty where the scene is not explorable.
std::optional<ExplorableBasis> explorable_basis(const Scene& scene);

/// What is kept of an explorable scene's film.
ExplorableFilm explorable_film(const Scene& scene, const Film& film);

/// A fingerprint of the renderer's sources: results are kept by it.
std::string_view engine_version();

/// Replays one camera sample and describes every event of its paths, a line each.
std::string explain_sample(const Scene& scene, int x, int y, std::uint32_t sample);

}  // namespace translucube

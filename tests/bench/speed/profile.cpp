// Where the time of a sample goes: by function (perf), by instructions (valgrind), and by what the
// events take one by one.

#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <map>
#include <memory>
#include <sstream>

#include "renderer/light/environment_batch.h"
#include "renderer/optics/fresnel.h"
#include "renderer/optics/microsurface.h"
#include "renderer/optics/microsurface_batch.h"
#include "renderer/scene/scene.h"
#include "renderer/transport/sphere/smooth_exits.h"
#include "renderer/transport/sphere/smooth_exits_batch.h"
#include "renderer/transport/walk.h"
#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"
#include "tests/bench/speed/shell.h"

namespace translucube::speed {
namespace {

constexpr const char* profiled[] = {"A0", "R10", "S10", "S100"};

// ---- other tools, on this program rendering one material with --render

std::string self() { return std::filesystem::read_symlink("/proc/self/exe").string(); }

std::string rendering(const char* material, std::uint32_t samples) {
  return self() + text(" --render %s --samples %u", material, samples);
}

// ---- by function

struct Part {
  const char* name;
  std::vector<const char*> symbols;  ///< contained in the function's name; the first part wins
};
const std::vector<Part>& parts() {
  static const std::vector<Part> all{
      {"program start", {"_dl_", "do_lookup", "strcmp"}},
      {"environment", {"ImageEnvironment", "EnvironmentBatch", "Coordinates", "LightList"}},
      {"connections",
       {"SmoothConnector", "FindExits", "SmoothExitBatch", "SmoothExit", "ChooseLights",
        "DrawExits", "Connect", "Densities"}},
      {"microfacets", {"Micro", "microsurface", "Ggx", "Collide", "::Start"}},
      {"walk", {"large_step", "cross_ball", "Walk", "Medium", "Sphere::"}},
      {"collect", {"Collector", "Contribution", "merge", "Lane"}},
      {"stages (inlined)", {"trace_body", "Tracer", "trace_pass", "trace_tile"}},
      {"sampling", {"Sampler", "sobol", "Rng"}},
      {"exp, log, sin, cos", {"exp", "log", "sin", "cos", "tan"}},
      {"memory", {"alloc", "free", "mem", "vector"}}};
  return all;
}

std::string part_of(const std::string& symbol) {
  for (const Part& part : parts())
    for (const char* piece : part.symbols)
      if (symbol.find(piece) != symbol.npos) return part.name;
  return "other";
}

Table by_function(Run& run) {
  Table table{"functions", "Profile by function",
              "Share of the CPU time of a sample in percent, as `perf record` sees it: compilers "
              "inline most of the stages, so that *stages* holds what has no function of its own."};
  if (!is_installed("perf")) {
    table.remark = "Not measured: `perf` is not installed.";
    return table;
  }
  const std::string file =
      (std::filesystem::temp_directory_path() / text("translucube-perf-%d", getpid())).string();
  for (const char* material : profiled) {
    if (!run.chosen(material)) continue;
    const ShellRun recorded =
        run_shell("perf record -q -o " + file + " -- " + rendering(material, run.samples(128)));
    const ShellRun report = run_shell("perf report -i " + file +
                                      " --stdio --no-children -F overhead,dso,symbol -g none");
    std::filesystem::remove(file);
    if (!recorded.succeeded || !report.succeeded) {
      table.remark = "Not measured: `perf` is not allowed to look.";
      return table;
    }
    std::map<std::string, double> shares;
    double all = 0;
    std::istringstream lines(report.output);
    for (std::string line; std::getline(lines, line);) {
      const std::size_t symbol = line.find("[.] ");
      // The loading of the process is not the sample's, nor what the kernel does.
      if (line.starts_with('#') || symbol == line.npos || line.find("ld-linux") != line.npos)
        continue;
      const double share = std::strtod(line.c_str(), nullptr);
      shares[part_of(line.substr(symbol + 4))] += share;
      all += share;
    }
    const Quantity percent{material, "%.1f"};
    for (const Part& part : parts()) table.add(part.name, percent, 100 * shares[part.name] / all);
    table.add("other", percent, 100 * shares["other"] / all);
  }
  return table;
}

// ---- by instructions

/// Of the whole run, counted by valgrind; 0 where that fails.
double instructions(const char* material, std::uint32_t samples) {
  const ShellRun ran = run_shell("valgrind --tool=callgrind --callgrind-out-file=/dev/null " +
                                 rendering(material, samples) + " --threads 1 --size 32");
  const std::size_t at = ran.output.find("Collected : ");
  return at == ran.output.npos ? 0 : std::strtod(ran.output.c_str() + at + 12, nullptr);
}

Table by_instructions(Run& run) {
  constexpr Quantity per_sample{"instructions a sample", "%.0f"}, events{"events a sample", "%.1f"},
      per_event{"instructions an event", "%.0f"}, rate{"instructions a ns", "%.2f"},
      bound{"bound, ns", "%.0f"};
  Table table{"instructions", "Instructions",
              "Instructions of a sample, counted by `valgrind` (AVX2 where it has it: valgrind "
              "knows no AVX-512) as the difference between two renders; events are flights, "
              "boundary events and next-event estimations. The bound is what they would take at 4 "
              "instructions a cycle and 3 GHz: what the same instructions could reach at best; to "
              "go beyond it takes fewer instructions an event or fewer events."};
  if (!is_installed("valgrind")) {
    table.remark = "Not measured: `valgrind` is not installed.";
    return table;
  }
  for (const char* material : profiled) {
    if (!run.chosen(material)) continue;
    constexpr std::uint32_t few = 4, more = 12;
    constexpr int size = 32;
    const double counted = (instructions(material, more) - instructions(material, few)) /
                           (double(more - few) * size * size);
    TraceCounters counters;
    const Snapshot timed =
        trace(*build_scene(peer_scene(peer_material(material).coefficients, 128, run.next_seed())),
              {run.samples(32)}, 1, &counters)[0];
    const auto samples = static_cast<double>(counters.camera_samples);
    const double each =
        static_cast<double>(counters.flights + counters.boundary_events + counters.light_samples) /
        samples;
    const double time = 1e9 * timed.cpu_seconds / samples;
    if (counted <= 0) {
      table.remark = "Not measured: valgrind could not run this program.";
      return table;
    }
    table.add(material, per_sample, counted);
    table.add(material, events, each);
    table.add(material, per_event, counted / each);
    table.add(material, ns_a_sample, time);
    table.add(material, rate, counted / time);
    table.add(material, bound, counted / 12);
  }
  return table;
}

// ---- one by one

/// What a call takes [ns]: the best of several loops, so that a disturbed one does not count.
template <class Call>
double ns_of(Call&& call, int calls) {
  double best = 1e300;
  for (int loop = 0; loop < 7; ++loop) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) call();
    best = std::fmin(
        best,
        std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count() /
            calls);
  }
  return best;
}

/// Keeps the compiler from leaving out what nobody reads.
volatile double sink;

/// A walk of the reference in a body of this density: ns a flight.
double flight_ns(double sigma_s, int walks) {
  const Medium medium{sigma_s, 0};
  Rng rng(1);
  long flights = 0;
  const double ns = ns_of(
      [&] {
        Particle particle{{0, 0, 1}, {0, 0, -1}};
        Hit hit;
        while (++flights, fly(Sphere{}, medium, particle, rng, hit))
          scatter(Sphere{}, medium, particle, rng);
        sink = hit.t;
      },
      walks);
  return ns * 7 * walks / static_cast<double>(flights);
}

Table one_by_one(Run& run) {
  constexpr Quantity ns{"ns", "%.1f"};
  Table table{"events", "Events one by one",
              "What the pieces take in a loop of their own: the best of seven."};
  const int calls = std::max(1000, static_cast<int>(2e5 * std::fmin(1, run.effort)));
  const auto scene = build_scene(peer_scene({1, .1, 10}, 256, 1));
  const Lighting& environment = scene->environment;
  Rng rng(2);
  std::uint32_t sample = 0;
  const auto measure = [&](const char* name, auto&& call) {
    table.add(name, ns, ns_of(call, calls));
  };
  measure("camera ray with its sampler", [&] {
    PathSampler sampler(sample >> 4, sample & 15);
    ++sample;
    const Sample2 u = sampler.next2();
    sink = scene->camera.direction(100 + u.u, 90 + u.v).x;
  });
  measure("environment look-up, at random",
          [&] { sink = environment.value_from(sample_isotropic(rng)).radiance.r; });
  measure("environment sample, at random",
          [&] { sink = environment.sample(rng.uniform2()).value.pdf; });
  measure("smooth boundary event", [&] {
    const Vec3 w = sample_isotropic(rng), wo{w.x, w.y, std::fabs(w.z)}, n{0, 0, 1};
    sink = fresnel(wo.z, 1.5) + refract(wo, n, 1.5)->z + reflect(wo, n).x;
  });
  measure("rough boundary event", [&] {
    const Vec3 w = sample_isotropic(rng);
    PathSampler sampler(++sample, 0);
    cross_microsurface(RoughInterface{1.5, Ggx{0.1}}, 1.5, {w.x, w.y, std::fabs(w.z) + 1e-3},
                       sampler, [](Vec3 wi, double) { sink = wi.x; });
  });
  measure("development by an RGB lane", [&] {
    sink = std::get<RgbLane>(scene->lanes[0]).apply({1, 1, 1}, rng.uniform()).r;
  });
  for (const double sigma_s : {10.0, 100.0})
    table.add(text("flight or large step, σR %g", sigma_s), ns, flight_ns(sigma_s, calls / 50));
  // In SIMD, batches of `size`.
  const auto measure_batch = [&](const char* name, std::size_t size, auto&& work) {
    table.add(name, ns, ns_of(work, std::max(20, calls / 256)) / static_cast<double>(size));
  };
  auto lookups = std::make_unique<EnvironmentBatch>();
  measure_batch("environment look-up, at random (SIMD)", EnvironmentBatch::capacity, [&] {
    for (lookups->size = 0; lookups->size < EnvironmentBatch::capacity; ++lookups->size)
      lookups->direction.set(lookups->size, sample_isotropic(rng));
    environment.look_up(*lookups);
    sink = lookups->value[7].pdf;
  });
  auto microsurface = std::make_unique<MicrosurfaceBatch>();
  const LightList lights(scene->environment, 3);
  measure_batch("rough boundary event with 8 lights a collision (SIMD)",
                MicrosurfaceBatch::capacity, [&] {
                  const BatchInterface interface { 0.1f, 1.5f };
                  for (std::size_t i = 0; i < MicrosurfaceBatch::capacity; ++i) {
                    const Vec3 d = sample_isotropic(rng);
                    microsurface->push({0, 0, 1}, {d.x, d.y, -std::fabs(d.z) - 1e-3},
                                       rng.uniform2(), rng.bits());
                  }
                  microsurface->start(interface);
                  while (microsurface->under_way() > 0) microsurface->collide(interface, lights, 8);
                  sink = microsurface->inward_weight(7);
                });
  auto exits = std::make_unique<SmoothExitBatch>();
  measure_batch("way out of a smooth connection (SIMD)", SmoothExitBatch::capacity, [&] {
    exits->size = 0;
    while (exits->size < SmoothExitBatch::capacity)
      exits->push(0.9 * sample_isotropic(rng), 0.19, sample_isotropic(rng), sample_isotropic(rng),
                  0.1);
    find_exits({1.5f, 10.0f, 0.0f}, ExitBranch::near, Division::balanced, *exits);
    sink = exits->share[7];
  });
  return table;
}

}  // namespace

void render_to_profile(const Run& run, int size) {
  for (const std::string& name : run.materials)
    trace(*build_scene(peer_scene(peer_material(name).coefficients, size, run.seed)),
          {run.material_samples}, run.threads);
}

Tables profile(Run& run) { return {by_function(run), by_instructions(run), one_by_one(run)}; }

}  // namespace translucube::speed

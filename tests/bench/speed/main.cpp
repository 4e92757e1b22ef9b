// Measures how fast the renderer is and writes docs/speed.md, speed.json and plots, or compares a
// fresh run with committed figures.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "renderer/base/parallel.h"
#include "tests/bench/report/program.h"
#include "tests/bench/speed/document.h"
#include "tests/bench/speed/guard.h"
#include "tests/bench/speed/sections.h"

namespace {

using namespace translucube::speed;
using translucube::bench::Settings, translucube::bench::add_options,
    translucube::bench::committed_figures, translucube::bench::for_each_section,
    translucube::bench::write;

struct Section {
  const char* id;
  Tables (*measure)(Run&);
};
constexpr Section sections[] = {{"materials", materials},
                                {"single", single_scattering},
                                {"error", error_against_time},
                                {"density", density},
                                {"lanes", lanes},
                                {"sweeps", sweeps},
                                {"cores", cores},
                                {"pixels", pixels},
                                {"meshes", meshes},
                                {"bodies", bodies},
                                {"latency", latency},
                                {"stopping", stopping},
                                {"sun", hard_sun},
                                {"profile", profile},
                                {"cycles", cycles}};

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

Report measure(const Settings& settings, const Run& run) {
  Report report;
  report.effort = settings.effort;
  report.seed = settings.seed;
  report.threads = translucube::thread_count(settings.threads);
  report.machine = processor();
  report.cpu_seconds =
      for_each_section(sections, settings, [&](const Section& section, std::uint64_t seed) {
        Run own = run;
        own.seed = seed;
        std::ranges::move(section.measure(own), std::back_inserter(report.tables));
      });
  return report;
}

void add_own_options(CLI::App& app, Run& run) {
  app.add_option("--materials", run.materials, "of the peers' list, separated by commas")
      ->delimiter(',');
  app.add_option("--samples", run.material_samples,
                 "camera samples in the sections `materials` and `single`")
      ->check(CLI::Range(1, 1 << 20));
  app.add_option("--sun", run.sun, "sunrise.exr; looked for in config/environments")
      ->check(CLI::ExistingFile);
  app.add_flag("--cycles", run.cycles,
               "render the same in Blender's Cycles, where it is installed");
}

/// Instead of measuring: the guard's file, and what sections ask of a process of its own.
struct Errand {
  std::string guard_file;
  std::vector<int> film;
  std::string rendered;
  int size = 128;

  void add_options(CLI::App& app) {
    app.add_option("--write-guard", guard_file,
                   "nothing but this: writes tests/transport/efficiency.json, the ceilings of "
                   "variance and counted work");
    app.add_option("--film-memory", film)->expected(2)->group("");
    app.add_option("--render", rendered)->group("");
    app.add_option("--size", size)->group("");
  }
  /// False where there is none.
  bool run(Run run) const {
    if (!film.empty()) {
      std::printf("%.0f\n", film_memory(film[0], film[1], run.threads));
    } else if (!guard_file.empty()) {
      write(guard_file, guard());
    } else if (!rendered.empty()) {
      run.materials = {rendered};
      render_to_profile(run, size);
    } else {
      return false;
    }
    return true;
  }
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Measures the renderer's speed; writes speed.md, speed.json and plots."};
  Settings settings;
  Run run;
  Errand errand;
  std::vector<std::string> ids;
  for (const Section& section : sections) ids.emplace_back(section.id);
  add_options(app, settings, "speed", ids);
  add_own_options(app, run);
  errand.add_options(app);
  CLI11_PARSE(app, argc, argv);
  run.effort = settings.effort;
  run.seed = settings.seed;
  run.threads = settings.threads;
  try {
    if (errand.run(run)) return 0;
    const Report report = measure(settings, run);
    write(settings, {"speed", markdown(report), to_json(report).dump(1) + "\n", "speed",
                     [&](const auto& folder) { draw_plots(report, folder); }});
    std::vector<std::string> complaints;
    if (const nlohmann::json committed = committed_figures(settings); !committed.is_null())
      complaints = compare(report, report_from_json(committed));
    for (const std::string& complaint : complaints) std::fprintf(stderr, "%s\n", complaint.c_str());
    return complaints.empty() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "speed: %s\n", error.what());
    return 2;
  }
}

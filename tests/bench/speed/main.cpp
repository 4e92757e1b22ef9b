// Measures how fast the renderer is and writes docs/speed.md, speed.json and plots, or compares a
// fresh run with committed figures.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "renderer/base/parallel.h"
#include "tests/bench/report/files.h"
#include "tests/bench/speed/document.h"
#include "tests/bench/speed/guard.h"
#include "tests/bench/speed/sections.h"

namespace {

using namespace translucube::speed;
using translucube::bench::process_cpu_seconds, translucube::bench::write;

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

/// Sections have random numbers of their own, so that one alone gives the figures of all.
Report measure(const Run& settings, const std::vector<std::string>& only) {
  Report report;
  report.effort = settings.effort;
  report.seed = settings.seed;
  report.threads = translucube::thread_count(settings.threads);
  report.machine = processor();
  const double start = process_cpu_seconds();
  std::uint64_t index = 0;
  for (const Section& section : sections) {
    Run run = settings;
    run.seed = translucube::hash_combine(settings.seed, ++index);
    if (!only.empty() && !std::ranges::count(only, section.id)) continue;
    const double began = process_cpu_seconds();
    std::ranges::move(section.measure(run), std::back_inserter(report.tables));
    std::fprintf(stderr, "%-10s %6.1f CPU s\n", section.id, process_cpu_seconds() - began);
  }
  report.cpu_seconds = process_cpu_seconds() - start;
  return report;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Measures the renderer's speed; writes speed.md, speed.json and plots."};
  Run run;
  std::vector<std::string> only;
  std::string out, json, committed, guard_file;
  std::vector<std::string> ids;
  for (const Section& section : sections) ids.push_back(section.id);
  app.add_option("--effort", run.effort, "share of the default's samples and repetitions")
      ->check(CLI::Range(1e-3, 1e3));
  app.add_option("--seed", run.seed, "random numbers");
  app.add_option("--threads", run.threads, "0: all cores");
  app.add_option("--only", only, "sections, separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember(ids));
  app.add_option("--materials", run.materials, "of the peers' list, separated by commas")
      ->delimiter(',');
  app.add_option("--samples", run.material_samples,
                 "camera samples in the sections `materials` and `single`")
      ->check(CLI::Range(1, 1 << 20));
  app.add_option("--sun", run.sun,
                 "sunrise.exr; looked for in config/environments and ../shared/environments")
      ->check(CLI::ExistingFile);
  app.add_flag("--cycles", run.cycles,
               "render the same in Blender's Cycles, where it is installed");
  app.add_option("--out", out, "folder to write the documents to");
  app.add_option("--json", json, "file to write the figures to");
  app.add_option("--check", committed,
                 "speed.json to compare with; exits 1 where errors or work "
                 "of the same effort have risen (times are left out)")
      ->check(CLI::ExistingFile);
  app.add_option(
      "--write-guard", guard_file,
      "nothing but this: writes tests/transport/efficiency.json, the ceilings of variance "
      "and counted work");
  // What sections ask of a process of its own.
  std::vector<int> film;
  std::string rendered;
  int size = 128;
  app.add_option("--film-memory", film)->expected(2)->group("");
  app.add_option("--render", rendered)->group("");
  app.add_option("--size", size)->group("");
  CLI11_PARSE(app, argc, argv);
  try {
    if (!film.empty()) {
      std::printf("%.0f\n", film_memory(film[0], film[1], run.threads));
      return 0;
    }
    if (!guard_file.empty()) {
      write(guard_file, guard());
      return 0;
    }
    if (!rendered.empty()) {
      run.materials = {rendered};
      render_to_profile(run, size);
      return 0;
    }
    const Report report = measure(run, only);
    const std::string page = markdown(report);
    if (out.empty() && json.empty() && committed.empty()) std::fputs(page.c_str(), stdout);
    if (!json.empty()) write(json, to_json(report).dump(1) + "\n");
    if (!out.empty()) {
      const std::filesystem::path folder(out);
      draw_plots(report, folder / "speed");
      write(folder / "speed.json", to_json(report).dump(1) + "\n");
      write(folder / "speed.md", page);
    }
    std::vector<std::string> complaints;
    if (!committed.empty()) {
      std::ifstream file(committed);
      complaints = compare(report, report_from_json(nlohmann::json::parse(file)));
    }
    for (const std::string& complaint : complaints) std::fprintf(stderr, "%s\n", complaint.c_str());
    return complaints.empty() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "speed: %s\n", error.what());
    return 2;
  }
}

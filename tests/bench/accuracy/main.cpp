// Measures how right the renderer is and writes docs/accuracy.md, accuracy.json and plots, or
// compares a fresh run with committed figures.

#include <CLI/CLI.hpp>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/bench/accuracy/document.h"
#include "tests/bench/accuracy/sections.h"
#include "tests/bench/report/files.h"

namespace {

using namespace translucube::accuracy;
using translucube::bench::process_cpu_seconds, translucube::bench::write;

struct Section {
  const char* id;
  Table (*measure)(Run&);
};
constexpr Section sections[] = {{"furnace", white_furnaces},
                                {"lengths", mean_path_lengths},
                                {"slabs", slabs},
                                {"appearance", slab_appearances},
                                {"means", image_means},
                                {"ways", walks},
                                {"microsurface", microsurfaces},
                                {"microfacets", single_scattering},
                                {"explorable", explorable_films},
                                {"hard", hard_cases},
                                {"lambertian", interfaced_lambertian},
                                {"dipole", dipole}};

/// Sections have random numbers of their own, so that one alone gives the figures of all.
Report measure(double effort, std::uint64_t seed, int threads, const std::string& only) {
  Report report{{}, effort, 0, seed};
  const double start = process_cpu_seconds();
  std::uint64_t index = 0;
  for (const Section& section : sections) {
    Run run(effort, translucube::hash_combine(seed, ++index), threads);
    if (!only.empty() && only != section.id) continue;
    const double began = process_cpu_seconds();
    report.tables.push_back(section.measure(run));
    std::fprintf(stderr, "%-14s %6.1f CPU s\n", section.id, process_cpu_seconds() - began);
  }
  report.cpu_seconds = process_cpu_seconds() - start;
  return report;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Measures the renderer's accuracy; writes accuracy.md, accuracy.json and plots."};
  double effort = 1;
  std::uint64_t seed = 1;
  int threads = 0;
  std::string out, json, committed, only;
  app.add_option("--effort", effort, "share of the default's samples")
      ->check(CLI::Range(1e-3, 1e3));
  app.add_option("--seed", seed, "random numbers");
  app.add_option("--threads", threads, "0: all cores");
  app.add_option("--only", only, "one section, by its id in accuracy.json");
  app.add_option("--out", out, "folder to write the documents to");
  app.add_option("--json", json, "file to write the figures to");
  app.add_option("--check", committed, "accuracy.json to compare with; exits 1 if they disagree")
      ->check(CLI::ExistingFile);
  CLI11_PARSE(app, argc, argv);
  try {
    const Report report = measure(effort, seed, threads, only);
    const std::string page = markdown(report);
    if (out.empty() && json.empty() && committed.empty()) std::fputs(page.c_str(), stdout);
    if (!json.empty()) write(json, to_json(report).dump(1) + "\n");
    if (!out.empty()) {
      const std::filesystem::path folder(out);
      draw_plots(report, folder / "plots");
      write(folder / "accuracy.json", to_json(report).dump(1) + "\n");
      write(folder / "accuracy.md", page);
    }
    std::vector<std::string> complaints;
    if (!committed.empty()) {
      std::ifstream file(committed);
      Report old = report_from_json(nlohmann::json::parse(file));
      if (!only.empty()) std::erase_if(old.tables, [&](const Table& t) { return t.id != only; });
      complaints = compare(report, old);
    }
    for (const std::string& figure : judge(report).disagree)
      complaints.push_back(figure + ": not what it must be");
    for (const std::string& complaint : complaints) std::fprintf(stderr, "%s\n", complaint.c_str());
    std::fprintf(stderr, "%zu disagreements, %.0f CPU s\n", complaints.size(), report.cpu_seconds);
    return complaints.empty() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "accuracy: %s\n", error.what());
    return 2;
  }
}

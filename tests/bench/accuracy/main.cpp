// Measures how right the renderer is and writes docs/accuracy.md, accuracy.json and plots, or
// compares a fresh run with committed figures.

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "tests/bench/accuracy/document.h"
#include "tests/bench/accuracy/sections.h"
#include "tests/bench/report/program.h"

namespace {

using namespace translucube::accuracy;
using translucube::bench::Settings, translucube::bench::add_options,
    translucube::bench::committed_figures, translucube::bench::for_each_section,
    translucube::bench::write;

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
                                {"hard", translucube::accuracy::hard_cases},
                                {"lambertian", interfaced_lambertian},
                                {"dipole", dipole}};

Report measure(const Settings& settings) {
  Report report{{}, settings.effort, 0, settings.seed};
  report.cpu_seconds =
      for_each_section(sections, settings, [&](const Section& section, std::uint64_t seed) {
        Run run(settings.effort, seed, settings.threads);
        report.tables.push_back(section.measure(run));
      });
  return report;
}

std::vector<std::string> complaints_of(const Report& report, const Settings& settings) {
  std::vector<std::string> complaints;
  if (const nlohmann::json committed = committed_figures(settings); !committed.is_null()) {
    Report old = report_from_json(committed);
    std::erase_if(old.tables, [&](const Table& table) { return !settings.asks_for(table.id); });
    complaints = compare(report, old);
  }
  for (const std::string& figure : judge(report).disagree)
    complaints.push_back(figure + ": not what it must be");
  return complaints;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Measures the renderer's accuracy; writes accuracy.md, accuracy.json and plots."};
  Settings settings;
  std::vector<std::string> ids;
  for (const Section& section : sections) ids.emplace_back(section.id);
  add_options(app, settings, "accuracy", ids);
  CLI11_PARSE(app, argc, argv);
  try {
    const Report report = measure(settings);
    write(settings, {"accuracy", markdown(report), to_json(report).dump(1) + "\n", "plots",
                     [&](const auto& folder) { draw_plots(report, folder); }});
    const std::vector<std::string> complaints = complaints_of(report, settings);
    for (const std::string& complaint : complaints) std::fprintf(stderr, "%s\n", complaint.c_str());
    std::fprintf(stderr, "%zu disagreements, %.0f CPU s\n", complaints.size(), report.cpu_seconds);
    return complaints.empty() ? 0 : 1;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "accuracy: %s\n", error.what());
    return 2;
  }
}

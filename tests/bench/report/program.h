#pragma once

// What the programs share that measure and write a document: their options, the loop over their
// sections, and the files that they leave.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "renderer/base/sampler.h"
#include "tests/bench/report/files.h"

namespace CLI {
class App;
}

namespace translucube::bench {

struct Settings {
  double effort = 1;  ///< share of the default's samples and repetitions
  std::uint64_t seed = 1;
  int threads = 0;                ///< 0: all cores
  std::vector<std::string> only;  ///< ids of sections; empty: all
  std::string out, json, committed;

  bool asks_for(const std::string& section) const {
    return only.empty() || std::ranges::count(only, section) > 0;
  }
};

/// Adds the options of the settings, for a document of this name with these sections.
void add_options(CLI::App& app, Settings& settings, const std::string& name,
                 const std::vector<std::string>& ids);

/// Calls measure(section, seed) for those that are asked for; CPU seconds in all. Sections have
/// random numbers of their own, so that one alone gives the figures of all.
template <class Sections, class Measure>
double for_each_section(const Sections& sections, const Settings& settings, Measure measure) {
  const double start = process_cpu_seconds();
  std::uint64_t index = 0;
  for (const auto& section : sections) {
    const std::uint64_t seed = hash_combine(settings.seed, ++index);
    if (!settings.asks_for(section.id)) continue;
    const double began = process_cpu_seconds();
    measure(section, seed);
    std::fprintf(stderr, "%-14s %6.1f CPU s\n", section.id, process_cpu_seconds() - began);
  }
  return process_cpu_seconds() - start;
}

struct Document {
  std::string name;     ///< of its files: NAME.md, NAME.json
  std::string page;     ///< Markdown
  std::string figures;  ///< the same as JSON
  std::string plots;    ///< the folder of its plots
  std::function<void(const std::filesystem::path& folder)> draw_plots;
};
/// Writes what the settings ask for; the page to standard output where they ask for nothing.
void write(const Settings& settings, const Document& document);

/// The committed figures, or null where none are to be compared.
nlohmann::json committed_figures(const Settings& settings);

}  // namespace translucube::bench

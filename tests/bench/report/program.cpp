#include "tests/bench/report/program.h"

#include <CLI/CLI.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

namespace translucube::bench {

void add_options(CLI::App& app, Settings& settings, const std::string& name,
                 const std::vector<std::string>& ids) {
  app.add_option("--effort", settings.effort, "share of the default's samples and repetitions")
      ->check(CLI::Range(1e-3, 1e3));
  app.add_option("--seed", settings.seed, "random numbers");
  app.add_option("--threads", settings.threads, "0: all cores");
  app.add_option("--only", settings.only, "sections, separated by commas")
      ->delimiter(',')
      ->check(CLI::IsMember(ids));
  app.add_option("--out", settings.out, "folder to write the documents to");
  app.add_option("--json", settings.json, "file to write the figures to");
  app.add_option("--check", settings.committed,
                 name + ".json to compare with; exits 1 if they disagree (times are left out)")
      ->check(CLI::ExistingFile);
}

void write(const Settings& settings, const Document& document) {
  if (settings.out.empty() && settings.json.empty() && settings.committed.empty())
    std::fputs(document.page.c_str(), stdout);
  if (!settings.json.empty()) write(settings.json, document.figures);
  if (settings.out.empty()) return;
  const std::filesystem::path folder(settings.out);
  document.draw_plots(folder / document.plots);
  write(folder / (document.name + ".json"), document.figures);
  write(folder / (document.name + ".md"), document.page);
}

nlohmann::json committed_figures(const Settings& settings) {
  if (settings.committed.empty()) return nullptr;
  std::ifstream file(settings.committed);
  return nlohmann::json::parse(file);
}

}  // namespace translucube::bench

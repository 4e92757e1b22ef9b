#pragma once

// Plots by gnuplot (.ci/docs_packages.txt), on white so that they read on dark pages too.

#include <filesystem>
#include <string>
#include <vector>

namespace translucube::bench {

/// The colours of Okabe and Ito (2008).
inline constexpr const char* colors[] = {"#000000", "#0072B2", "#D55E00", "#009E73",
                                         "#CC79A7", "#E69F00", "#56B4E9"};

/// The number at the end of a row's name.
double abscissa(const std::string& row);

/// A gnuplot data block of these lines.
std::string data_block(const std::string& name, const std::string& lines);

struct Drawing {
  std::string id;      ///< of its table, which names the file
  std::string script;  ///< none: nothing is drawn
  int width = 720, height = 400;
};
/// Draws SVG files into a folder. Throws std::runtime_error where gnuplot is missing or cannot be
/// run.
void draw(const std::vector<Drawing>& drawings, const std::filesystem::path& folder);

/// The plots of the tables that have one: `scripts` are pairs of a table's id and its script.
template <class Table>
std::vector<Drawing> drawings_of(
    const std::vector<Table>& tables,
    const std::vector<std::pair<std::string, std::string (*)(const Table&)>>& scripts) {
  std::vector<Drawing> drawings;
  for (const Table& table : tables)
    for (const auto& [id, script] : scripts)
      if (table.id == id && !table.figures.empty()) drawings.push_back({id, script(table)});
  return drawings;
}

}  // namespace translucube::bench

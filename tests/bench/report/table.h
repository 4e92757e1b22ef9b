#pragma once

// What a document of measurements is made of: figures in tables, by row and column, and plots.

#include <cstdint>
#include <string>
#include <vector>

#include "tests/bench/report/markdown.h"

namespace translucube::bench {

struct Plot {
  std::string name, caption;
};

/// A Figure has the names of its row and its column.
template <class Figure>
struct Table {
  std::string id, title, text;
  std::vector<Figure> figures = {};
  std::vector<Plot> plots = {};
  std::string remark = {};  ///< found while measuring; below the table

  const Figure* find(const std::string& row, const std::string& column) const {
    for (const Figure& figure : figures)
      if (figure.row == row && figure.column == column) return &figure;
    return nullptr;
  }
  std::vector<std::string> rows() const {
    std::vector<std::string> names;
    for (const Figure& figure : figures) remember(names, figure.row);
    return names;
  }
};

template <class Table>
struct Report {
  std::vector<Table> tables;
  double effort = 1, cpu_seconds = 0;
  std::uint64_t seed = 1;
};

/// A table's title, its text, its figures as `grid`, what was found on the way, and its plots.
template <class Table>
std::string section(const Table& table, const std::string& grid, const std::string& plot_folder) {
  std::string out = "\n## " + table.title + "\n\n" + table.text + "\n";
  if (!table.figures.empty()) out += "\n" + grid;
  if (!table.remark.empty()) out += "\n" + table.remark + "\n";
  for (const Plot& plot : table.plots)
    out += "\n![" + plot.caption + "](" + plot_folder + "/" + plot.name + ".svg)\n";
  return out;
}

}  // namespace translucube::bench

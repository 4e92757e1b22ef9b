// The plots of the tables that have one.

#include <algorithm>

#include "tests/bench/report/gnuplot.h"
#include "tests/bench/speed/document.h"
#include "tests/support/peers.h"

namespace translucube::speed {
namespace {

/// A gnuplot data block: x and y over the rows that begin with `prefix`. `x`: the column, or empty
/// for the number at the end of the row's name.
std::string data(const Table& table, const std::string& name, const std::string& x,
                 const std::string& y, const std::string& prefix = "") {
  std::string lines;
  for (const std::string& row : table.rows()) {
    if (!row.starts_with(prefix)) continue;
    const Figure *at = table.find(row, x), *figure = table.find(row, y);
    if (figure) lines += text("%.9g %.9g\n", at ? at->value : bench::abscissa(row), figure->value);
  }
  return bench::data_block(name, lines);
}

/// A small plot for each material.
std::string errors(const Table& table) {
  std::string script =
      "set multiplot layout 3,4\nset logscale xy\nset format '10^{%L}'\nset bmargin 3\n"
      "set key inside top right vertical samplen 1 font ',10'\nset tics font ',10'\n"
      "set xlabel 'CPU s' font ',10' offset 0,.7\n";
  for (const test::PeerMaterial& material : test::peer_materials) {
    const std::string name = material.name;
    const bool dipole = material.coefficients.sigma_s > 0;
    script += data(table, name + "t", "CPU s", "relMSE", name + ", transport") +
              data(table, name + "d", "CPU s", "relMSE", name + ", dipole") + "set title '" + name +
              "' offset 0,-.7\n";
    if (table.find(name + ", transport, 4", "relMSE"))
      script += text("plot $%st with linespoints pt 7 ps .4 lc '%s' title 'transport'%s\n",
                     name.c_str(), bench::colors[1],
                     dipole ? text(", $%sd with linespoints pt 7 ps .4 lc '%s' title 'dipole'",
                                   name.c_str(), bench::colors[2])
                                  .c_str()
                            : "");
  }
  return script + "unset multiplot";
}

std::string density(const Table& table) {
  return data(table, "time", "", "time, of σR = 30") +
         data(table, "noise", "", "error, of σR = 30") +
         "set logscale x\nset format x '10^{%L}'\nset xlabel 'σ_s R'\nset ylabel 'of σR = 30'\n"
         "set yrange [0:*]\nplot 1.5 lc '#888888' dt 2 title 'bound of the time', " +
         text(
             "$time with linespoints pt 7 ps .6 lc '%s' title 'time of a sample', "
             "$noise with linespoints pt 7 ps .6 lc '%s' title 'error of a sample'",
             bench::colors[1], bench::colors[2]);
}

/// A line for each material, the number at the end of the row's name across.
std::string by_material(const Table& table, const char* quantity) {
  std::string script, plot;
  int line = 0;
  for (const test::PeerMaterial& material : test::peer_materials) {
    const std::string name = material.name, prefix = name + ", ";
    if (std::ranges::none_of(table.figures,
                             [&](const Figure& f) { return f.row.starts_with(prefix); }))
      continue;
    script += data(table, name, "", quantity, prefix);
    plot += text("%s$%s with linespoints pt 7 ps .6 lc '%s' title '%s'", line ? ", " : "plot ",
                 name.c_str(), bench::colors[line % std::size(bench::colors)], name.c_str());
    ++line;
  }
  return script + plot;
}

std::string lanes(const Table& table) {
  return "set xlabel 'lanes'\nset ylabel 'CPU ns a sample'\nset yrange [0:*]\n" +
         by_material(table, "ns a sample");
}

std::string cores(const Table& table) {
  return "set logscale xy 2\nset xlabel 'threads'\nset ylabel 'times one thread'\n" +
         by_material(table, "times one thread") + ", x lc '#888888' dt 2 title 'ideal'";
}

}  // namespace

void draw_plots(const Report& report, const std::filesystem::path& folder) {
  std::vector<bench::Drawing> drawings = bench::drawings_of<Table>(
      report.tables, {{"error", errors}, {"density", density}, {"lanes", lanes}, {"cores", cores}});
  for (bench::Drawing& drawing : drawings)
    if (drawing.id == "error") drawing.width = 900, drawing.height = 700;
  bench::draw(drawings, folder);
}

}  // namespace translucube::speed

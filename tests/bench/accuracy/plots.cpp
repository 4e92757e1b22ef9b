// The plots of the tables that have one.

#include "tests/bench/accuracy/document.h"
#include "tests/bench/report/gnuplot.h"

namespace translucube::accuracy {
namespace {

/// A gnuplot data block of the column over its rows that begin with `prefix`: x, y, standard error,
/// expected value.
std::string data(const Table& table, const std::string& name, const std::string& column,
                 const std::string& prefix) {
  std::string lines;
  for (const Figure& f : table.figures)
    if (f.column == column && f.row.starts_with(prefix))
      lines += text(
          "%.9g %.9g %.9g %s\n", bench::abscissa(f.row), f.measured.mean, f.measured.standard_error,
          f.truth && f.truth->tolerance > 0 ? text("%.9g", f.truth->value).c_str() : "NaN");
  return bench::data_block(name, lines);
}

std::string lengths(const Table& table) {
  const char* const indices[] = {"1", "1.33", "1.5", "2.5"};
  std::string script, plot;
  for (int i = 0; i < 4; ++i) {
    script += data(table, text("d%d", i), std::string("ior ") + indices[i], "sigma_s R");
    // Side by side: the points of one density would hide each other.
    plot += text(
        "%s$d%d using ($1*%g):(100*($2-1)):(100*$3) with yerrorbars pt 7 ps .6 lc '%s' "
        "title 'ior %s'",
        i ? ", " : "plot 0 lc '#888888' notitle, ", i, std::pow(1.12, i - 1.5), bench::colors[i],
        indices[i]);
  }
  return script +
         "set logscale x\nset format x '10^{%L}'\nset xlabel 'scattering sigma\\_s R'\n"
         "set ylabel 'mean path length off by [%]'\n" +
         plot;
}

std::string microfacets(const Table& table) {
  return data(table, "many", "multiple scattering", "alpha") +
         data(table, "once", "single scattering", "alpha") +
         "set xlabel 'roughness alpha'\nset ylabel 'share of the light kept'\nset yrange [0:1.1]\n"
         "plot $many using 1:2:3 with yerrorlines pt 7 ps .6 lc '#0072B2' title 'multiple "
         "scattering', "
         "$once using 1:2:3 with yerrorlines pt 7 ps .6 lc '#D55E00' title 'single scattering', "
         "$once using 1:4 with points pt 6 ps 1.1 lc '#000000' title 'single scattering, Mitsuba "
         "0.6'";
}

std::string explorable(const Table& table) {
  return data(table, "largest", "largest", "absorption") +
         data(table, "mean", "mean", "absorption") +
         data(table, "largest_bins", "largest, bins alone", "absorption") +
         data(table, "mean_bins", "mean, bins alone", "absorption") +
         "set logscale y\nset format y '10^{%L}'\nset xlabel 'absorption a'\n"
         "set ylabel 'error, of the clear pixel'\nset yrange [1e-7:2e-3]\n"
         "plot 1e-3 lc '#888888' dt 2 title 'bound', "
         "$largest using 1:2 with linespoints pt 7 ps .6 lc '#D55E00' title 'largest', "
         "$mean using 1:2 with linespoints pt 7 ps .6 lc '#0072B2' title 'mean', "
         "$largest_bins using 1:2 with linespoints dt 2 pt 6 ps .6 lc '#D55E00' title 'bins "
         "alone', "
         "$mean_bins using 1:2 with linespoints dt 2 pt 6 ps .6 lc '#0072B2' title 'bins alone'";
}

std::string dipole(const Table& table) {
  return data(table, "furnace", "white furnace", "s ") + data(table, "light", "luminance", "s ") +
         data(table, "error", "relMSE", "s ") +
         "set xlabel 'scattering s'\nset ylabel 'relative to exact'\nset y2label 'relMSE'\n"
         "set border 11\nset y2tics\nset y2range [0:*]\n"
         "plot 1 lc '#888888' notitle, "
         "$furnace using 1:2:3 with yerrorlines pt 7 ps .6 lc '#0072B2' title 'white furnace', "
         "$light using 1:2:3 with yerrorlines pt 7 ps .6 lc '#009E73' title 'luminance over "
         "exact', "
         "$error using 1:2:3 axes x1y2 with yerrorlines pt 5 ps .6 lc '#D55E00' title 'relMSE "
         "(right)'";
}

}  // namespace

void draw_plots(const Report& report, const std::filesystem::path& folder) {
  bench::draw(bench::drawings_of<Table>(report.tables, {{"lengths", lengths},
                                                        {"microfacets", microfacets},
                                                        {"explorable", explorable},
                                                        {"dipole", dipole}}),
              folder);
}

}  // namespace translucube::accuracy

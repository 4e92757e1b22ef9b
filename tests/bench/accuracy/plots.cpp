// Plots by gnuplot, on white so that they read on dark pages too, in the colours of Okabe and Ito
// (2008).

#include <cstdio>
#include <cstdlib>
#include <memory>
#include <stdexcept>

#include "tests/bench/accuracy/document.h"

namespace translucube::accuracy {
namespace {

constexpr const char* colors[] = {"#000000", "#0072B2", "#D55E00", "#009E73"};

/// The number at the end of a row's name.
double abscissa(const std::string& row) {
  const std::size_t space = row.find_last_of(' ');
  return std::strtod(row.c_str() + (space == std::string::npos ? 0 : space + 1), nullptr);
}

/// A gnuplot data block of the column over its rows that begin with `prefix`: x, y, standard error,
/// expected value.
std::string data(const Table& table, const std::string& name, const std::string& column,
                 const std::string& prefix) {
  std::string block = "$" + name + " << EOD\n";
  for (const Figure& f : table.figures)
    if (f.column == column && f.row.starts_with(prefix))
      block +=
          text("%.9g %.9g %.9g %s\n", abscissa(f.row), f.measured.mean, f.measured.standard_error,
               f.truth && f.truth->tolerance > 0 ? text("%.9g", f.truth->value).c_str() : "NaN");
  return block + "EOD\n";
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
        i ? ", " : "plot 0 lc '#888888' notitle, ", i, std::pow(1.12, i - 1.5), colors[i],
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

void draw(const std::string& script, const std::filesystem::path& file) {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen("gnuplot", "w"), pclose);
  const std::string all =
      "set terminal svg size 720,400 font 'sans-serif,13' background rgb 'white'\n"
      "set output '" +
      file.string() +
      "'\nset border 3 lc '#444444'\nset key outside bottom center horizontal\nset bmargin 6\nset "
      "tics nomirror\n"
      "set grid lc '#dddddd'\n" +
      script + "\n";
  if (!pipe || std::fputs(all.c_str(), pipe.get()) < 0 || std::fflush(pipe.get()) != 0)
    throw std::runtime_error("cannot run gnuplot");
}

}  // namespace

void draw_plots(const Report& report, const std::filesystem::path& folder) {
  if (std::system("command -v gnuplot >/dev/null") != 0)
    throw std::runtime_error(
        "plots need gnuplot: bash .ci/install_packages.sh .ci/docs_packages.txt");
  std::filesystem::create_directories(folder);
  for (const Table& table : report.tables) {
    const std::filesystem::path file = folder / (table.id + ".svg");
    if (table.id == "lengths") draw(lengths(table), file);
    if (table.id == "microfacets") draw(microfacets(table), file);
    if (table.id == "explorable") draw(explorable(table), file);
    if (table.id == "dipole") draw(dipole(table), file);
  }
}

}  // namespace translucube::accuracy

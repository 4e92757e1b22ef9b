// The figures as a page to read.

#include "tests/bench/accuracy/document.h"

#include <algorithm>
#include <vector>

namespace translucube::accuracy {
namespace {

/// Two digits of the error, and as many decimals of the value.
std::string with_error(const Measured& e) {
  if (e.standard_error <= rounding * std::fabs(e.mean))
    return text(std::fabs(e.mean) < 0.01 ? "%.2g" : "%.6g", e.mean);
  const int decimals =
      std::clamp(1 - static_cast<int>(std::floor(std::log10(e.standard_error))), 0, 7);
  return text("%.*f ± %.*f", decimals, e.mean, decimals, e.standard_error);
}

/// Whether it has a figure to the row instead of a column for each quantity.
bool is_list(const Table& table) { return table.figures.front().column.empty(); }

std::string list(const Table& table) {
  std::string out =
      "| | expected | measured | off by | z | expected by |\n|---|---|---|---|---|---|\n";
  for (const Figure& figure : table.figures) {
    const Truth& truth = *figure.truth;
    const std::optional<double> z = z_of(figure);
    out += "| " + figure.row + " | " +
           (truth.error > 0 ? with_error({truth.value, truth.error}) : text("%.6g", truth.value)) +
           " | " + with_error(figure.measured) +
           text(" | %+.3f %% | ", 100 * (figure.measured.mean / truth.value - 1)) +
           (z                     ? text("%+.1f", *z)
            : truth.tolerance > 0 ? text("within %g", truth.tolerance)
                                  : "exact") +
           " | " + truth.source + " |\n";
  }
  return out;
}

std::string cell(const Figure* figure) {
  if (!figure) return "";
  std::string out = with_error(figure->measured);
  if (const std::optional<double> z = z_of(*figure)) return out + text(" (z %+.1f)", *z);
  if (figure->truth && figure->truth->tolerance > 0 && figure->truth->value != 0)
    out += " (" + figure->truth->source + text(": %g)", figure->truth->value);
  return out;
}

/// A row for each figure's row and a column for each quantity.
std::string columns(const Table& table, bool soft) {
  std::vector<std::string> rows, quantities;
  for (const Figure& figure : table.figures) {
    if (figure.soft != soft) continue;
    bench::remember(rows, figure.row);
    bench::remember(quantities, figure.column);
  }
  return bench::grid(rows, quantities, [&](const std::string& row, std::size_t column) {
    const Figure* figure = table.find(row, quantities[column]);
    return soft && figure ? text("%.0f", figure->measured.mean) : cell(figure);
  });
}

std::string verdict_text(const Report& report) {
  const Verdict v = judge(report);
  std::string out =
      v.disagree.empty()
          ? text("**All %d figures with a known value agree with it.** ", v.figures + v.held)
          : text("**%zu of %d figures with a known value disagree with it**: ", v.disagree.size(),
                 v.figures + v.held);
  for (std::size_t i = 0; i < v.disagree.size(); ++i)
    out += (i ? "; " : "") + v.disagree[i] + (i + 1 == v.disagree.size() ? ".\n" : "");
  out += text(
      "Of the %d that chance decides, the largest |z| is %.2f (%s); among so many, a right program "
      "exceeds %.2f once in a hundred runs (Šidák 1967). The mean of z² is %.2f, 1 where the "
      "standard "
      "errors are honest. The other %d are exact to single precision, or held to a stated bound.\n",
      v.figures, v.largest, v.where.c_str(), v.threshold, v.mean_square, v.held);
  return out;
}

}  // namespace

std::string markdown(const Report& report) {
  std::string out =
      "# Accuracy\n\n"
      "Written by `build/release/bin/accuracy --out docs` (tests/bench/accuracy) from what it "
      "measures; do not edit. `accuracy --check docs/accuracy.json --seed 2` measures again with "
      "other "
      "random numbers and fails where a figure leaves the standard errors of both runs. ";
  out += text("This run: effort %g, seed %llu.\n\n", report.effort,
              static_cast<unsigned long long>(report.seed));
  out += verdict_text(report);
  out +=
      "\nA figure after ± is one standard error, told by the spread between independent passes; z "
      "is "
      "(measured - expected) / standard error of both. r and s are coordinates of the cube (alpha "
      "= "
      "r², s for d_ref = half the radius), alpha, sigma_s and sigma_a the coefficients. All "
      "numbers "
      "are in [accuracy.json](accuracy.json).\n";
  for (const Table& table : report.tables)
    out += bench::section(table, is_list(table) ? list(table) : columns(table, false), "plots");
  std::string times;
  for (const Table& table : report.tables)
    if (std::ranges::count(table.figures, true, &Figure::soft))
      times += "\n" + table.title + ":\n\n" + columns(table, true);
  if (!times.empty())
    out +=
        "\n## Times\n\nThese depend on the machine and on what else it does: read their ratios. "
        "CPU nanoseconds per camera sample.\n" +
        times;
  return out;
}

}  // namespace translucube::accuracy

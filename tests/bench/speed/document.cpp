// The figures as a page to read.

#include "tests/bench/speed/document.h"

#include <algorithm>
#include <cmath>

#include "tests/bench/speed/reasons.h"

namespace translucube::speed {
namespace {

std::string number(const Figure& figure) {
  return std::isfinite(figure.value) ? text(figure.format.c_str(), figure.value) : "-";
}

std::string bound(const Target& target) {
  return text(target.sense == Target::Sense::at_most ? "≤ %g" : "≥ %g", target.bound);
}

std::string verdict_on(const Figure& figure) {
  if (figure.target->met(figure.value)) return "yes";
  return text("**no**, %.2g×", figure.target->overrun(figure.value));
}

/// A row for each figure's row and a column for each quantity; behind a quantity with targets what
/// they are and whether they are met.
std::string columns(const Table& table) {
  enum class Part { value, target, met };
  struct Column {
    std::string quantity;
    Part part;
  };
  std::vector<Column> parts;
  std::vector<std::string> quantities, headers;
  for (const Figure& figure : table.figures) bench::remember(quantities, figure.column);
  const auto add = [&](const std::string& header, const std::string& quantity, Part part) {
    headers.push_back(header);
    parts.push_back({quantity, part});
  };
  for (const std::string& quantity : quantities) {
    add(quantity, quantity, Part::value);
    if (std::ranges::none_of(table.figures, [&](const Figure& figure) {
          return figure.column == quantity && figure.target;
        }))
      continue;
    add("target", quantity, Part::target);
    add("met", quantity, Part::met);
  }
  return bench::grid(table.rows(), headers, [&](const std::string& row, std::size_t column) {
    const auto& [quantity, part] = parts[column];
    const Figure* figure = table.find(row, quantity);
    if (!figure) return std::string();
    if (part == Part::value) return number(*figure);
    if (!figure->target) return std::string();
    return part == Part::target ? bound(*figure->target) : verdict_on(*figure);
  });
}

std::string verdict_text(const Report& report) {
  const Verdict verdict = judge(report);
  const std::size_t all = verdict.missed.size() + static_cast<std::size_t>(verdict.met);
  std::string out = text("**%d of %zu targets are met.**\n", verdict.met, all);
  if (verdict.missed.empty()) return out;
  out += "\nMissed:\n\n";
  for (const Miss& miss : verdict.missed) {
    const std::string why = reason_for(miss.name);
    out += "- " + miss.name +
           text(": %.3g, target %s, missed by %.2g×.", miss.value, bound(miss.target).c_str(),
                miss.overrun) +
           (why.empty() ? "" : " " + why) + "\n";
  }
  return out;
}

}  // namespace

std::string markdown(const Report& report) {
  std::string out =
      "# Speed\n\n"
      "Written by `build/release/bin/speed --out docs` (tests/bench/speed) from what it measures; "
      "do not edit. ";
  out += text("This run: effort %g, seed %llu, %d threads, %s; %.0f CPU s.\n\n", report.effort,
              static_cast<unsigned long long>(report.seed), report.threads, report.machine.c_str(),
              report.cpu_seconds);
  out += verdict_text(report);
  out +=
      "\nSpeed is relMSE × CPU seconds, which does not depend on the number of samples where they "
      "are independent: relMSE = mean (a - b)² / (2 (ref² + 0.01)) over channels and pixels of two "
      "renders with independent seeds, the 0.1 % largest pixels set aside, and untrimmed; ref is "
      "their mean, over 5 × 5 pixels where they are noisy; CPU seconds are those of one render. "
      "The peers are Cycles (Blender 3.4.1), Mitsuba 0.6 and pbrt-v4 on the same scene and "
      "materials, measured on a 2-core AMD EPYC; *best peer* is the best of the three. Their times "
      "are soft by some tens of percent. All numbers are in [speed.json](speed.json).\n";
  for (const Table& table : report.tables) out += bench::section(table, columns(table), "speed");
  return out;
}

}  // namespace translucube::speed

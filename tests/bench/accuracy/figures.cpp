#include "tests/bench/accuracy/figures.h"

#include <algorithm>

#include "renderer/base/sampler.h"
#include "tests/bench/report/json.h"
#include "tests/support/chi2.h"

namespace translucube::accuracy {
namespace {

std::string name_of(const Table& table, const Figure& figure) {
  return table.title + ", " + figure.row + (figure.column.empty() ? "" : ", " + figure.column);
}

/// Without a z: within the tolerance, beside what chance explains.
bool held(const Figure& figure, double threshold) {
  const Truth& truth = *figure.truth;
  const double allowed = std::max(truth.tolerance, rounding * std::fabs(truth.value));
  return std::fabs(figure.measured.mean - truth.value) <=
         allowed + threshold * std::hypot(figure.measured.standard_error, truth.error);
}

}  // namespace

std::uint32_t Run::samples(std::uint32_t at_full_effort) const {
  return 4 * std::max(4u, static_cast<std::uint32_t>(at_full_effort * effort_ / 4));
}

int Run::walks(int at_full_effort) const {
  return std::max(1000, static_cast<int>(at_full_effort * effort_));
}

std::uint64_t Run::next_seed() { return hash_combine(seed_, ++figures_); }

std::optional<double> z_of(const Figure& figure) {
  if (!figure.truth || figure.truth->tolerance > 0) return {};
  const Truth& truth = *figure.truth;
  const double chance = std::hypot(figure.measured.standard_error, truth.error);
  const double floor = rounding * std::fabs(truth.value);
  if (chance <= floor) return {};
  return (figure.measured.mean - truth.value) / std::hypot(chance, floor);
}

double sidak_z(int figures) {
  const double level = test::sidak(std::max(figures, 1));
  double low = 0, high = 10;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (std::erfc(middle / std::numbers::sqrt2) > level ? low : high) = middle;
  }
  return low;
}

Verdict judge(const Report& report) {
  Verdict verdict;
  for (const Table& table : report.tables)
    for (const Figure& figure : table.figures) {
      if (!figure.truth) continue;
      const std::optional<double> z = z_of(figure);
      if (!z) {
        ++verdict.held;
        continue;
      }
      ++verdict.figures;
      verdict.mean_square += *z * *z;
      if (!(std::fabs(*z) <= verdict.largest)) {
        verdict.largest = std::fabs(*z);
        verdict.where = name_of(table, figure);
      }
    }
  verdict.mean_square /= std::max(1, verdict.figures);
  verdict.threshold = sidak_z(verdict.figures);
  for (const Table& table : report.tables)
    for (const Figure& figure : table.figures) {
      const std::optional<double> z = z_of(figure);
      const bool fine = !std::isfinite(figure.measured.mean) ? false
                        : !figure.truth                      ? true
                        : z                                  ? std::fabs(*z) <= verdict.threshold
                                                             : held(figure, verdict.threshold);
      if (!fine) verdict.disagree.push_back(name_of(table, figure));
    }
  return verdict;
}

nlohmann::json to_json(const Report& report) {
  return bench::to_json(report, [](const Figure& figure) {
    nlohmann::json entry{{"row", figure.row},
                         {"measured", figure.measured.mean},
                         {"standard_error", figure.measured.standard_error}};
    if (!figure.column.empty()) entry["column"] = figure.column;
    if (figure.soft) entry["soft"] = true;
    if (figure.truth)
      entry["truth"] = {{"value", figure.truth->value},
                        {"standard_error", figure.truth->error},
                        {"tolerance", figure.truth->tolerance},
                        {"source", figure.truth->source}};
    if (const std::optional<double> z = z_of(figure)) entry["z"] = *z;
    return entry;
  });
}

Report report_from_json(const nlohmann::json& json) {
  return bench::report_from_json<Table>(json, [](const nlohmann::json& f) {
    Figure figure{f.at("row"), f.value("column", ""), {f.at("measured"), f.at("standard_error")}};
    figure.soft = f.value("soft", false);
    if (f.contains("truth")) {
      const nlohmann::json& truth = f["truth"];
      figure.truth = Truth{truth.at("value"), truth.at("standard_error"), truth.at("tolerance"),
                           truth.at("source")};
    }
    return figure;
  });
}

std::vector<std::string> compare(const Report& fresh, const Report& committed) {
  std::vector<std::string> complaints;
  int count = 0;
  for (const Table& table : fresh.tables)
    count += static_cast<int>(std::ranges::count(table.figures, false, &Figure::soft));
  const double threshold = sidak_z(count);
  const auto table_of = [](const Report& report, const std::string& id) -> const Table* {
    const auto found = std::ranges::find(report.tables, id, &Table::id);
    return found == report.tables.end() ? nullptr : &*found;
  };
  for (const Table& table : committed.tables)
    for (const Figure& old : table.figures) {
      if (old.soft) continue;
      const Table* other = table_of(fresh, table.id);
      if (!other || !other->find(old.row, old.column))
        complaints.push_back(name_of(table, old) + ": committed, but not measured");
    }
  for (const Table& table : fresh.tables)
    for (const Figure& figure : table.figures) {
      if (figure.soft) continue;
      const Table* other = table_of(committed, table.id);
      const Figure* old = other ? other->find(figure.row, figure.column) : nullptr;
      if (!old) {
        complaints.push_back(name_of(table, figure) + ": measured, but not committed");
        continue;
      }
      const double a = figure.measured.mean, b = old->measured.mean;
      const double error = std::hypot(figure.measured.standard_error, old->measured.standard_error);
      // A largest error over pixels has no standard error: its bound is what both runs must keep.
      const bool bound = error == 0 && figure.truth && figure.truth->tolerance > 0;
      const bool same =
          bound ? held(figure, 0)
                : std::fabs(a - b) <= threshold * error + rounding * std::fmax(1.0, std::fabs(b));
      if (!same)
        complaints.push_back(
            name_of(table, figure) +
            text(": %.6g, committed %.6g, standard error of both %.2g", a, b, error));
    }
  return complaints;
}

}  // namespace translucube::accuracy

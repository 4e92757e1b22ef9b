#include "tests/bench/speed/figures.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tests/bench/report/json.h"

namespace translucube::speed {

void Table::add(std::string row, const Quantity& quantity, double value,
                std::optional<Target> target) {
  figures.push_back(
      {std::move(row), quantity.name, value, quantity.format, quantity.spread, target});
}

double Table::value(const std::string& row, const Quantity& quantity) const {
  const Figure* figure = find(row, quantity.name);
  if (!figure) throw std::logic_error(id + " has no " + row + ", " + quantity.name);
  return figure->value;
}

std::string name_of(const Table& table, const Figure& figure) {
  return table.id + ", " + figure.row + ", " + figure.column;
}

Verdict judge(const Report& report) {
  Verdict verdict;
  for (const Table& table : report.tables)
    for (const Figure& figure : table.figures) {
      if (!figure.target) continue;
      if (figure.target->met(figure.value))
        ++verdict.met;
      else
        verdict.missed.push_back({name_of(table, figure), figure.value,
                                  figure.target->overrun(figure.value), *figure.target});
    }
  return verdict;
}

nlohmann::json to_json(const Report& report) {
  nlohmann::json json = bench::to_json(report, [](const Figure& figure) {
    nlohmann::json entry{{"row", figure.row}, {"quantity", figure.column}, {"value", figure.value}};
    if (figure.spread > 0) entry["spread"] = figure.spread;
    if (figure.target) {
      const bool most = figure.target->sense == Target::Sense::at_most;
      entry["target"] = {{most ? "at_most" : "at_least", figure.target->bound}};
      entry["met"] = figure.target->met(figure.value);
    }
    return entry;
  });
  json["threads"] = report.threads;
  json["machine"] = report.machine;
  return json;
}

Report report_from_json(const nlohmann::json& json) {
  Report report;
  static_cast<bench::Report<Table>&>(
      report) = bench::report_from_json<Table>(json, [](const nlohmann::json& f) {
    const nlohmann::json& value = f.at("value");
    return Figure{
        f.at("row"), f.at("quantity"),       value.is_null() ? std::nan("") : value.get<double>(),
        "",          f.value("spread", 0.0), {}};
  });
  return report;
}

std::vector<std::string> compare(const Report& fresh, const Report& committed) {
  if (fresh.effort != committed.effort)
    throw std::invalid_argument(
        text("the committed figures are of effort %g: ask for the same", committed.effort));
  std::vector<std::string> complaints;
  for (const Table& table : fresh.tables) {
    const auto old = std::ranges::find(committed.tables, table.id, &Table::id);
    for (const Figure& figure : table.figures) {
      if (figure.spread == 0) continue;
      const Figure* before =
          old == committed.tables.end() ? nullptr : old->find(figure.row, figure.column);
      if (!before)
        complaints.push_back(name_of(table, figure) + ": measured, but not committed");
      else if (!(figure.value <= before->value * (1 + figure.spread)))
        complaints.push_back(name_of(table, figure) +
                             text(": %.4g, committed %.4g", figure.value, before->value));
    }
  }
  return complaints;
}

std::uint32_t Run::samples(std::uint32_t at_full_effort) const {
  return 4 * std::max(1u, static_cast<std::uint32_t>(at_full_effort * effort / 4));
}

int Run::repetitions(int at_full_effort) const {
  return std::max(1, static_cast<int>(at_full_effort * effort)) | 1;
}

bool Run::chosen(const std::string& material) const {
  return materials.empty() || std::ranges::count(materials, material) > 0;
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace translucube::speed

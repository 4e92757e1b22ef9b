#pragma once

// Reports as JSON and back.

#include <nlohmann/json.hpp>

#include "tests/bench/report/table.h"

namespace translucube::bench {

/// `entry(figure)` is the figure's JSON.
template <class Table, class Entry>
nlohmann::json to_json(const Report<Table>& report, Entry entry) {
  nlohmann::json tables = nlohmann::json::array();
  for (const Table& table : report.tables) {
    nlohmann::json figures = nlohmann::json::array();
    for (const auto& figure : table.figures) figures.push_back(entry(figure));
    tables.push_back({{"id", table.id}, {"title", table.title}, {"figures", std::move(figures)}});
  }
  return {{"effort", report.effort},
          {"seed", report.seed},
          {"cpu_seconds", report.cpu_seconds},
          {"tables", std::move(tables)}};
}

/// The report as far as it is compared. `figure_of(entry)` is the JSON's figure.
template <class Table, class FigureOf>
Report<Table> report_from_json(const nlohmann::json& json, FigureOf figure_of) {
  Report<Table> report;
  report.effort = json.at("effort");
  report.seed = json.at("seed");
  for (const nlohmann::json& from : json.at("tables")) {
    Table& table = report.tables.emplace_back();
    table.id = from.at("id");
    table.title = from.at("title");
    for (const nlohmann::json& entry : from.at("figures"))
      table.figures.push_back(figure_of(entry));
  }
  return report;
}

}  // namespace translucube::bench

#pragma once

// The parts that the answers about renders and sweeps share, as JSON values.

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "api/answer/event.h"

namespace translucube::api {

nlohmann::json finite_or_null(double value);

template <typename T>
nlohmann::json value_or_null(const std::optional<T>& value) {
  return value ? nlohmann::json(*value) : nlohmann::json(nullptr);
}

/// JSON text as the store keeps it. Throws std::invalid_argument if it is none.
nlohmann::json parsed(const std::string& text, const char* what);
nlohmann::json parsed_or_null(const std::optional<std::string>& text, const char* what);

/// {"id", "state", "created_at", "started_at", "finished_at"} of a render or sweep.
template <typename Status>
nlohmann::json life_object(const Status& status) {
  return {{"id", status.id},
          {"state", name(status.state)},
          {"created_at", status.created_at},
          {"started_at", value_or_null(status.started_at)},
          {"finished_at", value_or_null(status.finished_at)}};
}

nlohmann::json progress_object(const Progress& progress);
nlohmann::json counts_object(const StateCounts& counts);

}  // namespace translucube::api

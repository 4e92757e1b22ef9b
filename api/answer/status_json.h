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

nlohmann::json progress_object(const Progress& progress);
nlohmann::json counts_object(const StateCounts& counts);

}  // namespace translucube::api

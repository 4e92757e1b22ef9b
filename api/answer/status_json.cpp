#include "api/answer/status_json.h"

#include <cmath>
#include <stdexcept>

namespace translucube::api {

using nlohmann::json;

json finite_or_null(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

json parsed(const std::string& text, const char* what) {
  json value = json::parse(text, nullptr, false);
  if (value.is_discarded()) throw std::invalid_argument(std::string("not JSON: ") + what);
  return value;
}

json parsed_or_null(const std::optional<std::string>& text, const char* what) {
  return text ? parsed(*text, what) : json(nullptr);
}

json progress_object(const Progress& progress) {
  // Zero is what a Progress holds before it was ever computed; no estimate is ever exactly 0 but
  // that of a picture without noise, which has passes.
  const bool unknown = progress.passes == 0 && progress.relative_error == 0;
  return {{"samples", progress.samples},
          {"total_samples", value_or_null(progress.total_samples)},
          {"relative_error", unknown ? json(nullptr) : finite_or_null(progress.relative_error)},
          {"seconds", finite_or_null(progress.seconds)},
          {"eta_seconds",
           progress.eta_seconds ? finite_or_null(*progress.eta_seconds) : json(nullptr)}};
}

json counts_object(const StateCounts& counts) {
  json object;
  for (const JobState state : all_job_states)
    object[std::string(name(state))] = counts[static_cast<std::size_t>(state)];
  return object;
}

}  // namespace translucube::api

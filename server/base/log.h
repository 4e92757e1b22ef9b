#pragma once

// Log lines that machines can read: logfmt (key=value) or JSON, one event a line. Whatever a client
// sends stays inside its value: no control character, no line break, no forged key.

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace translucube::server {

enum class LogFormat { logfmt, json };

using LogValue = std::variant<std::string_view, std::int64_t, double>;
using LogFields = std::vector<std::pair<std::string_view, LogValue>>;

/// ` key=value` for each field, or `,"key":value`. Text is cut at 512 bytes; bytes that are not
/// visible ASCII become \xHH, or in JSON \u00HH. Keys are ours, and plain.
std::string log_text(LogFormat format, const LogFields& fields);

/// Logs to standard error from here on: time (UTC), level, then the fields, or for a plain message
/// the field `message`. Nobody waits for standard error: what is not read in time is lost, and
/// counted.
void set_up_log(LogFormat format);
/// Waits a moment for what was logged to be written: before the process leaves at once.
void flush_log();
std::uint64_t lost_log_lines();

/// One line of these fields, at the level info, or warn where the service is at fault.
enum class LogLevel { info, warn };
void log_event(LogLevel level, const LogFields& fields);

}  // namespace translucube::server

#include "server/log.h"

#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <chrono>

#include "server/clock.h"

namespace translucube::server {
namespace {

using api::LogFormat;

constexpr std::size_t longest_text = 512;
// Begins a payload that is fields already; no plain message has it.
constexpr char fields_follow = '\x1e';
std::atomic<LogFormat> current_format = LogFormat::logfmt;

std::string quoted(LogFormat format, std::string_view text) {
  std::string result = "\"";
  for (const char c : text.substr(0, longest_text)) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += '\\';
      result += c;
    } else if (byte < 32 || byte > 126) {
      result += format == LogFormat::json ? "\\u00" : "\\x";
      result += "0123456789abcdef"[byte >> 4];
      result += "0123456789abcdef"[byte & 15];
    } else {
      result += c;
    }
  }
  return result + '"';
}

std::string value_text(LogFormat format, const LogValue& value) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) return std::to_string(*number);
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:.6g}", *number);
  const std::string& text = std::get<std::string>(value);
  const bool plain =
      !text.empty() && text.size() <= longest_text && std::ranges::all_of(text, [](char c) {
        return c > ' ' && c < 127 && c != '"' && c != '=' && c != '\\';
      });
  return plain && format == LogFormat::logfmt ? text : quoted(format, text);
}

class Formatter : public spdlog::formatter {
 public:
  explicit Formatter(LogFormat format) : format_(format) {}

  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& out) override {
    using namespace std::chrono;
    const std::string time =
        rfc3339(duration_cast<milliseconds>(message.time.time_since_epoch()).count());
    const auto level_view = spdlog::level::to_string_view(message.level);
    const std::string level(level_view.data(), level_view.size());
    std::string_view text(message.payload.data(), message.payload.size());
    const bool has_fields = text.starts_with(fields_follow);
    if (has_fields) text.remove_prefix(1);

    std::string line = log_text(format_, {{"time", time}, {"level", level}});
    line += has_fields ? std::string(text) : log_text(format_, {{"message", std::string(text)}});
    line.erase(0, 1);
    if (format_ == LogFormat::json) line = '{' + line + '}';
    line += '\n';
    out.append(line.data(), line.data() + line.size());
  }

  std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<Formatter>(format_);
  }

 private:
  LogFormat format_;
};

}  // namespace

std::string log_text(LogFormat format, const LogFields& fields) {
  std::string text;
  for (const auto& [key, value] : fields) {
    if (format == LogFormat::json)
      text += ",\"" + std::string(key) + "\":";
    else
      text += ' ' + std::string(key) + '=';
    text += value_text(format, value);
  }
  return text;
}

void set_up_log(LogFormat format) {
  current_format = format;
  auto logger = std::make_shared<spdlog::logger>("translucube",
                                                 std::make_shared<spdlog::sinks::stderr_sink_mt>());
  logger->set_formatter(std::make_unique<Formatter>(format));
  spdlog::set_default_logger(std::move(logger));
}

void log_event(LogLevel level, const LogFields& fields) {
  const std::string line = fields_follow + log_text(current_format, fields);
  spdlog::default_logger_raw()->log(
      level == LogLevel::warn ? spdlog::level::warn : spdlog::level::info,
      spdlog::string_view_t(line.data(), line.size()));
}

}  // namespace translucube::server

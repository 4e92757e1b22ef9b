#include "server/base/log.h"

#include <spdlog/sinks/sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <chrono>
#include <memory>
#include <mutex>

#include "server/base/clock.h"
#include "server/base/line_writer.h"

namespace translucube::server {
namespace {

constexpr std::size_t longest_text = 512;
// Begins a payload that is fields already; no plain message has it.
constexpr char fields_follow = '\x1e';
std::atomic<LogFormat> current_format = LogFormat::logfmt;

void append_quoted(std::string& out, LogFormat format, std::string_view text) {
  out += '"';
  for (const char c : text.substr(0, longest_text)) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (byte < 32 || byte > 126) {
      out += format == LogFormat::json ? "\\u00" : "\\x";
      out += "0123456789abcdef"[byte >> 4];
      out += "0123456789abcdef"[byte & 15];
    } else {
      out += c;
    }
  }
  out += '"';
}

template <typename... Form>
void append_number(std::string& out, auto number, Form... form) {
  std::array<char, 32> digits;
  const auto [end, error] =
      std::to_chars(digits.data(), digits.data() + digits.size(), number, form...);
  out.append(digits.data(), end);
}

bool is_plain(std::string_view text) {
  return !text.empty() && text.size() <= longest_text && std::ranges::all_of(text, [](char c) {
    return c > ' ' && c < 127 && c != '"' && c != '=' && c != '\\';
  });
}

void append_value(std::string& out, LogFormat format, const LogValue& value) {
  if (const auto* number = std::get_if<std::int64_t>(&value)) {
    append_number(out, *number);
  } else if (const auto* real = std::get_if<double>(&value)) {
    append_number(out, *real, std::chars_format::general, 6);
  } else {
    const std::string_view text = std::get<std::string_view>(value);
    if (format == LogFormat::logfmt && is_plain(text))
      out += text;
    else
      append_quoted(out, format, text);
  }
}

void append_field(std::string& out, LogFormat format, std::string_view key, const LogValue& value) {
  if (format == LogFormat::json) {
    out += ",\"";
    out += key;
    out += "\":";
  } else {
    out += ' ';
    out += key;
    out += '=';
  }
  append_value(out, format, value);
}

class Formatter : public spdlog::formatter {
 public:
  explicit Formatter(LogFormat format) : format_(format) {}

  void format(const spdlog::details::log_msg& message, spdlog::memory_buf_t& out) override {
    using namespace std::chrono;
    const std::string time =
        rfc3339(duration_cast<milliseconds>(message.time.time_since_epoch()).count());
    const auto level = spdlog::level::to_string_view(message.level);
    std::string_view text(message.payload.data(), message.payload.size());

    std::string line;
    append_field(line, format_, "time", time);
    append_field(line, format_, "level", std::string_view(level.data(), level.size()));
    if (text.starts_with(fields_follow))
      line += text.substr(1);
    else
      append_field(line, format_, "message", text);
    line += format_ == LogFormat::json ? "}\n" : "\n";
    if (format_ == LogFormat::json)
      line.front() = '{';  // for the first comma
    else
      line.erase(0, 1);
    out.append(line.data(), line.data() + line.size());
  }

  std::unique_ptr<spdlog::formatter> clone() const override {
    return std::make_unique<Formatter>(format_);
  }

 private:
  LogFormat format_;
};

/// Lines to standard error, by who does not wait for it.
class StandardError : public spdlog::sinks::sink {
 public:
  explicit StandardError(LogFormat format) : formatter_(format), writer_(STDERR_FILENO) {
    writer_.tell_drops([](std::uint64_t dropped) {
      const std::string text =
          std::to_string(dropped) + " lines of the log are lost: nobody read them";
      spdlog::memory_buf_t line;
      Formatter(current_format)
          .format({spdlog::source_loc{}, "translucube", spdlog::level::warn, text}, line);
      return std::string(line.data(), line.size());
    });
  }
  void log(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    {
      const std::lock_guard lock(mutex_);
      formatter_.format(message, line);
    }
    writer_.add({line.data(), line.size()});
  }
  void flush() override { writer_.flush(); }
  void set_pattern(const std::string&) override {}
  void set_formatter(std::unique_ptr<spdlog::formatter>) override {}
  std::uint64_t dropped() const { return writer_.dropped(); }

 private:
  std::mutex mutex_;
  Formatter formatter_;
  LineWriter writer_;
};

std::mutex sink_mutex;
std::weak_ptr<StandardError> current_sink;

}  // namespace

std::string log_text(LogFormat format, const LogFields& fields) {
  std::string text;
  for (const auto& [key, value] : fields) append_field(text, format, key, value);
  return text;
}

void set_up_log(LogFormat format) {
  current_format = format;
  const auto sink = std::make_shared<StandardError>(format);
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("translucube", sink));
  const std::lock_guard lock(sink_mutex);
  current_sink = sink;
}

void flush_log() { spdlog::default_logger_raw()->flush(); }

std::uint64_t lost_log_lines() {
  const std::lock_guard lock(sink_mutex);
  const auto sink = current_sink.lock();
  return sink ? sink->dropped() : 0;
}

void log_event(LogLevel level, const LogFields& fields) {
  const std::string line = fields_follow + log_text(current_format, fields);
  spdlog::default_logger_raw()->log(
      level == LogLevel::warn ? spdlog::level::warn : spdlog::level::info,
      spdlog::string_view_t(line.data(), line.size()));
}

}  // namespace translucube::server

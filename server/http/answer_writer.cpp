#include "server/http/answer_writer.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <ctime>
#include <vector>

namespace translucube::server {
namespace {

constexpr std::size_t send_chunk = 1 << 16;
constexpr std::string_view event_stream = "text/event-stream";

/// RFC 9110, 15. It may be empty, but people read it.
std::string_view reason_phrase(int status) {
  constexpr std::array<std::pair<int, std::string_view>, 29> phrases{
      {{200, "OK"},
       {202, "Accepted"},
       {201, "Created"},
       {204, "No Content"},
       {206, "Partial Content"},
       {304, "Not Modified"},
       {400, "Bad Request"},
       {401, "Unauthorized"},
       {403, "Forbidden"},
       {404, "Not Found"},
       {405, "Method Not Allowed"},
       {406, "Not Acceptable"},
       {408, "Request Timeout"},
       {409, "Conflict"},
       {410, "Gone"},
       {412, "Precondition Failed"},
       {413, "Content Too Large"},
       {414, "URI Too Long"},
       {415, "Unsupported Media Type"},
       {416, "Range Not Satisfiable"},
       {417, "Expectation Failed"},
       {421, "Misdirected Request"},
       {422, "Unprocessable Content"},
       {429, "Too Many Requests"},
       {431, "Request Header Fields Too Large"},
       {500, "Internal Server Error"},
       {501, "Not Implemented"},
       {503, "Service Unavailable"},
       {505, "HTTP Version Not Supported"}}};
  const auto found = std::ranges::find(phrases, status, &std::pair<int, std::string_view>::first);
  return found == phrases.end() ? std::string_view() : found->second;
}

/// The Date field (RFC 9110, 6.6.1 and 5.6.7).
std::string http_date() {
  constexpr std::array days{"Sun", "Mon", "Tue", "Wed", "Thu", "Fri", "Sat"};
  constexpr std::array months{"Jan", "Feb", "Mar", "Apr", "May", "Jun",
                              "Jul", "Aug", "Sep", "Oct", "Nov", "Dec"};
  thread_local std::time_t second = -1;
  thread_local std::string text;
  const std::time_t now = std::time(nullptr);
  if (now == second) return text;
  std::tm parts{};
  ::gmtime_r(&now, &parts);
  std::array<char, 40> out;
  const auto day = days.at(static_cast<std::size_t>(parts.tm_wday));
  const auto month = months.at(static_cast<std::size_t>(parts.tm_mon));
  std::snprintf(out.data(), out.size(), "%s, %02d %s %04d %02d:%02d:%02d GMT", day, parts.tm_mday,
                month, parts.tm_year + 1900, parts.tm_hour, parts.tm_min, parts.tm_sec);
  second = now;
  return text = out.data();
}

void put(std::string& head, std::string_view name, std::string_view value) {
  head.append(name).append(": ").append(value).append("\r\n");
}

std::string head_of(const HttpResponse& answer) {
  std::string head = "HTTP/1.1 " + std::to_string(answer.status) + ' ';
  head.append(reason_phrase(answer.status)).append("\r\n");
  put(head, "Date", http_date());
  for (const auto& [name, value] : answer.headers) put(head, name, value);
  put(head, "X-Content-Type-Options", "nosniff");
  return head;
}

std::uint64_t length_of(const HttpResponse& answer) {
  if (const auto* slice = std::get_if<FileSlice>(&answer.body)) return slice->length;
  return std::get<std::string>(answer.body).size();
}

bool write_file(Connection& connection, const FileSlice& slice) {
  std::vector<char> buffer(std::min<std::uint64_t>(slice.length, send_chunk));
  for (std::uint64_t done = 0; done < slice.length;) {
    const std::size_t size = std::min<std::uint64_t>(slice.length - done, buffer.size());
    try {
      slice.file->read(slice.offset + done, buffer.data(), size);
    } catch (const FileError& failure) {
      spdlog::error("{}: {}", connection.exchange()->request.id, failure.what());
      return false;  // the connection ends short of the announced length
    }
    if (!connection.write({buffer.data(), size})) return false;
    done += size;
  }
  return true;
}

std::string chunk_of(std::string_view data) {
  std::array<char, 16> size;
  char* end = std::to_chars(size.data(), size.data() + size.size(), data.size(), 16).ptr;
  return std::string(size.data(), end).append("\r\n").append(data).append("\r\n");
}

/// HTTP/1.0 knows no chunks: there the end of the connection ends the stream.
bool write_stream(Connection& connection, EventStream& stream, bool chunked,
                  const std::atomic<bool>& stopping) {
  if (!connection.flush()) return false;
  while (!stopping) {
    std::optional<std::string> events;
    try {
      events = stream.next();
    } catch (const std::exception& failure) {
      spdlog::error("{}: {}", connection.exchange()->request.id, failure.what());
      return false;
    }
    if (!events) break;
    if (events->empty() && !connection.client_listens()) return false;
    if (events->empty()) continue;
    if (!connection.write(chunked ? chunk_of(*events) : *events) || !connection.flush())
      return false;
    connection.catch_up();
  }
  stream.next = nullptr;  // whoever sees the end finds its place free
  return !chunked || connection.write("0\r\n\r\n");
}

}  // namespace

Sent write_answer(Connection& connection, HttpResponse answer, bool close,
                  const std::atomic<bool>& stopping) {
  const Exchange& exchange = *connection.exchange();
  const bool http_1_0 = exchange.head.minor == 0;
  auto* stream = std::get_if<EventStream>(&answer.body);
  const bool persists = exchange.head.keep_alive && !close && !stopping && !(stream && http_1_0);

  std::string head = head_of(answer);
  put(head, "X-Request-Id", exchange.request.id);
  // RFC 9110, 8.6: no length with 204, and with 304 only the one that 200 would have had.
  const bool has_content = answer.status != 204 && answer.status != 304;
  if (has_content && (stream || !answer.content_type.empty()))
    put(head, "Content-Type", stream ? event_stream : std::string_view(answer.content_type));
  // Else nginx would hold events back.
  if (stream) head += "Cache-Control: no-store\r\nX-Accel-Buffering: no\r\n";
  if (stream && !http_1_0) put(head, "Transfer-Encoding", "chunked");
  if (has_content && !stream) put(head, "Content-Length", std::to_string(length_of(answer)));
  if (!persists)
    put(head, "Connection", "close");
  else if (http_1_0)
    put(head, "Connection", "keep-alive");
  head += "\r\n";

  bool whole = connection.write(head);
  if (has_content && exchange.request.method != "HEAD" && whole) {
    if (stream)
      whole = write_stream(connection, *stream, !http_1_0, stopping);
    else if (const auto* slice = std::get_if<FileSlice>(&answer.body))
      whole = write_file(connection, *slice);
    else
      whole = connection.write(std::get<std::string>(answer.body));
  }
  if (!connection.flush() || !whole) return Sent::cut;
  return persists ? Sent::persists : Sent::ends;
}

std::string last_answer(const HttpResponse& answer) {
  std::string text = head_of(answer);
  put(text, "Content-Type", answer.content_type);
  put(text, "Content-Length", std::to_string(length_of(answer)));
  put(text, "Connection", "close");
  return text.append("\r\n").append(std::get<std::string>(answer.body));
}

}  // namespace translucube::server

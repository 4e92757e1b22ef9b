#include "server/http/exchange.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>

namespace translucube::server {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::seconds longest_upload(60);
constexpr std::size_t send_chunk = 1 << 16;

void put(FileSlice part, const HttpResponse& answer, const std::string& id,
         httplib::Response& response) {
  if (part.length == 0) return;
  response.set_content_provider(
      part.length, answer.content_type,
      [part = std::move(part), id](std::size_t offset, std::size_t length,
                                   httplib::DataSink& sink) {
        std::array<char, send_chunk> buffer;
        const std::size_t size = std::min(length, buffer.size());
        try {
          part.file->read(part.offset + offset, buffer.data(), size);
        } catch (const FileError& failure) {
          spdlog::error("{}: {}", id, failure.what());
          return false;  // the connection ends short of the announced length
        }
        return sink.write(buffer.data(), size);
      });
}

void put(EventStream stream, const std::string& id, const SocketServer& server,
         httplib::Response& response) {
  if (!response.has_header("Cache-Control")) response.set_header("Cache-Control", "no-store");
  // Else nginx would hold events back.
  if (!response.has_header("X-Accel-Buffering")) response.set_header("X-Accel-Buffering", "no");
  response.set_chunked_content_provider(
      "text/event-stream",
      [stream = std::move(stream), id, &server, &connection = server.connection()](
          std::size_t, httplib::DataSink& sink) {
        std::optional<std::string> events;
        try {
          if (!server.stopping()) events = stream.next();
        } catch (const std::exception& failure) {
          spdlog::error("{}: {}", id, failure.what());
          return false;
        }
        if (!events) {
          sink.done();
          return true;
        }
        if (events->empty()) return connection.flush() && connection.client_listens();
        return sink.write(events->data(), events->size()) && connection.flush();
      });
}

}  // namespace

void put_answer(HttpResponse answer, const std::string& request_id, const SocketServer& server,
                httplib::Response& response, bool close) {
  response.status = answer.status;
  response.body.clear();
  for (const auto& [name, value] : answer.headers) response.set_header(name, value);
  response.set_header("X-Request-Id", request_id);
  response.set_header("X-Content-Type-Options", "nosniff");
  if (close) {
    response.set_header("Connection", "close");
    server.connection().end_after_request();
  }
  if (auto* slice = std::get_if<FileSlice>(&answer.body))
    put(std::move(*slice), answer, request_id, response);
  else if (auto* stream = std::get_if<EventStream>(&answer.body))
    put(std::move(*stream), request_id, server, response);
  else if (auto& body = std::get<std::string>(answer.body); !body.empty())
    response.set_content(std::move(body), answer.content_type);
}

Upload receive(httplib::Request& request, const httplib::ContentReader& reader,
               std::uint64_t limit) {
  Upload upload;
  std::uint64_t received = 0;
  const auto start = steady_clock::now();
  const auto take = [&](const char* data, std::size_t size) {
    received += size;
    upload.too_large = received > limit;
    if (upload.too_large)
      upload.body.clear();
    else
      upload.body.append(data, size);
    return received <= longest_drain && steady_clock::now() - start < longest_upload;
  };
  request.headers.erase("Content-Encoding");
  // The library would take a multipart body apart.
  if (request.is_multipart_form_data()) {
    request.headers.erase("Content-Type");
    request.headers.emplace("Content-Type", "application/octet-stream");
  }
  upload.whole = reader(take);
  return upload;
}

}  // namespace translucube::server

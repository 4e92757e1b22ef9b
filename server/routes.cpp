#include "server/routes.h"

#include <httplib.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>

#include "server/http_adapter.h"
#include "server/ids.h"

namespace translucube::server {
namespace {

using std::chrono::steady_clock;
using Handled = httplib::Server::HandlerResponse;

constexpr const char* request_id_header = "X-Request-Id";
constexpr int read_timeout_s = 10, write_timeout_s = 30;
// An idle connection holds a thread of the pool, and the exit waits for it.
constexpr int keep_alive_s = 3;
constexpr int requests_per_connection = 1000;
constexpr std::chrono::seconds longest_upload(60);
// A body over the limit is read and dropped, so that its sender gets to read the answer; one that
// announces more than this is not.
constexpr std::uint64_t longest_drain = std::uint64_t(1) << 30;
constexpr std::size_t send_chunk = 1 << 16;

/// The request that this thread answers. A thread of the pool has one at a time.
struct Current {
  std::string id, path;
  steady_clock::time_point start;
};
thread_local Current current;

/// The library hands out const references to requests that it goes on to use, and has no other way
/// to switch off what it would do by itself.
httplib::Request& writable(const httplib::Request& request) {
  return const_cast<httplib::Request&>(request);
}

bool is_request_id(std::string_view text) {
  return !text.empty() && text.size() <= 64 && std::ranges::all_of(text, [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_' || c == '.';
  });
}

void begin(const httplib::Request& request) {
  const std::string given = request.get_header_value(request_id_header);
  current = {is_request_id(given) ? given : random_hex(8), request.path, steady_clock::now()};
}

HttpRequest plain(const httplib::Request& request, std::string body) {
  HttpRequest result{request.method, current.path, {}, {}, std::move(body)};
  for (const auto& [name, value] : request.params) result.query.emplace_back(name, value);
  for (const auto& [name, value] : request.headers) {
    std::string lower = name;
    std::ranges::transform(lower, lower.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const auto [it, fresh] = result.headers.emplace(lower, value);
    if (!fresh) it->second += ", " + value;
  }
  return result;
}

/// `close`: the stream cannot be read on, because a body was left in it.
void send(const HttpResponse& answer, httplib::Response& response, bool close = false) {
  response.status = answer.status;
  response.body.clear();
  for (const auto& [name, value] : answer.headers) response.set_header(name, value);
  response.set_header(request_id_header, current.id);
  response.set_header("X-Content-Type-Options", "nosniff");
  if (close) response.set_header("Connection", "close");
  if (const auto* slice = std::get_if<FileSlice>(&answer.body)) {
    if (slice->length == 0) return;
    const FileSlice part = *slice;
    response.set_content_provider(
        part.length, answer.content_type,
        [part](std::size_t offset, std::size_t length, httplib::DataSink& sink) {
          std::array<char, send_chunk> buffer;
          const std::size_t size = std::min(length, buffer.size());
          try {
            part.file->read(part.offset + offset, buffer.data(), size);
          } catch (const FileError& failure) {
            spdlog::error("{}: {}", current.id, failure.what());
            return false;  // the connection ends short of the announced length
          }
          return sink.write(buffer.data(), size);
        });
    return;
  }
  const std::string& body = std::get<std::string>(answer.body);
  if (!close) {
    if (!body.empty()) response.set_content(body, answer.content_type);
    return;
  }
  // Only a provider that gives up makes the library close the connection: after its last byte.
  response.set_content_provider(body.size(), answer.content_type,
                                [body](std::size_t offset, std::size_t, httplib::DataSink& sink) {
                                  sink.write(body.data() + offset, body.size() - offset);
                                  return false;
                                });
}

struct Upload {
  std::string body;
  bool whole = false, too_large = false;
};

/// Reads a body of at most `limit` bytes, as sent: no decoding, which could blow it up.
Upload receive(const httplib::Request& request, const httplib::ContentReader& reader,
               std::uint64_t limit) {
  Upload upload;
  std::uint64_t received = 0;
  const auto take = [&](const char* data, std::size_t size) {
    received += size;
    upload.too_large = received > limit;
    if (upload.too_large)
      upload.body.clear();
    else
      upload.body.append(data, size);
    return received <= longest_drain && steady_clock::now() - current.start < longest_upload;
  };
  httplib::Headers& headers = writable(request).headers;
  headers.erase("Content-Encoding");
  // The library would take a multipart body apart.
  if (request.is_multipart_form_data()) {
    headers.erase("Content-Type");
    headers.emplace("Content-Type", "application/octet-stream");
  }
  upload.whole = reader(take);
  return upload;
}

struct Listener : httplib::Server {
  /// The library listens with a queue of five connections.
  void deepen_queue() { ::listen(svr_sock_, SOMAXCONN); }
};

}  // namespace

struct HttpServer::Impl {
  Endpoints& endpoints;
  HttpOptions options;
  Listener http;
  int port = 0;
  std::atomic<bool> entered = false, stopped = false, left = false;

  Impl(Endpoints& e, const HttpOptions& o) : endpoints(e), options(o) {}

  void answer(const httplib::Request& request, httplib::Response& response, std::string body) {
    try {
      send(respond(endpoints, plain(request, std::move(body))), response);
    } catch (const std::exception& error) {
      spdlog::error("{} {}: {}", current.id, printable(current.path), error.what());
      send(
          problem_response({api::ProblemCode::internal, "The service failed on this request.", {}}),
          response);
    }
  }

  /// Sees each request after its headers. Answers those without a body here, since the library
  /// would wait for a body that was not announced; others go on to `upload`.
  Handled route(const httplib::Request& request, httplib::Response& response) {
    begin(request);
    httplib::Request& own = writable(request);
    own.ranges.clear();                    // ranges are the business of the image alone
    own.headers.erase("Accept-Encoding");  // no compression: entity tags name the bytes
    const BodyAnnouncement announced = announced_body(request);
    if (announced.kind == BodyAnnouncement::Kind::none) {
      answer(request, response, {});
      return Handled::Handled;
    }
    const bool takes_body = request.method == "POST" || request.method == "PUT" ||
                            request.method == "PATCH" || request.method == "DELETE";
    if (announced.kind == BodyAnnouncement::Kind::malformed || !takes_body) {
      send(malformed(takes_body ? "The length of the body is not clear."
                                : "This method takes no body."),
           response, true);
      return Handled::Handled;
    }
    if (announced.length > longest_drain) {
      send(too_large(), response, true);
      return Handled::Handled;
    }
    own.path =
        "/";  // what the library compares to a regular expression, one character a stack frame
    return Handled::Unhandled;
  }

  void upload(const httplib::Request& request, httplib::Response& response,
              const httplib::ContentReader& reader) {
    const bool encoded = request.has_header("Content-Encoding") &&
                         request.get_header_value("Content-Encoding") != "identity";
    Upload upload = receive(request, reader, options.body_bytes);
    if (upload.too_large)
      send(too_large(), response, !upload.whole);
    else if (!upload.whole)
      send(malformed("The body did not arrive whole."), response, true);
    else if (encoded)
      send(problem_response({api::ProblemCode::unsupported_media_type,
                             "A body in a content coding is not taken.",
                             {}}),
           response);
    else
      answer(request, response, std::move(upload.body));
  }

  static HttpResponse malformed(const char* detail) {
    return problem_response({api::ProblemCode::malformed_http, detail, {}});
  }

  HttpResponse too_large() const {
    return problem_response({api::ProblemCode::payload_too_large,
                             "The body may have " + std::to_string(options.body_bytes) + " bytes.",
                             {}});
  }

  /// Sees every answer of 400 and above, also those that the library gives by itself before
  /// `route`.
  Handled error(const httplib::Request& request, httplib::Response& response) {
    if (response.has_header(request_id_header)) return Handled::Unhandled;  // one of ours
    begin(request);
    if (response.status == 416 && (request.method == "GET" || request.method == "HEAD")) {
      // A Range header that the library could not read: RFC 9110 wants it ignored.
      writable(request).ranges.clear();
      writable(request).headers.erase("Accept-Encoding");
      response.status = -1;
      answer(request, response, {});
      return Handled::Handled;
    }
    switch (response.status) {
      case 413:
        send(too_large(), response, true);
        break;
      case 414:
        send(problem_response({api::ProblemCode::uri_too_long, "The URI is too long.", {}}),
             response, true);
        break;
      case 500:
        send(problem_response(
                 {api::ProblemCode::internal, "The service failed on this request.", {}}),
             response, true);
        break;
      default:
        send(malformed("This is not an HTTP request."), response, true);
    }
    return Handled::Handled;
  }

  void set_up() {
    http.set_pre_routing_handler(
        [this](const auto& request, auto& response) { return route(request, response); });
    const auto upload_handler = [this](const auto& request, auto& response, const auto& reader) {
      upload(request, response, reader);
    };
    http.Post("/", httplib::Server::HandlerWithContentReader(upload_handler));
    http.Put("/", httplib::Server::HandlerWithContentReader(upload_handler));
    http.Patch("/", httplib::Server::HandlerWithContentReader(upload_handler));
    http.Delete("/", httplib::Server::HandlerWithContentReader(upload_handler));
    http.set_error_handler(httplib::Server::HandlerWithResponse(
        [this](const auto& request, auto& response) { return error(request, response); }));
    http.set_exception_handler([](const auto&, auto& response, std::exception_ptr) {
      // Ours are caught before; without this handler the library puts the text into a header.
      send(
          problem_response({api::ProblemCode::internal, "The service failed on this request.", {}}),
          response, true);
    });
    http.set_expect_100_continue_handler([this](const auto& request, auto& response) {
      if (announced_body(request).length <= options.body_bytes) return 100;
      return response.status = 413;
    });
    http.set_post_routing_handler([](const auto&, auto& response) {
      // RFC 9110, 8.6: not with 204, and with 304 only the length that 200 would have had.
      if (response.status == 204 || response.status == 304)
        response.headers.erase("Content-Length");
    });
    http.set_logger([](const auto& request, const auto& response) {
      const std::chrono::duration<double, std::milli> took = steady_clock::now() - current.start;
      spdlog::info("{} {} {} {} {:.1f} ms", current.id, printable(request.method),
                   printable(current.path), response.status, took.count());
    });
    http.set_payload_max_length(longest_drain);
    http.set_read_timeout(read_timeout_s);
    http.set_write_timeout(write_timeout_s);
    http.set_keep_alive_timeout(keep_alive_s);
    http.set_keep_alive_max_count(requests_per_connection);
    http.set_tcp_nodelay(true);
    http.set_socket_options([](int socket) {
      // Not SO_REUSEPORT, the library's default: a second service would share the port in silence.
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    // The server deletes it.
    http.new_task_queue = [threads = static_cast<std::size_t>(options.threads)] {
      return new httplib::ThreadPool(threads);  // NOLINT(cppcoreguidelines-owning-memory)
    };
  }
};

HttpServer::HttpServer(Endpoints& endpoints, const HttpOptions& options)
    : impl_(std::make_unique<Impl>(endpoints, options)) {
  impl_->set_up();
  errno = 0;
  if (options.port == 0)
    impl_->port = impl_->http.bind_to_any_port(options.host);
  else if (impl_->http.bind_to_port(options.host, options.port))
    impl_->port = options.port;
  if (impl_->port <= 0)
    throw ListenError("cannot listen on " + options.host + ':' + std::to_string(options.port) +
                      ": " + (errno ? std::strerror(errno) : "no such host"));
  impl_->http.deepen_queue();
}

HttpServer::~HttpServer() = default;

int HttpServer::port() const { return impl_->port; }

void HttpServer::run() {
  impl_->entered = true;
  if (!impl_->stopped) impl_->http.listen_after_bind();
  impl_->left = true;
}

void HttpServer::stop() {
  impl_->stopped = true;
  if (!impl_->entered) return;  // run will see that it is stopped
  // The library forgets a stop that comes before its loop has begun.
  while (!impl_->http.is_running() && !impl_->left)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  impl_->http.stop();
}

bool HttpServer::is_running() const { return impl_->http.is_running(); }

}  // namespace translucube::server

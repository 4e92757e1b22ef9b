#include "server/http/server.h"

#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <random>
#include <span>

#include "api/base/text.h"
#include "server/base/ids.h"
#include "server/http/exchange.h"
#include "server/http/wire.h"

namespace translucube::server {
namespace {

using api::ProblemCode;
using std::chrono::steady_clock;
using Handled = httplib::Server::HandlerResponse;

constexpr const char* request_id_header = "X-Request-Id";
constexpr const char* our_fault = "The service failed on this request.";

/// The request that this thread answers. A thread of the pool has one at a time.
struct Current {
  HttpRequest request;
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

/// Names a request in the log; it need not be hard to guess.
std::string request_id() {
  thread_local std::mt19937_64 numbers{std::random_device()()};
  const std::uint64_t number = numbers();
  return hex(std::span(reinterpret_cast<const unsigned char*>(&number), sizeof number));
}

/// Makes the current request, without a body.
void begin(const httplib::Request& request) {
  HttpRequest plain{request.method, request.path, {}, {}, {}};
  for (const auto& [name, value] : request.params) plain.query.emplace_back(name, value);
  for (const auto& [name, value] : request.headers) {
    const auto [it, fresh] = plain.headers.emplace(api::lower_case(name), value);
    if (!fresh) it->second += ", " + value;
  }
  const std::string given = request.get_header_value(request_id_header);
  plain.id = is_request_id(given) ? given : request_id();
  current = {std::move(plain), steady_clock::now()};
}

}  // namespace

struct HttpServer::Impl {
  HttpHandlers handlers;
  HttpOptions options;
  SocketServer http;
  int port = 0;
  std::atomic<bool> entered = false, stopped = false, left = false;

  Impl(HttpHandlers h, const HttpOptions& o)
      : handlers(std::move(h)),
        options(o),
        http(o, [this](ProblemCode code) { return refusal(code); }) {}

  /// The answer on a connection whose request was not read.
  std::string refusal(ProblemCode code) const {
    HttpResponse answer = problem_response({code, "", {}});
    RequestRecord record;
    record.id = random_hex(8);
    record.status = answer.status;
    answer.headers.emplace_back(request_id_header, record.id);
    handlers.done(record);
    return wire_text(answer);
  }

  void send(HttpResponse answer, httplib::Response& response, bool close = false) {
    put_answer(std::move(answer), current.request.id, http, response, close);
  }
  void send_problem(ProblemCode code, const char* detail, httplib::Response& response,
                    bool close = false) {
    send(problem_response({code, detail, {}}), response, close);
  }

  void answer(httplib::Response& response) {
    try {
      send(handlers.respond(current.request), response);
    } catch (const std::exception& error) {
      spdlog::error("{} {}: {}", current.request.id, printable(current.request.path), error.what());
      send_problem(ProblemCode::internal, our_fault, response);
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
    const bool no_body = announced.kind == BodyAnnouncement::Kind::none;
    if (auto refused = handlers.admit(current.request)) {
      send(std::move(*refused), response, !no_body);
      return Handled::Handled;
    }
    if (no_body) {
      answer(response);
      return Handled::Handled;
    }
    const bool takes_body = request.method == "POST" || request.method == "PUT" ||
                            request.method == "PATCH" || request.method == "DELETE";
    if (announced.kind == BodyAnnouncement::Kind::malformed || !takes_body) {
      send_problem(
          ProblemCode::malformed_http,
          takes_body ? "The length of the body is not clear." : "This method takes no body.",
          response, true);
      return Handled::Handled;
    }
    if (announced.length > longest_drain) {
      send(too_large(), response, true);
      return Handled::Handled;
    }
    // What the library compares to a regular expression, one character a stack frame.
    own.path = "/";
    return Handled::Unhandled;
  }

  void upload(const httplib::Request& request, httplib::Response& response,
              const httplib::ContentReader& reader) {
    const bool encoded = request.has_header("Content-Encoding") &&
                         request.get_header_value("Content-Encoding") != "identity";
    Upload upload = receive(writable(request), reader, options.body_bytes);
    if (upload.too_large) {
      send(too_large(), response, !upload.whole);
    } else if (!upload.whole && http.connection().crowded()) {
      send_problem(ProblemCode::overloaded, "Too many clients send slowly.", response, true);
    } else if (!upload.whole) {
      send_problem(ProblemCode::malformed_http, "The body did not arrive whole.", response, true);
    } else if (encoded) {
      send_problem(ProblemCode::unsupported_media_type, "A body in a content coding is not taken.",
                   response);
    } else {
      current.request.body = std::move(upload.body);
      answer(response);
    }
  }

  HttpResponse too_large() const {
    return problem_response({ProblemCode::payload_too_large,
                             "The body may have " + std::to_string(options.body_bytes) + " bytes.",
                             {}});
  }

  /// Sees every answer of 400 and above, also those that the library gives by itself before
  /// `route`.
  Handled error(const httplib::Request& request, httplib::Response& response) {
    if (response.has_header(request_id_header)) return Handled::Unhandled;  // one of ours
    begin(request);
    if (response.status == 416 && (request.method == "GET" || request.method == "HEAD") &&
        announced_body(request).kind == BodyAnnouncement::Kind::none) {
      // A Range header that the library could not read: RFC 9110 wants it ignored.
      writable(request).ranges.clear();
      writable(request).headers.erase("Accept-Encoding");
      response.status = -1;
      if (auto refused = handlers.admit(current.request))
        send(std::move(*refused), response, true);
      else
        answer(response);
      return Handled::Handled;
    }
    switch (response.status) {
      case 413:
        send(too_large(), response, true);
        break;
      case 414:
        send_problem(ProblemCode::uri_too_long, "The URI is too long.", response, true);
        break;
      case 500:
        send_problem(ProblemCode::internal, our_fault, response, true);
        break;
      default:
        send_problem(ProblemCode::malformed_http, "This is not an HTTP request.", response, true);
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
    // Ours are caught before; without this handler the library puts the text into a header.
    http.set_exception_handler([this](const auto&, auto& response, std::exception_ptr) {
      send_problem(ProblemCode::internal, our_fault, response, true);
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
    http.set_logger([this](const auto&, const auto& response) {
      const std::chrono::duration<double> took = steady_clock::now() - current.start;
      const HttpRequest& request = current.request;
      handlers.done({request.id, request.client, request.method, request.path, response.status,
                     took.count(), http.connection().sent()});
      current = {};
    });
    http.set_payload_max_length(longest_drain);
    // For the Keep-Alive header alone: the lobby keeps the time, and counts no requests.
    http.set_keep_alive_timeout(
        std::chrono::ceil<std::chrono::seconds>(options.idle_timeout).count());
    http.set_keep_alive_max_count(1'000'000);
    http.set_tcp_nodelay(true);
    http.set_socket_options([](int socket) {
      // Not SO_REUSEPORT, the library's default: a second service would share the port in silence.
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
  }
};

HttpServer::HttpServer(HttpHandlers handlers, const HttpOptions& options)
    : impl_(std::make_unique<Impl>(std::move(handlers), options)) {
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
  impl_->http.begin_stop();
  if (!impl_->entered) return;  // run will see that it is stopped
  // The library forgets a stop that comes before its loop has begun.
  while (!impl_->http.is_running() && !impl_->left)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  impl_->http.stop();
}

bool HttpServer::is_running() const { return impl_->http.is_running(); }

}  // namespace translucube::server

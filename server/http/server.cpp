#include "server/http/server.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <tuple>

#include "api/base/text.h"
#include "server/base/received_file.h"
#include "server/base/turns.h"
#include "server/http/answer_writer.h"
#include "server/http/listener.h"
#include "server/http/lobby.h"
#include "server/http/thread_pool.h"

namespace translucube::server {
namespace {

using api::ProblemCode;
using std::chrono::steady_clock;

constexpr std::size_t most_held = 64 << 20;
constexpr std::chrono::milliseconds longest_line(2000);

/// RFC 9110, 9.1: another method is not implemented, one of these perhaps not allowed.
constexpr std::array<std::string_view, 7> methods{"GET",    "HEAD",  "POST",   "PUT",
                                                  "DELETE", "PATCH", "OPTIONS"};

HttpResponse problem(ProblemCode code, std::string detail) {
  return problem_response({code, std::move(detail), {}});
}

/// A content of GET means nothing (RFC 9110, 9.3.1) but, to a proxy, perhaps another request.
bool takes_body(std::string_view method) { return method != "GET" && method != "HEAD"; }

}  // namespace

struct HttpServer::Impl {
  const HttpHandlers handlers;
  const HttpOptions options;
  Listener listener;
  std::atomic<bool> stopping = false, running = false;
  Places connections, transfers;
  const ConnectionRules rules;
  Turns turns;
  Lobby lobby;
  ThreadPool pool;  // last: its threads use all of it

  Impl(HttpHandlers h, const HttpOptions& o)
      : handlers(std::move(h)),
        options(o),
        listener(o.host, o.port),
        connections(o.connections),
        transfers(o.transfers),
        rules{transfers, o.transfer_timeout, stopping},
        turns(static_cast<std::size_t>(o.answering), static_cast<std::size_t>(o.in_line),
              longest_line),
        lobby({o.header_timeout, o.idle_timeout}, most_held,
              [this](const auto& why, const auto& connection) { return refusal(why, connection); }),
        pool(
            // One is left for what is urgent.
            o.threads + o.in_line + 1, [this] { return lobby.next(); },
            [this](auto connection, bool last) { serve(std::move(connection), last); }) {}

  /// The answer on a connection whose request was not read whole.
  std::string refusal(const api::Problem& why, const Connection& connection) const {
    HttpResponse answer = problem_response(why);
    RequestRecord record;
    record.id = new_request_id();
    if (const Exchange* exchange = connection.exchange()) record = record_of(*exchange);
    record.status = answer.status;
    answer.headers.emplace_back("X-Request-Id", record.id);
    std::string text = last_answer(answer);
    record.bytes = text.size();
    handlers.done(record);
    return text;
  }

  static RequestRecord record_of(const Exchange& exchange) {
    const std::chrono::duration<double> took = steady_clock::now() - exchange.start;
    const HttpRequest& request = exchange.request;
    return {request.id, request.client, request.method, request.path, 0, took.count(), 0};
  }

  void enter(FileDescriptor socket) {
    Places::Place place = connections.take();
    while (!place && lobby.evict()) place = connections.take();
    auto connection = std::make_unique<Connection>(std::move(socket), place, rules);
    if (place) {
      lobby.enter(std::move(connection));
    } else {
      connection->write_at_once(refusal({ProblemCode::overloaded, "", {}}, *connection));
      lobby.linger(std::move(connection));
    }
  }

  void serve(std::unique_ptr<Connection> connection, bool last) {
    std::optional<HttpResponse> answer;
    if (!connection->exchange()) {
      if (!begin(*connection)) {
        lobby.linger(std::move(connection));
        return;
      }
      answer = refused_before_body(*connection->exchange());
      if (!answer && awaits_body(*connection)) {
        lobby.await_body(std::move(connection));
        return;
      }
    }
    Exchange& exchange = *connection->exchange();
    const bool urgent = handlers.urgent(exchange.request);
    if (!answer) answer = answer_to(exchange, urgent, last);
    if (last) connection->hurry();
    const bool later = answer->status == 503 && !urgent;
    const Sent sent = send(*connection, *std::move(answer));
    connection->end_exchange();
    if (sent == Sent::persists && later)
      lobby.rest(std::move(connection));
    else if (sent == Sent::persists)
      lobby.wait(std::move(connection));
    else
      lobby.linger(std::move(connection));
  }

  /// Reads the head. False where it was refused.
  bool begin(Connection& connection) const {
    auto head = read_request_head(connection.head());
    if (!head) {
      connection.write_at_once(refusal(head.problem(), connection));
      return false;
    }
    connection.begin(std::make_unique<Exchange>(*std::move(head), options.body_bytes));
    return true;
  }

  /// What the head alone is refused for: a body is not read, nor asked for, before.
  std::optional<HttpResponse> refused_before_body(Exchange& exchange) const {
    if (auto refused = handlers.admit(exchange.request)) return refused;
    if (exchange.request.body_file) pour_into_file(exchange);
    const auto& [method, head] = std::tie(exchange.request.method, exchange.head);
    if (std::ranges::find(methods, method) == methods.end())
      return problem(ProblemCode::not_implemented, "No path has this method.");
    if (head.framing.has_body() && !takes_body(method))
      return problem(ProblemCode::malformed_http, "This method takes no body.");
    const std::uint64_t most = exchange.body.limit();
    const std::uint64_t longest =
        head.expects_continue ? most : std::max(most, BodyReader::longest_drain);
    if (head.framing.length > longest) return too_large(exchange);
    if (head.expects_more)
      return problem(ProblemCode::expectation_failed, "Only 100-continue can be expected.");
    return std::nullopt;
  }

  static HttpResponse too_large(const Exchange& exchange) {
    return problem(ProblemCode::payload_too_large,
                   "The body may have " + std::to_string(exchange.body.limit()) + " bytes.");
  }

  static void pour_into_file(Exchange& exchange) {
    const auto sink = [file = exchange.request.body_file](std::string_view bytes) {
      try {
        file->append(bytes);
      } catch (const FileError& error) {
        spdlog::error("a body is not kept: {}", error.what());
        throw;
      }
    };
    exchange.body.pour_into(sink, exchange.request.body_file->limit());
  }

  /// Whether more of the body must come. Asks for it where the client wants to be asked (RFC 9110,
  /// 10.1.1).
  static bool awaits_body(Connection& connection) {
    const Exchange& exchange = *connection.exchange();
    if (exchange.body.whole()) return false;
    if (exchange.head.expects_continue && !connection.has_unread())
      connection.write_at_once("HTTP/1.1 100 Continue\r\n\r\n");
    return connection.receive() == Connection::Receipt::begun;
  }

  HttpResponse answer_to(Exchange& exchange, bool urgent, bool last) {
    BodyReader& body = exchange.body;
    HttpRequest& request = exchange.request;
    if (body.fault()) return problem_response(*body.fault());
    if (!body.whole() && body.too_large()) return too_large(exchange);
    if (!body.whole())
      return problem(ProblemCode::malformed_http, "The body did not arrive whole.");
    if (body.too_large()) return too_large(exchange);
    const std::string coding = api::lower_case(request.header("content-encoding"));
    if (!coding.empty() && coding != "identity")
      return problem(ProblemCode::unsupported_media_type,
                     "A body in a content coding is not taken.");
    request.body = body.release();
    Places::Place turn;
    if (!urgent && !last) turn = turns.take();
    if (!urgent && !turn)
      return problem(ProblemCode::overloaded, "More is asked at once than can be answered.");
    request.give_way = [&turn] { turn.reset(); };
    HttpResponse answer = respond(request);
    request.give_way = nullptr;
    request.body_file = nullptr;  // its place is free before the client knows
    return answer;
  }

  HttpResponse respond(const HttpRequest& request) const {
    try {
      return handlers.respond(request);
    } catch (const std::exception& error) {
      spdlog::error("{} {}: {}", request.id, printable(request.path), error.what());
      return problem(ProblemCode::internal, "The service failed on this request.");
    }
  }

  Sent send(Connection& connection, HttpResponse answer) const {
    const Exchange& exchange = *connection.exchange();
    const int status = answer.status;
    const Sent sent = write_answer(connection, std::move(answer), !exchange.body.whole(), stopping);
    RequestRecord record = record_of(exchange);
    record.status = status;
    record.bytes = connection.sent();
    handlers.done(record);
    return sent;
  }

  void close_all() {
    stopping = true;
    lobby.close();
    pool.close();
  }
};

HttpServer::HttpServer(HttpHandlers handlers, const HttpOptions& options)
    : impl_(std::make_unique<Impl>(std::move(handlers), options)) {}

HttpServer::~HttpServer() { impl_->close_all(); }

int HttpServer::port() const { return impl_->listener.port(); }

void HttpServer::run() {
  impl_->running = true;
  while (auto socket = impl_->listener.next([this] { return impl_->lobby.evict(); })) try {
      impl_->enter(std::move(socket));
    } catch (const std::exception& error) {
      spdlog::error("a connection failed: {}", error.what());
    }
  impl_->close_all();
  impl_->running = false;
}

void HttpServer::stop() {
  impl_->stopping = true;
  impl_->listener.stop();
}

bool HttpServer::is_running() const { return impl_->running; }

}  // namespace translucube::server

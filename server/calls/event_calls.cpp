// Server-sent events (WHATWG HTML Living Standard, 9.2), replayed from the store: an id is the
// number of an event of this render or sweep, also after a restart.

#include <chrono>

#include "server/calls/answers.h"

namespace translucube::server {
namespace {

using api::ProblemCode;
using api::Result;
using std::chrono::steady_clock;

/// Comments keep proxies from closing a stream in which nothing happens.
constexpr std::chrono::seconds heartbeat(10);
constexpr std::chrono::seconds longest_block(1);
constexpr const char* reconnection_time = "retry: 2000\n\n";

using EventsAfter = std::function<Result<JobService::Events>(std::uint64_t)>;
/// Samples of what there is to see before it is stored; 0: nothing.
using SamplesToSee = std::function<std::uint32_t()>;

std::string text_of(const Event& event) {
  return "id: " + std::to_string(event.number) + "\nevent: " + event.type +
         "\ndata: " + event.data + "\n\n";
}

/// There is a better picture than the last time. It is told as soon as it is there, before the pass
/// is on the disk, and is no event of the store: it has no id and is not replayed.
std::string preview_text(std::uint32_t samples) {
  return "event: preview\ndata: {\"samples\":" + std::to_string(samples) + "}\n\n";
}

struct Stream {
  JobService& service;
  EventsAfter events_after;
  SamplesToSee samples_to_see;
  Places::Place place;
  std::uint64_t last;
  bool ended = false, begun = false;
  std::uint32_t samples = 0;
  steady_clock::time_point said = steady_clock::now();

  std::optional<std::string> next() {
    if (ended) return std::nullopt;
    std::string text;
    if (!begun) text = reconnection_time;
    begun = true;
    service.changes().watch(longest_block, [&] {
      const auto found = events_after(last);
      if (!found) return ended = true;  // removed
      // Looked for after the events and told before them: what they say of a pass, and that the
      // render has ended, is never told ahead of its picture.
      if (const std::uint32_t now = samples_to_see(); now > samples) {
        text += preview_text(now);
        samples = now;
      }
      for (const Event& event : found->events) {
        text += text_of(event);
        last = event.number;
      }
      ended = found->ended && found->events.empty();
      return ended || !text.empty();
    });
    if (service.changes().ended()) ended = true;
    if (ended && text.empty()) return std::nullopt;
    if (text.empty() && steady_clock::now() - said >= heartbeat) text = ": still here\n\n";
    if (!text.empty()) said = steady_clock::now();
    return text;
  }
};

HttpResponse stream_of(CallContext& context, const HttpRequest& request, EventsAfter events_after,
                       SamplesToSee samples_to_see) {
  const std::uint64_t last = last_event_id(request.header("last-event-id"));
  const auto found = events_after(last);
  if (!found) return problem_response(found.problem());
  // Nothing will come: with 204 a browser does not connect again.
  if (found->ended && found->events.empty()) return {204, {}, {}, {}};
  if (request.method == "HEAD") return {200, {}, "text/event-stream", EventStream{}};
  Places::Place place = context.streams.take();
  if (!place)
    return problem_response(
        {ProblemCode::overloaded, "There are as many event streams as the service can feed.", {}});
  const auto stream = std::make_shared<Stream>(Stream{
      context.service, std::move(events_after), std::move(samples_to_see), std::move(place), last});
  return {200, {}, "text/event-stream", EventStream{[stream] { return stream->next(); }}};
}

}  // namespace

HttpResponse get_render_events(CallContext& context, const HttpRequest& request,
                               const PathParameters& path) {
  JobService& service = context.service;
  return stream_of(
      context, request,
      [&service, id = path.id](auto after) { return service.events_of_render(id, after); },
      [&service, id = path.id] { return service.samples_to_see(id); });
}

HttpResponse get_sweep_events(CallContext& context, const HttpRequest& request,
                              const PathParameters& path) {
  JobService& service = context.service;
  return stream_of(
      context, request,
      [&service, id = path.id](auto after) { return service.events_of_sweep(id, after); },
      [] { return 0; });
}

}  // namespace translucube::server

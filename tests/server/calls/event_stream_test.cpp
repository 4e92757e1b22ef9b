// Event streams from the store to the text that a client reads.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/server/calls/calls_under_test.h"

namespace translucube::server::test {
namespace {

using nlohmann::json;

std::string whole(const HttpResponse& response) {
  std::string text;
  const EventStream& stream = std::get<EventStream>(response.body);
  while (const auto part = stream.next()) text += *part;
  return text;
}

struct Told {
  std::string id, event;
  json data;
};
std::vector<Told> events_in(const std::string& text) {
  std::vector<Told> events;
  std::istringstream lines(text);
  Told now;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("id: ")) now.id = line.substr(4);
    if (line.starts_with("event: ")) now.event = line.substr(7);
    if (line.starts_with("data: ")) now.data = json::parse(line.substr(6));
    if (line.empty() && !now.id.empty()) {
      events.push_back(now);
      now = {};
    }
  }
  return events;
}

TEST(EventStreamTest, TellsARenderFromItsQueueToItsEnd) {
  CallsUnderTest tested;
  const std::string id = tested.service.submit(small_request(16)).id;
  std::vector<Told> events;
  {
    const HttpResponse response = tested.listen(id);
    EXPECT_EQ(response.status, 200);
    EXPECT_EQ(response.content_type, "text/event-stream");
    events = events_in(whole(response));
  }
  ASSERT_GE(events.size(), 4u);
  EXPECT_EQ(events.front().data["state"], "queued");
  EXPECT_EQ(events[1].data["state"], "running");
  EXPECT_EQ(events[2].event, "progress");
  EXPECT_EQ(events[2].data["samples"], 4);
  EXPECT_EQ(events.back().data["state"], "succeeded");
  for (std::size_t i = 0; i < events.size(); ++i) EXPECT_EQ(events[i].id, std::to_string(i + 1));
  EXPECT_EQ(tested.context.streams.free(), tested.service.config.event_streams);
}

TEST(EventStreamTest, ReplaysWhatCameAfterTheLastEventAlsoAfterARestart) {
  const TempFolder folder;
  FakeRenderer renderer;
  std::string id, before;
  {
    TestService service(folder.path(), renderer.engine());
    CallContext context{service.service, service.uploads, service.catalog, service.colors,
                        service.config};
    id = service.wait(service.submit(small_request(16)).id).id;
    before = whole(respond(context, {"GET", "/v1/renders/" + id + "/events", {}, {}, {}}));
  }
  TestService service(folder.path(), renderer.engine());
  CallContext context{service.service, service.uploads, service.catalog, service.colors,
                      service.config};
  const auto all = events_in(before);
  const auto rest = events_in(whole(respond(
      context, {"GET", "/v1/renders/" + id + "/events", {}, {{"last-event-id", "2"}}, {}})));
  ASSERT_EQ(rest.size() + 2, all.size());
  for (std::size_t i = 0; i < rest.size(); ++i) EXPECT_EQ(rest[i].data, all[i + 2].data);
  const HttpResponse nothing =
      respond(context,
              {"GET", "/v1/renders/" + id + "/events", {}, {{"last-event-id", all.back().id}}, {}});
  EXPECT_EQ(nothing.status, 204) << "a browser does not come again";
}

TEST(EventStreamTest, SlotsAreBoundedAndGivenBack) {
  CallsUnderTest tested(0);
  const std::string id = tested.service.submit(small_request(4)).id;
  const auto crowd = take_all_but(1, tested.context.streams);
  {
    const HttpResponse taken = tested.listen(id);
    EXPECT_EQ(taken.status, 200);
    const HttpResponse refused = tested.listen(id);
    EXPECT_EQ(refused.status, 503);
    EXPECT_TRUE(std::ranges::any_of(refused.headers,
                                    [](auto& header) { return header.first == "Retry-After"; }));
  }
  EXPECT_EQ(tested.listen(id).status, 200);
}

TEST(EventStreamTest, EndsWithTheServiceAndWithTheRendersRemoval) {
  CallsUnderTest tested(0);
  const std::string stays = tested.service.submit(small_request(4, 1)).id;
  const std::string goes = tested.service.submit(small_request(4, 2)).id;
  const HttpResponse removed = tested.listen(goes), stopped = tested.listen(stays);
  EXPECT_FALSE(tested.service.service.remove(goes));
  whole(removed);
  tested.service.service.shut_down();
  whole(stopped);
  EXPECT_EQ(tested.listen("01ARZ3NDEKTSV4RRFFQ69G5FAV").status, 404);
}

TEST(LongPollTest, AnswersWhenTheStatusIsNoLongerTheKnownOne) {
  CallsUnderTest tested(0);
  const std::string id = tested.service.submit(small_request(4)).id;
  const auto get = [&](const std::string& wait, const std::string& etag) {
    return respond(tested.context,
                   {"GET", "/v1/renders/" + id, {{"wait", wait}}, {{"if-none-match", etag}}, {}});
  };
  const HttpResponse first = get("0", "");
  const std::string etag = first.headers.at(0).second;
  EXPECT_EQ(get("1", etag).status, 304);
  std::jthread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    EXPECT_TRUE(tested.service.service.cancel(id));
  });
  const auto start = std::chrono::steady_clock::now();
  EXPECT_EQ(get("60", etag).status, 200);
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(30));
  EXPECT_EQ(get("x", "").status, 422);
}

}  // namespace
}  // namespace translucube::server::test

#include "server/base/metrics.h"

#include <gmock/gmock.h>

#include <set>
#include <sstream>
#include <thread>
#include <vector>

#include "server/base/log.h"
#include "server/calls/front.h"

namespace translucube::server::test {
namespace {

using testing::HasSubstr;
using testing::Not;

TEST(MetricsTest, CountsWhatItIsTold) {
  Metrics metrics;
  metrics.count_request("GET", "/v1/renders/{id}", 200, 0.002);
  metrics.count_request("GET", "/v1/renders/{id}", 200, 0.2);
  metrics.count_request("POST", "/v1/renders", 202, 0.01);
  metrics.count_pass({2, 100, 250, 1});
  metrics.count_pass({4, 100, 250, 0});
  metrics.count_render(9);
  metrics.count_cache_hit();
  metrics.count_cache_miss();
  metrics.count_traced_image();
  metrics.count_developed_image();
  metrics.count_developed_image();
  const std::string text = metrics.text();
  for (
      const char* line :
      {R"(translucube_http_requests_total{method="GET",route="/v1/renders/{id}",status="200"} 2)",
       R"(translucube_http_requests_total{method="POST",route="/v1/renders",status="202"} 1)",
       R"(translucube_http_request_duration_seconds_bucket{method="GET",route="/v1/renders/{id}",le="0.0025"} 1)",
       R"(translucube_http_request_duration_seconds_count{method="GET",route="/v1/renders/{id}"} 2)",
       "translucube_pass_duration_seconds_count 2", "translucube_pass_duration_seconds_sum 6",
       "translucube_render_duration_seconds_sum 9", "translucube_camera_samples_total 200",
       "translucube_path_events_total 500", "translucube_nan_samples_total 1",
       R"(translucube_cache_lookups_total{result="hit"} 1)",
       R"(translucube_cache_lookups_total{result="miss"} 1)",
       R"(translucube_images_total{origin="traced"} 1)",
       R"(translucube_images_total{origin="developed"} 2)"})
    EXPECT_THAT(text, HasSubstr(line + std::string("\n")));
}

TEST(MetricsTest, TheStoreIsAskedAtEachScrape) {
  Metrics metrics;
  EXPECT_THAT(metrics.text(), Not(HasSubstr("translucube_queue_depth")));
  int scrapes = 0;
  metrics.set_store_gauges([&] {
    ++scrapes;
    return StoreGauges{{{"queued", 3}, {"running", 1}}, {{"running", 1}}, {{"batch", 2}}, 3, 4.5};
  });
  std::string text = metrics.text();
  for (const char* line :
       {R"(translucube_renders{state="queued"} 3)", R"(translucube_renders{state="running"} 1)",
        R"(translucube_tasks_waiting{priority="batch"} 2)", "translucube_queue_depth 3",
        "translucube_queue_oldest_age_seconds 4.5"})
    EXPECT_THAT(text, HasSubstr(line + std::string("\n")));
  metrics.set_store_gauges([&]() -> StoreGauges { throw std::runtime_error("locked"); });
  text = metrics.text();
  EXPECT_THAT(text, Not(HasSubstr("translucube_queue_depth")));
  EXPECT_THAT(text, HasSubstr("translucube_path_events_total 0\n"));
  EXPECT_EQ(scrapes, 1);
}

TEST(MetricsTest, StreamsAreCountedWhileTheyAreOpen) {
  Metrics metrics;
  auto first = metrics.open_stream(), second = metrics.open_stream();
  EXPECT_THAT(metrics.text(), HasSubstr("translucube_event_streams_open 2\n"));
  first.reset();
  EXPECT_THAT(metrics.text(), HasSubstr("translucube_event_streams_open 1\n"));
}

TEST(MetricsTest, EveryNameHasItsHelpAndType) {
  Metrics metrics;
  metrics.count_request("GET", "/livez", 200, 0.1);
  metrics.set_store_gauges([] {
    return StoreGauges{{{"queued", 1}}, {{"queued", 1}}, {{"batch", 1}}, 1, 1};
  });
  std::istringstream lines(metrics.text());
  std::set<std::string> helped, typed;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string hash, kind, name, help;
    words >> hash >> kind >> name >> help;
    if (hash != "#") {
      name = line.substr(0, line.find_first_of("{ "));
      for (const char* end : {"_bucket", "_sum", "_count"})
        if (name.ends_with(end)) name.resize(name.size() - std::string(end).size());
      EXPECT_TRUE(helped.contains(name) && typed.contains(name)) << line;
    } else if (kind == "HELP") {
      EXPECT_FALSE(help.empty()) << line;
      helped.insert(name);
    } else {
      typed.insert(name);
    }
  }
  EXPECT_GE(helped.size(), 15u);
}

TEST(MetricsTest, ManyThreadsCountAtOnce) {
  Metrics metrics;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t)
      threads.emplace_back([&] {
        for (int i = 0; i < 1000; ++i) {
          metrics.count_request("GET", "/livez", 200 + i % 3, 0.001);
          if (i % 100 == 0) metrics.text();
        }
      });
  }
  EXPECT_THAT(
      metrics.text(),
      HasSubstr(
          R"(translucube_http_request_duration_seconds_count{method="GET",route="/livez"} 4000)"));
}

TEST(FrontTest, RoutesAreThePatternsOfTheOpenApiDocument) {
  EXPECT_EQ(route_of("/livez"), "/livez");
  EXPECT_EQ(route_of("/v1/renders"), "/v1/renders");
  EXPECT_EQ(route_of("/v1/renders/01ARZ3NDEKTSV4RRFFQ69G5FAV"), "/v1/renders/{id}");
  EXPECT_EQ(route_of("/v1/renders/x/image"), "/v1/renders/{id}/image");
  EXPECT_EQ(route_of("/metrics"), "/metrics");
  EXPECT_EQ(route_of("/"), "/");
  EXPECT_EQ(route_of("/web/app.js"), "/web/{file}");
  for (const char* path :
       {"", "//", "/web/", "/v1/renders/", "/v1/renders/x/y", "/livez/", "livez"})
    EXPECT_EQ(route_of(path), "other") << path;
}

TEST(LogTest, FieldsAreLogfmtOrJson) {
  const LogFields fields{{"id", "ab1"}, {"status", std::int64_t(200)}, {"ms", 1.25}, {"path", ""}};
  EXPECT_EQ(log_text(LogFormat::logfmt, fields), R"( id=ab1 status=200 ms=1.25 path="")");
  EXPECT_EQ(log_text(LogFormat::json, fields), R"(,"id":"ab1","status":200,"ms":1.25,"path":"")");
}

TEST(LogTest, NoValueBreaksOutOfItself) {
  const LogFields fields{{"path", "/a b=\"c\\\"\n\x1b[2J level=error\x7f\xc3\xa9"}};
  EXPECT_EQ(log_text(LogFormat::logfmt, fields),
            R"( path="/a b=\"c\\\"\x0a\x1b[2J level=error\x7f\xc3\xa9")");
  EXPECT_EQ(log_text(LogFormat::json, fields),
            R"(,"path":"/a b=\"c\\\"\u000a\u001b[2J level=error\u007f\u00c3\u00a9")");
  const std::string long_path(100'000, 'a');
  EXPECT_LT(log_text(LogFormat::logfmt, {{"path", long_path}}).size(), 600u);
}

}  // namespace
}  // namespace translucube::server::test

// kill -9 of the service at random moments under load: nothing that was accepted is lost, nothing
// is done twice in a way that shows, and the bits are those of an undisturbed run.

#include <set>

#include "picture/image_io.h"
#include "tests/server/process/siege.h"

namespace translucube::server::test {
namespace {

using nlohmann::json;

/// The status of a render or a sweep when it has ended.
json ended(const Service& service, const std::string& location) {
  json status;
  EXPECT_TRUE(eventually([&] {
    status = service.get(location + "?wait=10");
    return status.is_object() && status.contains("finished_at") && !status["finished_at"].is_null();
  })) << location;
  return status;
}

void expect_counts_add_up(const json& sweep) {
  std::map<std::string, int> counted;
  for (const json& point : sweep["results"]) ++counted[point["state"]];
  int sum = 0;
  for (const auto& [state, count] : sweep["counts"].items()) {
    sum += int(count);
    EXPECT_EQ(counted[state], int(count)) << sweep["id"] << ' ' << state;
  }
  EXPECT_EQ(sum, int(sweep["points"])) << sweep["id"];
  if (sweep["state"] == "succeeded") {
    EXPECT_EQ(sweep["counts"]["succeeded"], sweep["points"]) << sweep["id"];
  }
}

void expect_ended_as_it_should(const Siege::Job& job, const json& status) {
  const std::string state = status["state"];
  if (job.canceled)
    EXPECT_EQ(state, "canceled") << job.location;
  else if (job.cancel_sent)
    EXPECT_TRUE(state == "canceled" || state == "succeeded") << job.location << ' ' << state;
  else
    EXPECT_EQ(state, "succeeded") << status.dump();
  if (job.order.path == "/v1/sweeps") expect_counts_add_up(status);
}

/// What was read over the kills is what is replayed now.
void expect_replay(const Service& service, const std::string& location, const EventLog& log) {
  EXPECT_FALSE(log.gaps) << location;
  EXPECT_GT(log.last(), 0u) << location;
  const auto replayed = service.client().Get(location + "/events");
  ASSERT_TRUE(replayed);
  EventLog again;
  std::string text = replayed->body;
  again.take(text);
  EXPECT_FALSE(again.gaps) << location;
  EXPECT_EQ(again.events, log.events) << location;
  EXPECT_NE(log.events.rbegin()->second.find("event: state"), std::string::npos) << location;
}

std::vector<std::string> image_urls(const Siege::Job& job) {
  std::vector<std::string> urls;
  if (job.order.path == "/v1/sweeps") {
    for (int point = 0; point < 9; ++point)
      urls.push_back("/points/" + std::to_string(point) + "/image?format=exr");
    urls.emplace_back("/sheet?format=png");
  } else {
    urls.emplace_back("/image?format=exr");
  }
  if (job.order.explorable) urls.emplace_back("/image?format=exr&absorption=0.7");
  return urls;
}

void expect_it_decodes(const std::string& url, const std::string& bytes, const TempFolder& folder) {
  const auto file = folder / (url.ends_with("png") ? "served.png" : "served.exr");
  write_file(file, bytes);
  EXPECT_NO_THROW(EXPECT_GT(read_image(file).width, 0)) << url;
}

/// All that was accepted, by their lists.
std::set<std::string> listed(const Service& service, const std::string& path) {
  std::set<std::string> locations;
  std::string cursor;
  do {
    const json page =
        service.get(path + "?limit=200" + (cursor.empty() ? "" : "&cursor=" + cursor));
    for (const json& entry : page[path.substr(4)]) locations.insert(entry["links"]["self"]);
    cursor = page["next_cursor"].is_null() ? "" : page["next_cursor"];
  } while (!cursor.empty());
  return locations;
}

void survives(int kills, unsigned seed) {
  SCOPED_TRACE("seed " + std::to_string(seed));
  const TempFolder folder;
  Siege siege(seed, 6 * (kills + 1));
  Random random(seed);
  for (int i = 0; i < kills; ++i) {
    Service service(folder / "data");
    siege.aim(service.port());
    std::this_thread::sleep_for(std::chrono::milliseconds(pick(random, 0, 1500)));
    service.process().kill(SIGKILL);
    ASSERT_EQ(service.process().wait(), -SIGKILL) << service.process().errors();
  }
  Service service(folder / "data");
  siege.aim(service.port());
  siege.end();

  std::set<std::string> renders, sweeps;
  Service undisturbed(folder / "undisturbed");
  int exact = 0;
  for (const Siege::Job& job : siege.jobs()) {
    (job.order.path == "/v1/sweeps" ? sweeps : renders).insert(job.location);
    const json status = ended(service, job.location);
    expect_ended_as_it_should(job, status);
    expect_replay(service, job.location, siege.logs().at(job.location));
    if (status["state"] != "succeeded" || !job.order.exact) continue;
    const auto posted =
        undisturbed.client().Post(job.order.path, job.order.body, "application/json");
    ASSERT_TRUE(posted);
    const std::string twin = posted->get_header_value("Location");
    ASSERT_EQ(ended(undisturbed, twin)["state"], "succeeded");
    for (const std::string& url : image_urls(job)) {
      const auto served = service.client().Get(job.location + url);
      ASSERT_TRUE(served);
      ASSERT_EQ(served->status, 200) << served->body;
      EXPECT_TRUE(served->body == undisturbed.client().Get(twin + url)->body)
          << job.location + url << " of " << job.order.body;
      ++exact;
    }
  }
  EXPECT_EQ(std::ssize(renders) + std::ssize(sweeps), std::ssize(siege.jobs()))
      << "another key is another render";
  EXPECT_EQ(listed(service, "/v1/renders"), renders) << "each was made once";
  EXPECT_EQ(listed(service, "/v1/sweeps"), sweeps);
  for (const auto& [url, bytes] : siege.images()) {
    expect_it_decodes(url, bytes, folder);
    EXPECT_TRUE(service.client().Get(url)->body == bytes) << url;
  }
  std::cout << siege.jobs().size() << " accepted, " << siege.images().size()
            << " images served between kills, " << exact << " compared to an undisturbed run\n";
}

TEST(KillTest, NothingIsLostOverFiveKills) { survives(5, 1); }

TEST(LongKillTest, NothingIsLostOverFiftyKills) { survives(50, 2); }

}  // namespace
}  // namespace translucube::server::test

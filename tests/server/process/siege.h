#pragma once

// Clients that ask a service for work while it is killed and started again: they ask until they are
// answered, and remember all that they were told.

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <sstream>

#include "tests/server/fixture.h"
#include "tests/server/process/load.h"
#include "tests/server/service.h"

namespace translucube::server::test {

/// The events of a render or a sweep as they were read, piece by piece.
struct EventLog {
  std::map<std::uint64_t, std::string> events;  ///< by id: the lines behind it
  bool gaps = false, changed = false;

  std::uint64_t last() const { return events.empty() ? 0 : events.rbegin()->first; }

  /// Takes the whole events off the front of `text`; the rest may be cut off by a kill.
  void take(std::string& text) {
    for (std::size_t end; (end = text.find("\n\n")) != text.npos; text.erase(0, end + 2)) {
      const std::string event = text.substr(0, end);
      if (!event.starts_with("id: ")) continue;  // a comment, or the reconnection time
      const std::size_t line = event.find('\n');
      const std::uint64_t id = std::stoull(event.substr(4, line - 4));
      gaps = gaps || id != last() + 1;
      events.emplace(id, event.substr(line));
    }
  }
};

class Siege {
 public:
  struct Job {
    Order order;
    std::string key, location;
    bool cancel_sent = false, canceled = false;  ///< canceled: the service said so
  };

  Siege(unsigned seed, int most_jobs) : seed_(seed), most_jobs_(most_jobs) {
    for (unsigned i = 0; i < 2; ++i)
      besiegers_.emplace_back([this, i](std::stop_token stop) { besiege(seed_ + i, stop); });
    follower_ = std::jthread([this](std::stop_token stop) { follow(stop); });
  }
  ~Siege() { end(); }

  /// Where the service is now.
  void aim(int port) { port_ = port; }

  /// No more orders; returns when all that was asked is answered.
  void end() {
    for (std::jthread& besieger : besiegers_) besieger.request_stop();
    besiegers_.clear();
    follower_ = {};  // last: what was accepted at the end has a stream too
  }

  // Once it has ended.
  const std::vector<Job>& jobs() const { return jobs_; }
  const std::map<std::string, EventLog>& logs() const { return logs_; }
  const std::map<std::string, std::string>& images() const { return images_; }

 private:
  /// Asks until there is an answer; none where the siege ends without one.
  template <typename Ask>
  std::optional<httplib::Response> answer(Ask ask) {
    const auto give_up = std::chrono::steady_clock::now() + std::chrono::seconds(60);
    while (std::chrono::steady_clock::now() < give_up) {
      httplib::Client client("127.0.0.1", port_);
      client.set_read_timeout(30);
      if (const httplib::Result result = ask(client)) return *result;
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ADD_FAILURE() << "no answer in a minute";
    return std::nullopt;
  }

  void besiege(unsigned seed, std::stop_token stop) {
    Random random(seed);
    for (int i = 0; !stop.stop_requested(); ++i) {
      const std::optional<Job> known = any_job(random);
      const int what = pick(random, 0, 9);
      if (!known || what < 4) {
        post(random, std::to_string(seed) + '-' + std::to_string(i));
      } else if (what == 4) {
        cancel(*known);
      } else if (what == 5) {
        post_again(*known);
      } else {
        fetch(*known, random);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(pick(random, 0, 20)));
    }
  }

  std::optional<Job> any_job(Random& random) {
    const std::lock_guard lock(mutex_);
    if (jobs_.empty()) return std::nullopt;
    return one_of(jobs_, random);
  }

  void post(Random& random, const std::string& key) {
    {
      const std::lock_guard lock(mutex_);
      if (std::ssize(jobs_) >= most_jobs_) return;
    }
    const int seeds = 2 + most_jobs_ / 8;
    const Order order =
        pick(random, 0, 4) == 0 ? sweep_order(random, seeds) : render_order(random, seeds);
    const std::string location = posted(order, key);
    if (location.empty()) return;
    const std::lock_guard lock(mutex_);
    jobs_.push_back({order, key, location});
  }

  void post_again(const Job& job) {
    EXPECT_EQ(posted(job.order, job.key), job.location) << "the same key is the same work";
  }

  std::string posted(const Order& order, const std::string& key) {
    const auto result = answer([&](httplib::Client& client) {
      return client.Post(order.path, {{"Idempotency-Key", key}}, order.body, "application/json");
    });
    if (!result) return {};
    EXPECT_TRUE(result->status == 200 || result->status == 202)
        << result->body << " for " << order.body;
    return result->get_header_value("Location");
  }

  void cancel(const Job& job) {
    const auto known = [&] { return std::ranges::find(jobs_, job.location, &Job::location); };
    {
      const std::lock_guard lock(mutex_);
      known()->cancel_sent = true;
    }
    const auto result = answer(
        [&](httplib::Client& client) { return client.Post(job.location + "/cancel", "", ""); });
    if (!result) return;
    EXPECT_EQ(result->status, 200) << result->body;
    const bool canceled = nlohmann::json::parse(result->body)["state"] == "canceled";
    const std::lock_guard lock(mutex_);
    known()->canceled = known()->canceled || canceled;
  }

  /// An image that is served is whole, and the same each time.
  void fetch(const Job& job, Random& random) {
    std::string url = job.location;
    if (job.order.path == "/v1/sweeps") url += "/points/" + std::to_string(pick(random, 0, 8));
    url += pick(random, 0, 2) == 0 ? "/image?format=png" : "/image?format=exr";
    const auto result = answer([&](httplib::Client& client) { return client.Get(url); });
    if (!result || result->status == 409) return;
    EXPECT_EQ(result->status, 200) << url << ' ' << result->body;
    const std::lock_guard lock(mutex_);
    EXPECT_TRUE(images_.emplace(url, result->body).first->second == result->body)
        << url << " was served with other bits before";
  }

  /// Reads each stream to its end, over all kills.
  void follow(std::stop_token stop) {
    for (std::size_t at = 0; true;) {
      std::string location;
      {
        const std::lock_guard lock(mutex_);
        if (at < jobs_.size()) location = jobs_[at].location;
      }
      if (location.empty()) {
        if (stop.stop_requested()) return;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        continue;
      }
      EventLog& log = logs_[location];
      std::string text;
      httplib::Client client("127.0.0.1", port_);
      client.set_read_timeout(30);
      const auto result =
          client.Get(location + "/events", {{"Last-Event-ID", std::to_string(log.last())}},
                     [&](const char* data, std::size_t size) {
                       text.append(data, size);
                       log.take(text);
                       return true;
                     });
      if (result && result->status == 204) ++at;
      if (!result) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
  }

  const unsigned seed_;
  const std::ptrdiff_t most_jobs_;
  std::atomic<int> port_ = 1;  // nobody listens there
  std::mutex mutex_;
  std::vector<Job> jobs_;
  std::map<std::string, std::string> images_;  ///< by URL
  std::map<std::string, EventLog> logs_;       ///< by location; the follower's until it has ended
  std::vector<std::jthread> besiegers_;
  std::jthread follower_;
};

}  // namespace translucube::server::test

// Many clients at a service of its own for some minutes: renders, sweeps, cancels, deletes, streams
// that hang up, malformed bodies. Prints JSON; fails if a render was lost, if an answer was a 5xx
// but the promised 503, or if the service's memory grew.
//   build/release/bin/soak --minutes 10 --clients 50

#include <CLI/CLI.hpp>
#include <algorithm>
#include <atomic>
#include <fstream>
#include <iostream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/server/http/wire.h"
#include "tests/server/process/load.h"
#include "tests/server/service.h"
#include "tests/server/temp_folder.h"
#include "tests/support/malformed_corpus.h"

namespace {

using namespace translucube::server::test;
using nlohmann::json;
using std::chrono::steady_clock;

constexpr double most_growth = 1.1;        // last third over the middle one
constexpr double shortest_for_memory = 2;  // minutes: before, caches are still filling
constexpr std::size_t longest_body = 1 << 21;

/// What the clients saw, together.
class Ledger {
 public:
  void saw(int status) {
    const std::lock_guard lock(mutex_);
    ++statuses_[status];
  }
  void fault(const std::string& what) {
    const std::lock_guard lock(mutex_);
    if (faults_.size() < 20) faults_.push_back(what);
    ++fault_count_;
  }
  void count(const std::string& what) {
    const std::lock_guard lock(mutex_);
    ++counts_[what];
  }
  json report() {
    const std::lock_guard lock(mutex_);
    json statuses;
    for (const auto& [status, count] : statuses_) statuses[std::to_string(status)] = count;
    return {{"statuses", statuses},
            {"done", counts_},
            {"fault_count", fault_count_},
            {"faults", faults_}};
  }

 private:
  std::mutex mutex_;
  std::map<int, int> statuses_;
  std::map<std::string, int> counts_;
  std::vector<std::string> faults_;
  int fault_count_ = 0;
};

/// One that waits for each of its renders before it asks for the next.
class Client {
 public:
  Client(int port, unsigned seed, Ledger& ledger,
         const std::vector<translucube::test::MalformedBody>& malformed)
      : port_(port),
        random_(seed),
        ledger_(ledger),
        malformed_(malformed),
        http_("127.0.0.1", port) {
    http_.set_keep_alive(true);
    http_.set_read_timeout(90);
  }

  void run(std::stop_token stop) {
    while (!stop.stop_requested()) {
      const int what = pick(random_, 0, 9);
      if (what < 4)
        work(render_order(random_, 200));
      else if (what == 4)
        work(sweep_order(random_, 200));
      else if (what == 5)
        look_around();
      else
        send_nonsense();
      std::this_thread::sleep_for(std::chrono::milliseconds(pick(random_, 0, 50)));
    }
  }

 private:
  /// The answer, its status in the ledger; a 503 with Retry-After is one that was promised.
  std::optional<httplib::Response> checked(const std::string& what, httplib::Result result) {
    if (!result) {
      ledger_.fault(what + ": " + to_string(result.error()));
      return std::nullopt;
    }
    ledger_.saw(result->status);
    const bool promised = result->status == 503 && result->has_header("Retry-After");
    if (result->status >= 500 && !promised)
      ledger_.fault(what + ": " + std::to_string(result->status) + ' ' + result->body);
    return *result;
  }

  void work(const Order& order) {
    const auto posted = checked("post", http_.Post(order.path, order.body, "application/json"));
    if (!posted) return;
    if (posted->status != 200 && posted->status != 202) {
      if (posted->status < 500 && posted->status != 429)
        ledger_.fault("post: " + posted->body + " for " + order.body);
      return;
    }
    const std::string location = posted->get_header_value("Location");
    if (pick(random_, 0, 3) == 0) hang_up(location);
    const bool cancel = pick(random_, 0, 7) == 0;
    if (cancel) checked("cancel", http_.Post(location + "/cancel", "", ""));
    if (pick(random_, 0, 9) == 0) {
      remove(location);
      return;
    }
    const std::string state = end_of(location);
    ledger_.count(order.path + ' ' + state);
    if (state != "succeeded" && !(cancel && state == "canceled"))
      ledger_.fault("lost: " + location + " is " + state);
    if (state == "succeeded") look_at(order, location);
    if (pick(random_, 0, 2) == 0) remove(location);
  }

  std::string end_of(const std::string& location) {
    const auto give_up = steady_clock::now() + std::chrono::minutes(10);
    while (steady_clock::now() < give_up) {
      const auto answer = checked("status", http_.Get(location + "?wait=20"));
      if (answer && answer->status != 200) return std::to_string(answer->status);
      if (answer) {
        const json status = json::parse(answer->body);
        if (!status["finished_at"].is_null()) return status["state"];
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return "not ended after 10 minutes";
  }

  void look_at(const Order& order, const std::string& location) {
    std::string url = location;
    const bool sheet = order.path == "/v1/sweeps" && pick(random_, 0, 2) == 0;
    if (order.path == "/v1/sweeps" && !sheet)
      url += "/points/" + std::to_string(pick(random_, 0, 8));
    static const std::vector<std::string> forms{"exr", "png", "jpeg", "tiff"};
    url += sheet ? "/sheet" : "/image?format=" + one_of(forms, random_);
    if (order.explorable)
      url += "&absorption=0." + std::to_string(pick(random_, 0, 9)) + "&absorber=red-glass";
    const auto image = checked("image", http_.Get(url));
    if (image && image->status != 200) ledger_.fault(url + ": " + image->body);
  }

  /// Reads a little of a stream and is gone.
  void hang_up(const std::string& location) {
    Wire wire(port_);
    wire.send("GET " + location + "/events HTTP/1.1\r\nHost: localhost\r\n\r\n");
    wire.receive_some(pick(random_, 1, 300));
    ledger_.count("stream hung up");
  }

  void remove(const std::string& location) {
    const auto answer = checked("delete", http_.Delete(location));
    if (answer && answer->status != 204) ledger_.fault("delete: " + answer->body);
    const auto gone = checked("gone", http_.Get(location));
    if (gone && gone->status != 404) ledger_.fault(location + " is still there");
    ledger_.count("deleted");
  }

  void look_around() {
    static const std::vector<std::string> paths{"/v1/renders",   "/v1/sweeps?limit=5", "/metrics",
                                                "/readyz",       "/v1/displays",       "/livez",
                                                "/openapi.json", "/v1/absorbers"};
    const std::string path = one_of(paths, random_);
    const auto answer = checked(path, http_.Get(path));
    if (answer && answer->status != 200) ledger_.fault(path + ": " + answer->body);
  }

  void send_nonsense() {
    const auto& body = one_of(malformed_, random_);
    const char* path = pick(random_, 0, 1) == 0 ? "/v1/renders" : "/v1/sweeps";
    const auto answer = checked(body.name, http_.Post(path, body.text, "application/json"));
    if (answer && answer->status < 400) ledger_.fault("accepted: " + body.name);
    ledger_.count("malformed");
  }

  const int port_;
  Random random_;
  Ledger& ledger_;
  const std::vector<translucube::test::MalformedBody>& malformed_;
  httplib::Client http_;
};

double resident_mb(pid_t pid) {
  std::ifstream status("/proc/" + std::to_string(pid) + "/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmRSS:")) return std::stod(line.substr(6)) / 1024;
  return 0;
}

double mean(const std::vector<double>& values, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t i = first; i < last; ++i) sum += values[i];
  return sum / static_cast<double>(std::max<std::size_t>(1, last - first));
}

int soak(double minutes, int clients, unsigned seed) {
  const TempFolder folder;
  Service service(folder / "data");
  Ledger ledger;
  auto malformed = translucube::test::malformed_bodies();
  std::erase_if(malformed, [](const auto& body) { return body.text.size() > longest_body; });

  std::vector<double> resident;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < clients; ++i)
      threads.emplace_back([&, i](std::stop_token stop) {
        Client(service.port(), seed + static_cast<unsigned>(i), ledger, malformed).run(stop);
      });
    const auto end = steady_clock::now() + std::chrono::duration<double>(60 * minutes);
    while (steady_clock::now() < end) {
      std::this_thread::sleep_for(std::chrono::milliseconds(500));
      resident.push_back(resident_mb(service.process().pid()));
    }
    for (std::jthread& thread : threads) thread.request_stop();
  }  // each client waits for the end of what it has asked for

  const std::size_t samples = resident.size();
  const double middle = mean(resident, samples / 3, 2 * samples / 3);
  const double last = mean(resident, 2 * samples / 3, samples);
  json open = json::array();
  for (const char* state : {"queued", "running"}) {
    const json page = service.get(std::string("/v1/renders?status=") + state);
    for (const json& render : page["renders"]) open.push_back(render["id"]);
  }
  const auto start = steady_clock::now();
  service.process().kill(SIGTERM);
  const int status = service.process().wait();
  const std::chrono::duration<double> drained = steady_clock::now() - start;

  json report = ledger.report();
  const bool flat = minutes < shortest_for_memory || last <= most_growth * middle;
  const bool passed = report["fault_count"] == 0 && open.empty() && status == 0 && flat;
  report.update({{"minutes", minutes},
                 {"clients", clients},
                 {"seed", seed},
                 {"still_open", open},
                 {"resident_mb",
                  {{"middle_third", middle},
                   {"last_third", last},
                   {"most", *std::ranges::max_element(resident)}}},
                 {"memory_is_flat", flat},
                 {"exit_status", status},
                 {"exit_seconds", drained.count()},
                 {"passed", passed}});
  std::cout << report.dump(2) << std::endl;
  return passed ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Many clients at a service of its own, for long.", "soak");
  double minutes = 10;
  int clients = 50;
  unsigned seed = 1;
  app.add_option("--minutes", minutes)->check(CLI::Range(0.05, 10'000.0));
  app.add_option("--clients", clients)->check(CLI::Range(1, 1000));
  app.add_option("--seed", seed);
  CLI11_PARSE(app, argc, argv);
  return soak(minutes, clients, seed);
}

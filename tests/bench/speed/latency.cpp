// How long a person waits for the first picture.

#include <chrono>
#include <nlohmann/json.hpp>

#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"
#include "tests/server/service.h"
#include "tests/server/temp_folder.h"

namespace translucube::speed {

using namespace server::test;

namespace {

constexpr Quantity first{"first, ms", "%.1f"}, middle{"median, ms", "%.1f"},
    picture{"with its PNG, ms", "%.1f"}, tracing{"of it traced, ms", "%.1f"};

/// The peers' scene as a request of 4 samples: a first pass.
std::string request(const PeerMaterial& material, int size, std::uint64_t seed) {
  const Coefficients& c = material.coefficients;
  return nlohmann::json{
      {"material",
       {{"coefficients",
         {{"sigma_a_peak", c.sigma_a_peak}, {"alpha", c.alpha}, {"sigma_s", c.sigma_s}}},
        {"absorber", {{"rgb", {0.15, 1, 1}}}}}},
      {"scene",
       {{"object", {{"type", "sphere"}, {"radius_mm", 1}}},
        {"environment", {{"image", "forest"}}},
        {"camera", {{"position_mm", {0, 0, 4.5}}}}}},
      {"image", {{"width", size}, {"height", size}}},
      {"quality", {{"samples", 4}}},
      {"seed", seed % 1'000'000}}
      .dump();
}

class Stopwatch {
 public:
  double ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start_)
        .count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

Table of_the_service(Run& run) {
  Table table{"service", "First pass of a running service",
              "From posting a request (256 × 256, 4 samples, `Prefer: wait`) over a socket of the "
              "loopback to the answer that it has succeeded, its film stored. The first request of "
              "each material, and the median of more with other seeds: under 80 ms. Then the same "
              "until its PNG has come."};
  const TempFolder folder;
  const Service service(folder / "data", std::to_string(run.threads));
  httplib::Client client = service.client();
  client.set_keep_alive(true);
  const int repetitions = run.repetitions(7);
  for (const PeerMaterial& material : peer_materials) {
    if (!run.chosen(material.name)) continue;
    std::vector<double> times, pictures, traced;
    for (int i = 0; i <= repetitions; ++i) {
      const std::string body = request(material, 256, run.next_seed());
      const Stopwatch watch;
      const auto answer =
          client.Post("/v1/renders", {{"Prefer", "wait=30"}}, body, "application/json");
      times.push_back(watch.ms());
      if (!answer || answer->status != 200)
        throw std::runtime_error("the service answered " + (answer ? answer->body : "nothing"));
      const auto status = nlohmann::json::parse(answer->body);
      traced.push_back(1e3 * status.at("stats").at("seconds").get<double>());
      const auto png = client.Get(answer->get_header_value("Location") + "/image?format=png");
      if (!png || png->status != 200) throw std::runtime_error("no picture");
      pictures.push_back(watch.ms());
    }
    table.add(material.name, first, times.front());
    for (auto* values : {&times, &pictures, &traced}) values->erase(values->begin());
    table.add(material.name, middle, median(times), at_most(80));
    table.add(material.name, tracing, median(traced));
    table.add(material.name, picture, median(pictures));
  }
  return table;
}

Table of_the_process(Run& run) {
  Table table{
      "process", "From the start of the process to the first pixel",
      "`translucube render` of one pixel and 4 samples, from the start of the process to its "
      "end, the EXR written: under 150 ms. The median."};
  const TempFolder folder;
  const int repetitions = run.repetitions(9);
  for (const PeerMaterial& material : peer_materials) {
    if (!run.chosen(material.name)) continue;
    std::vector<double> times;
    for (int i = 0; i < repetitions; ++i) {
      const std::string body = request(material, 1, run.next_seed());
      const Stopwatch watch;
      const Ran ran = run_translucube({"render", "-", "-o", (folder / "pixel.exr").string()}, body);
      times.push_back(watch.ms());
      if (ran.status != 0) throw std::runtime_error("translucube render: " + ran.errors);
    }
    table.add(material.name, middle, median(times), at_most(150));
  }
  return table;
}

}  // namespace

Tables latency(Run& run) { return {of_the_service(run), of_the_process(run)}; }

}  // namespace translucube::speed

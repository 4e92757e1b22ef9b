// Cycles in the same run on the same machine, so that the ratio holds wherever it is measured.

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "picture/image_io.h"
#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"
#include "tests/bench/speed/shell.h"
#include "tests/server/temp_folder.h"
#include "tests/support/repository.h"

namespace translucube::speed {
namespace {

constexpr int cycles_size = 256;
constexpr Quantity samples_of_cycles{"samples", "%.0f"}, theirs{"Cycles, relMSE × CPU s"},
    ours{"ours"}, cycles_over_ours{"Cycles / ours", "%.1f"}, brightness{"mean, of ours", "%.3f"};

/// CPU ns of a sample in Cycles (docs/speed.md): tells how many samples are affordable.
struct Expected {
  const char* material;
  double ns;
};
constexpr Expected expected[] = {{"A0", 737},     {"A2", 723},       {"R05", 3'770}, {"R10", 4'770},
                                 {"R25", 4'980},  {"R50", 5'190},    {"S01", 3'000}, {"S1", 8'960},
                                 {"S10", 57'700}, {"S100", 257'000}, {"M", 37'400},  {"C", 40'000}};
constexpr double cpu_seconds_each = 20;

std::uint32_t affordable(const Expected& material, double effort) {
  const double samples =
      effort * cpu_seconds_each / (1e-9 * material.ns * cycles_size * cycles_size);
  return static_cast<std::uint32_t>(std::clamp(samples, 4.0, 64.0));
}

double mean(const Image& a, const Image& b) {
  double sum = 0;
  for (const Image* image : {&a, &b})
    for (const float p : image->pixels) sum += p;
  return sum / 2 / static_cast<double>(a.pixels.size());
}

}  // namespace

Tables cycles(Run& run) {
  Table table{"cycles", "Cycles on the same machine",
              "The same scene and materials in Blender's Cycles (`blender -b -P "
              "tests/bench/cycles.py`), two seeds, as many samples as 20 CPU seconds allow (4 to "
              "64): its relMSE × CPU seconds, scene building left out, over ours of this run. Its "
              "rough glass scatters once, ours many times between microfacets; its body is made of "
              "triangles. The mean of its image over ours shows that both render the same."};
  if (!run.cycles) {
    table.remark = "Not measured in this run: `speed --cycles` does where Blender is installed.";
    return {table};
  }
  if (!is_installed("blender")) {
    table.remark = "Not measured: Blender is not installed (`apt-get install blender`).";
    return {table};
  }
  const server::test::TempFolder folder;
  const SceneSpec scene = peer_scene({}, cycles_size, 1);
  std::string command = "blender -b --factory-startup -P " +
                        in_repository("tests/bench/cycles.py").string() + " -- --environment " +
                        std::get<ImageEnvironmentSpec>(scene.environment.source).file.string() +
                        " --out " + folder.path().string() +
                        text(" --size %d --threads %d", cycles_size, run.threads);
  for (const Expected& material : expected) {
    if (!run.chosen(material.material)) continue;
    const Coefficients& c = peer_material(material.material).coefficients;
    command += text(" --material %s,%g,%g,%g,%u", material.material, c.alpha, c.sigma_s,
                    c.sigma_a_peak, affordable(material, run.effort));
  }
  const ShellRun blender = run_shell(command);
  std::ifstream file(folder / "cycles.json");
  if (!blender.succeeded || !file)
    throw std::runtime_error(
        "Blender failed: " +
        blender.output.substr(blender.output.size() -
                              std::min<std::size_t>(2000, blender.output.size())));
  const auto answer = nlohmann::json::parse(file);
  table.remark = "Blender " + answer.at("version").get<std::string>() + ".";
  for (const Expected& material : expected) {
    if (!run.chosen(material.material)) continue;
    std::vector<Image> images;
    double seconds = 0, samples = 0;
    for (const auto& render : answer.at("renders"))
      if (render.at("material") == material.material) {
        images.push_back(read_image(render.at("file").get<std::string>()));
        seconds += render.at("cpu_seconds").get<double>() / 2;
        samples = render.at("samples");
      }
    const Coefficients& c = peer_material(material.material).coefficients;
    const double error =
        rel_mse_of_pair(images.at(0), images.at(1), reference_of(images, c)).trimmed;
    const Pair pair = render_pair(run, peer_scene(c, cycles_size, 0), run.samples(64));
    const double cost = pair.error().trimmed * pair.cpu_seconds;
    table.add(material.material, samples_of_cycles, samples);
    table.add(material.material, cpu_seconds, seconds);
    table.add(material.material, ns_a_sample,
              1e9 * seconds / (samples * cycles_size * cycles_size));
    table.add(material.material, theirs, error * seconds);
    table.add(material.material, ours, cost);
    table.add(material.material, cycles_over_ours, error * seconds / cost);
    table.add(material.material, brightness, mean(images[0], images[1]) / mean(pair.a, pair.b));
  }
  return {table};
}

}  // namespace translucube::speed

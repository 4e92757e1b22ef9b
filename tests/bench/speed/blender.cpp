#include "tests/bench/speed/blender.h"

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "picture/image_io.h"
#include "tests/bench/speed/shell.h"
#include "tests/server/temp_folder.h"
#include "tests/support/repository.h"

namespace translucube::speed {

std::string why_not_cycles(const Run& run) {
  if (!run.cycles)
    return "Not measured in this run: `speed --cycles` does where Blender is installed.";
  if (!is_installed("blender"))
    return "Not measured: Blender is not installed (`apt-get install blender`).";
  return {};
}

CyclesAnswer render_in_cycles(const Run& run, const std::filesystem::path& environment, int size,
                              const std::vector<CyclesTask>& tasks, const std::string& options) {
  const server::test::TempFolder folder;
  std::string command =
      "blender -b --factory-startup -P " + in_repository("tests/bench/cycles.py").string() +
      " -- --environment " + environment.string() + " --out " + folder.path().string() +
      text(" --size %d --threads %d ", size, run.threads) + options;
  for (const CyclesTask& task : tasks) {
    const Coefficients& c = test::peer_material(task.material).coefficients;
    command += text(" --material %s,%g,%g,%g,%u", task.material, c.alpha, c.sigma_s, c.sigma_a_peak,
                    task.samples);
  }
  const ShellRun blender = run_shell(command);
  std::ifstream file(folder / "cycles.json");
  if (!blender.succeeded || !file)
    throw std::runtime_error(
        "Blender failed: " +
        blender.output.substr(blender.output.size() -
                              std::min<std::size_t>(2000, blender.output.size())));
  const auto json = nlohmann::json::parse(file);
  CyclesAnswer answer{json.at("version").get<std::string>(), {}};
  for (const auto& render : json.at("renders")) {
    CyclesPair& pair = answer.pairs[render.at("material").get<std::string>()];
    pair.images.push_back(read_image(render.at("file").get<std::string>()));
    pair.cpu_seconds += render.at("cpu_seconds").get<double>() / 2;
    pair.samples = render.at("samples");
  }
  return answer;
}

}  // namespace translucube::speed

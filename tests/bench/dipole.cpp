// What the paper's model costs in error and saves in time (renderer/dipole.h): over the scattering
// coordinate, its white furnace, its mean luminance and relMSE against the exact transport on the
// peers' scene (forest, unit sphere, ior 1.5), and the CPU time per camera sample of both. The
// noise of both images is taken off the relMSE, so it may come out a little below 0. Prints a
// table, and JSON where asked.
//
//   dipole [--samples N] [--size N] [--threads N] [--absorption A] [--roughness R] [--json FILE]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "renderer/material_cube.h"
#include "renderer/render.h"

namespace {

using namespace translucube;

constexpr double scatterings[] = {0, 0.01, 0.05, 0.1, 0.25, 0.4, 0.6, 0.8, 0.9, 0.99, 0.999, 1};
/// Half the radius, as the service's default thickness (10 mm) is of its default sphere (20 mm).
constexpr double reference_thickness_mm = 0.5;

struct Options {
  std::uint32_t samples = 256;
  int size = 128, threads = 0;
  double absorption = 0, roughness = 0;
  std::string json_file;
};

SceneSpec peer_scene(const Options& options, double s, bool dipole) {
  SceneSpec spec;
  spec.material.coefficients =
      from_cube({options.absorption, options.roughness, s}, 0, reference_thickness_mm);
  spec.material.absorber = RgbAbsorber{{0.15, 1, 1}};
  if (dipole) spec.model = DipoleModel{s};
  spec.object = SphereObject{1};
  spec.environment.source =
      ImageEnvironmentSpec{TRANSLUCUBE_SOURCE_DIR "/config/environments/forest.exr"};
  spec.camera = {{0, 0, 4.5}, {0, 0, 0}, {0, 1, 0}, 32};
  spec.width = spec.height = options.size;
  return spec;
}

/// A constant environment of 1, the body over the whole image.
SceneSpec furnace_scene(const Options& options, double s) {
  SceneSpec spec = peer_scene(options, s, true);
  spec.environment.source = ConstantEnvironmentSpec{};
  spec.camera.vfov_deg = 16;
  spec.width = spec.height = std::min(options.size, 48);
  return spec;
}

struct Mean {
  double value, standard_error;
};
/// Of the luminance over all pixels.
Mean mean_luminance(const Film& film) {
  const Image image = develop(film), spread = variance(film);
  const double n = static_cast<double>(image.pixels.size()) / 3;
  Mean mean{0, 0};
  for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
    mean.value += luminance({image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]}) / n;
    mean.standard_error += spread.pixels[i + 1];  // green: most of the luminance
  }
  mean.standard_error = std::sqrt(mean.standard_error) / n;
  return mean;
}

/// Mean (x - ref)^2 / (ref^2 + 0.01) without the 0.1 % largest pixels, less what the noise of both
/// images brings to it.
double rel_mse(const Film& film, const Film& reference) {
  const Image x = develop(film), r = develop(reference);
  const Image vx = variance(film), vr = variance(reference);
  std::vector<double> error(x.pixels.size() / 3, 0);
  for (std::size_t i = 0; i < x.pixels.size(); ++i) {
    const double d = x.pixels[i] - r.pixels[i], ref = r.pixels[i];
    error[i / 3] += (d * d - vx.pixels[i] - vr.pixels[i]) / (ref * ref + 0.01) / 3;
  }
  std::ranges::sort(error);
  const std::size_t kept = error.size() - error.size() / 1000;
  double sum = 0;
  for (std::size_t i = 0; i < kept; ++i) sum += error[i];
  return sum / static_cast<double>(kept);
}

double ns_per_sample(const RenderResult& result) {
  return 1e9 * result.stats.cpu_seconds / double(result.film.counters.camera_samples);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string option = argv[i], value = argv[i + 1];
    if (option == "--samples")
      options.samples = static_cast<std::uint32_t>(std::stoul(value));
    else if (option == "--size")
      options.size = std::stoi(value);
    else if (option == "--threads")
      options.threads = std::stoi(value);
    else if (option == "--absorption")
      options.absorption = std::stod(value);
    else if (option == "--roughness")
      options.roughness = std::stod(value);
    else if (option == "--json")
      options.json_file = value;
    else
      return std::fprintf(stderr, "dipole: unknown option %s\n", option.c_str()), 2;
  }
  const SampleTarget target{options.samples};
  nlohmann::json report = nlohmann::json::array();
  std::printf("%6s %9s %18s %9s %9s %18s %10s %9s %9s\n", "s", "sigma_s", "white furnace", "dipole",
              "transport", "luminance ratio", "relMSE", "ns", "ns exact");
  for (const double s : scatterings) {
    const RenderResult dipole =
        render(*build_scene(peer_scene(options, s, true)), target, options.threads);
    const RenderResult exact =
        render(*build_scene(peer_scene(options, s, false)), target, options.threads);
    const RenderResult furnace =
        render(*build_scene(furnace_scene(options, s)), target, options.threads);
    const Mean gain = mean_luminance(furnace.film), model = mean_luminance(dipole.film),
               truth = mean_luminance(exact.film);
    const double ratio = model.value / truth.value;
    const double ratio_error =
        ratio * std::hypot(model.standard_error / model.value, truth.standard_error / truth.value);
    const double error = rel_mse(dipole.film, exact.film);
    const double sigma_s = peer_scene(options, s, true).material.coefficients.sigma_s;
    std::printf("%6g %9.4g %9.4f +- %.4f %9.4f %9.4f %9.4f +- %.4f %10.4g %9.0f %9.0f\n", s,
                sigma_s, gain.value, gain.standard_error, model.value, truth.value, ratio,
                ratio_error, error, ns_per_sample(dipole), ns_per_sample(exact));
    std::fflush(stdout);
    report.push_back(
        {{"scattering", s},
         {"sigma_s_per_mm", std::isfinite(sigma_s) ? nlohmann::json(sigma_s) : nullptr},
         {"white_furnace", gain.value},
         {"white_furnace_standard_error", gain.standard_error},
         {"mean_luminance", model.value},
         {"mean_luminance_of_transport", truth.value},
         {"luminance_ratio", ratio},
         {"luminance_ratio_standard_error", ratio_error},
         {"relmse_against_transport", error},
         {"ns_per_sample", ns_per_sample(dipole)},
         {"ns_per_sample_of_transport", ns_per_sample(exact)},
         {"transport", dipole.stats.transport},
         {"samples", options.samples},
         {"size", options.size}});
  }
  if (!options.json_file.empty()) std::ofstream(options.json_file) << report.dump(2) << "\n";
}

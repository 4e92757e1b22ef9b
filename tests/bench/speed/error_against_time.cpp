// How the error falls with time, for each material and model.

#include "renderer/optics/material_cube.h"
#include "tests/bench/speed/images.h"
#include "tests/bench/speed/sections.h"

namespace translucube::speed {
namespace {

constexpr int error_size = 128;
/// The dipole's opacity is the cube's coordinate for half the radius, as for the service's default
/// sphere.
constexpr double reference_thickness_mm = 0.5;

void add(Table& table, const std::string& row, const Snapshot& at, double error) {
  table.add(row, {"CPU s"}, at.cpu_seconds);
  table.add(row, {"relMSE", "%.3g", 0.5}, error);
}

}  // namespace

Tables error_against_time(Run& run) {
  Table table{
      "error", "Error against time",
      "128 × 128 pixels; samples of a pixel, CPU seconds of one render and its relMSE (trimmed). "
      "Transport from two renders; the dipole model (`\"model\": \"dipole\"`) against the mean of "
      "transport's last two, less their noise: what it does not lose with time is its error as a "
      "model."};
  std::vector<std::uint32_t> samples;
  for (const std::uint32_t n : {4u, 16u, 64u, 256u})
    if (samples.empty() || run.samples(n) > samples.back()) samples.push_back(run.samples(n));
  for (const PeerMaterial& material : peer_materials) {
    if (!run.chosen(material.name)) continue;
    SceneSpec spec = peer_scene(material.coefficients, error_size, 0);
    const auto render = [&] {
      spec.seed = run.next_seed();
      return trace(*build_scene(spec), samples, run.threads);
    };
    const std::vector<Snapshot> a = render(), b = render();
    const Image mean = mean_of({a.back().image, b.back().image});
    const Image reference = reference_of({a.back().image, b.back().image}, material.coefficients);
    for (std::size_t i = 0; i < a.size(); ++i)
      add(table, text("%s, transport, %u", material.name, a[i].samples), a[i],
          rel_mse_of_pair(a[i].image, b[i].image, reference).trimmed);
    if (material.coefficients.sigma_s == 0) continue;
    const double noise = rel_mse_of_pair(a.back().image, b.back().image, reference).trimmed / 2;
    spec.model = DipoleModel{to_cube(material.coefficients, 0, reference_thickness_mm).scattering};
    for (const Snapshot& at : render())
      add(table, text("%s, dipole, %u", material.name, at.samples), at,
          rel_mse(at.image, mean).trimmed - noise);
  }
  table.plots.push_back({"error", "Error against CPU seconds, for each material and model"});
  return {table};
}

}  // namespace translucube::speed

// What the paper's model costs in error and saves in time (renderer/optics/dipole.h), over the
// scattering coordinate of the cube.

#include "renderer/optics/material_cube.h"
#include "tests/bench/accuracy/images.h"
#include "tests/bench/accuracy/sections.h"

namespace translucube::accuracy {

using namespace test;

namespace {

/// Half the radius, as the service's default thickness (10 mm) is of its default sphere (20 mm).
constexpr double reference_thickness_mm = 0.5;

double ns_per_sample(const RenderResult& result) {
  return 1e9 * result.stats.cpu_seconds / double(result.film.counters.camera_samples);
}

}  // namespace

Table dipole(Run& run) {
  Table table{
      "dipole", "The paper's model against exact transport",
      "`\"model\": \"dipole\"`: Jensen's dipole (2001) beside a cross-fade of dielectric and "
      "plastic, as Gerardin et al. 2019 have it (renderer/optics/dipole.h says how its energy is "
      "balanced), on the peers' scene, smooth and without absorption. White furnace: 1 where "
      "energy is kept; between s = 0 and 1 the model does not, and no figure here is held to "
      "it. Luminance: mean over the image, over that of exact transport. relMSE: mean (x - "
      "ref)^2 / (ref^2 + 0.01) against exact transport, with the noise of both images taken "
      "off, so that it may come out below 0."};
  for (const double s : {0.0, 0.01, 0.05, 0.1, 0.25, 0.4, 0.6, 0.8, 0.9, 0.99, 0.999, 1.0}) {
    const std::string row = text("s %g", s);
    const auto rendered = [&](bool model, bool furnace) {
      SceneSpec spec =
          peer_scene(from_cube({0, 0, s}, 0, reference_thickness_mm), 128, run.next_seed());
      if (model) spec.model = DipoleModel{s};
      if (furnace) {
        spec.environment.source = ConstantEnvironmentSpec{};
        spec.camera.vfov_deg = 16;  // the body over the whole image
        spec.width = spec.height = 48;
      }
      return render(*build_scene(spec), SampleTarget{run.samples(160)}, run.threads());
    };
    const RenderResult model = rendered(true, false), exact = rendered(false, false),
                       furnace = rendered(true, true);
    const Measured a = mean_luminance(model.film), b = mean_luminance(exact.film);
    const double ratio = a.mean / b.mean;
    const bool energy = s == 0 || s == 1;
    table.add_column(row, "white furnace", image_mean(furnace.film),
                     energy ? std::optional(Truth{1, 0, 0, "energy conservation"}) : std::nullopt);
    table.add_column(
        row, "luminance",
        {ratio, ratio * std::hypot(a.standard_error / a.mean, b.standard_error / b.mean)});
    table.add_column(row, "relMSE", rel_mse(model.film, exact.film));
    table.add_time(row, "CPU ns a sample, model", ns_per_sample(model));
    table.add_time(row, "CPU ns a sample, exact", ns_per_sample(exact));
  }
  table.plots.push_back({"dipole", "Error of the dipole model over the scattering coordinate"});
  return table;
}

}  // namespace translucube::accuracy

// White furnaces: in a constant environment of 1 a body that does not absorb has radiance 1.

#include "tests/bench/accuracy/sections.h"
#include "tests/support/hard_cases.h"
#include "tests/support/meshes.h"
#include "tests/support/repository.h"
#include "tests/support/truths.h"

namespace translucube::accuracy {
namespace {

using namespace test;

const Truth white{1, 0, 0, "energy conservation"};

void sphere_furnace(Table& table, Run& run, double s, double r, double ior, double g = 0) {
  const double sigma_s = sigma_s_of_cube(s) / (1 - g);
  Scene scene = body(Sphere{}, material(ior, r * r, sigma_s, g), run.next_seed());
  look_from_afar(scene, 0.7, 32);  // the whole image lies on the body
  std::string name = text("sphere: s %g, r %g, ior %g", s, r, ior);
  if (g != 0) name += text(", g %g", g);
  table.add(name, image_mean(trace(scene, run.samples(384), run.threads())), white);
}

void mesh_furnace(Table& table, Run& run, const char* name, const TriangleMesh& mesh, double s,
                  double r) {
  Scene scene =
      body(build_mesh(mesh).mesh, material(1.5, r * r, sigma_s_of_cube(s)), run.next_seed());
  scene.camera = Camera({1.5, 1.1, 2.5}, {0, 0, 0}, {0, 1, 0}, 40, 32, 32);
  scene.width = scene.height = 32;
  table.add(text("%s: s %g, r %g, ior 1.5", name, s, r),
            image_mean(trace(scene, run.samples(256), run.threads())), white);
}

/// Share of the diffuse light on a rough sphere of glass that leaves it again.
Measured kept(Run& run, double alpha, bool multiple) {
  Scene scene = body(Sphere{}, material(1.5, alpha, 0), run.next_seed());
  std::get<RoughInterface>(scene.interface).multiple_scattering = multiple;
  look_from_afar(scene, 1.0, 64);
  return over_the_disc(image_mean(trace(scene, run.samples(96), run.threads())), 1);
}

void add_case(Table& table, Run& run, const std::string& name, SceneSpec spec,
              std::uint32_t samples, std::optional<Truth> truth = white) {
  spec.seed = run.next_seed();
  const RenderResult result =
      render(*build_scene(spec), SampleTarget{run.samples(samples)}, run.threads());
  const TraceCounters& counters = result.film.counters;
  const auto paths = static_cast<double>(counters.camera_samples);
  table.add_column(name, "mean", image_mean(result.film), std::move(truth));
  table.add_column(name, "NaN", {double(counters.nan_samples), 0}, Truth{});
  table.add_column(name, "truncated energy", {counters.truncated_energy / paths, 0}, Truth{});
  table.add_time(name, "CPU ns a sample", 1e9 * result.stats.cpu_seconds / paths);
}

}  // namespace

Table white_furnaces(Run& run) {
  Table table{
      "furnace", "White furnace",
      "Mean radiance of a body that does not absorb, in a constant environment of 1. Sphere "
      "of 20 mm; box of 1 : 1.5 : 2; knot: a tube that sees itself."};
  for (const double s : {0.0, 0.2, 0.9, 0.99, 1.0})
    for (const double r : {0.0, 0.3, 0.7, 1.0}) sphere_furnace(table, run, s, r, 1.5);
  for (const double ior : {1.0, 1.33, 2.5})
    for (const double r : {0.0, 0.5}) sphere_furnace(table, run, 0.2, r, ior);
  for (const double g : {-0.9, 0.9}) sphere_furnace(table, run, 0.5, 0.3, 1.5, g);
  const TriangleMesh bar = box({1, 1.5, 2}), tube = knot(240, 24);
  for (const double s : {0.0, 0.2, 0.9})
    for (const double r : {0.0, 0.5}) mesh_furnace(table, run, "box", bar, s, r);
  mesh_furnace(table, run, "knot", tube, 0.2, 0);
  mesh_furnace(table, run, "knot", tube, 0.2, 0.5);
  return table;
}

Table single_scattering(Run& run) {
  Table table{
      "microfacets", "Energy kept by rough glass",
      "Share of the diffuse light on a clear rough sphere (ior 1.5) that leaves it again. "
      "With scattering between microfacets (the default; Heitz et al. 2016) all of it must; "
      "without it, as in most renderers, a part is lost. Single-scattering values of Mitsuba "
      "0.6 stand beside; pbrt-v4 and Mitsuba agree on them within .03 only, as their "
      "shadowing of transmitted light differs, so the figure is held to .03."};
  const std::pair<double, double> peers[] = {{.02, 0},   {.05, .983}, {.1, .945}, {.25, .787},
                                             {.5, .556}, {.75, 0},    {1, .305}};
  for (const auto& [alpha, mitsuba] : peers) {
    const std::string row = text("alpha %g", alpha);
    std::optional<Truth> peer;
    if (mitsuba > 0) peer = Truth{mitsuba, 0, 0.03, "Mitsuba 0.6"};
    table.add_column(row, "multiple scattering", kept(run, alpha, true), white);
    table.add_column(row, "single scattering", kept(run, alpha, false), peer);
  }
  table.plots.push_back({"microfacets", "Energy kept by rough glass over the roughness"});
  return table;
}

Table hard_cases(Run& run) {
  Table table{
      "hard", "Hard cases",
      "White furnaces where renderers go wrong: the mean must be 1, no sample may be NaN or "
      "infinite, and no path may be given up with energy left. The two rows of a sun (peak "
      "34,000) compare a render with that of another seed."};
  for (const HardCase& c : test::hard_cases) {
    add_case(table, run,
             text("alpha %g, sigma_s %g / mm, ior %g, g %g, radius %g mm", c.alpha, c.sigma_s,
                  c.ior, c.g, c.radius_mm),
             hard_furnace(c.radius_mm, c.alpha, c.sigma_s, c.ior, c.g), c.samples);
  }
  for (const double alpha : {0.0, 1e-3, 0.5}) {
    SceneSpec spec = hard_furnace(1, alpha, 1, 1.5, 0);
    spec.camera.target_mm = {0.999, 0, 0};
    spec.camera.vfov_deg = 0.1;
    add_case(table, run, text("silhouette, alpha %g", alpha), spec, 256);
  }
  for (const double alpha : {0.0, 0.3}) {
    SceneSpec spec = hard_furnace(1, alpha, 5, 1.5, 0);
    spec.camera.position_mm = {0.2, 0.1, 0.3};
    spec.camera.vfov_deg = 90;
    add_case(table, run, text("camera inside, alpha %g", alpha), spec, 512);
  }
  for (const double sigma_s : {0.0, 10.0}) {
    SceneSpec spec = hard_furnace(1, 0.2, sigma_s, 1.5, 0);
    spec.environment.source =
        ImageEnvironmentSpec{in_repository("config/environments/sunrise.exr")};
    spec.seed = run.next_seed();
    const Measured other = image_mean(trace(*build_scene(spec), run.samples(256), run.threads()));
    add_case(table, run, text("sun, alpha 0.2, sigma_s %g / mm", sigma_s), spec, 256,
             Truth{other.mean, other.standard_error, 0, "another seed"});
  }
  return table;
}

}  // namespace translucube::accuracy

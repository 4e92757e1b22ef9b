// Mean path lengths, and answers that two independent ways must share: large steps and the analog
// walk, developed and traced absorption, the sphere and a ball of triangles.

#include "tests/bench/accuracy/sections.h"
#include "tests/support/meshes.h"
#include "tests/support/truths.h"
#include "tests/support/walks.h"

namespace translucube::accuracy {

using namespace test;

namespace {

/// In units of the truth: what the tables and the plot compare across indices.
Measured relative(const Measured& e, double truth) {
  return {e.mean / truth, e.standard_error / truth};
}

Measured dense_path(double sigma_s, double ior, int walks, std::uint64_t key) {
  constexpr double chord = 4.0 / 3;  // 4 V / S
  const MeanLength m = mean_length(Sphere{}, chord, enter_sphere, {sigma_s, 0}, ior, walks, key);
  return {m.mean, m.standard_error};
}

}  // namespace

Table mean_path_lengths(Run& run) {
  Table table{
      "lengths", "Mean path length",
      "Mean length inside a sphere of radius R for each diffuse ray that meets it, over its "
      "exact value: 4 V / S ior^2 = 4/3 ior^2 R at any density, less the trapped directions "
      "where nothing scatters and the surface is smooth. It guards the lengths from which "
      "absorption is developed. Up to sigma_s R = 100 from renders; beyond, nearly all light "
      "turns back and nearly all length is travelled deep inside, so that the same walk is "
      "split with depth instead."};
  const std::string source = "Blanco and Fournier 2003";
  for (const double ior : {1.0, 1.33, 1.5, 2.5}) {
    const std::string column = text("ior %g", ior);
    const double scattering = 4.0 / 3 * ior * ior;
    const double clear = scattering * (1 - std::pow(1 - 1 / (ior * ior), 1.5));
    table.add_column("clear, smooth", column,
                     relative(mean_path_of(Sphere{}, material(ior, 0, 0), run.samples(128),
                                           run.next_seed(), run.threads()),
                              clear),
                     Truth{1, 0, 0, "trapped directions left out"});
    table.add_column("clear, r 0.5", column,
                     relative(mean_path_of(Sphere{}, material(ior, 0.25, 0), run.samples(192),
                                           run.next_seed(), run.threads()),
                              scattering),
                     Truth{1, 0, 0, source});
    for (const double sigma_s : {0.1, 1.0, 10.0, 100.0})
      table.add_column(text("sigma_s R %g", sigma_s), column,
                       relative(mean_path_of(Sphere{}, material(ior, 0, sigma_s), run.samples(192),
                                             run.next_seed(), run.threads()),
                                scattering),
                       Truth{1, 0, 0, source});
    for (const double sigma_s : {1e3, 1e4, 1e5, 1e6})
      table.add_column(text("sigma_s R %g", sigma_s), column,
                       dense_path(sigma_s, ior, run.walks(200'000), run.next_seed()),
                       Truth{1, 0, 0, source});
  }
  table.plots.push_back({"lengths", "Mean path length over its exact value, with standard errors"});
  return table;
}

Table walks(Run& run) {
  Table table{"ways", "One answer, two ways",
              "What must agree whichever way it is computed. *Traced* absorption is a walk of its "
              "own, flight by flight in sigma_s + sigma_a and weighted by the albedo at each "
              "collision; *developed* is the renderer's lane. All by diffuse light on a sphere "
              "of radius 1 and ior 1.5; absorption per radius."};
  for (const double sigma_s : {2.0, 20.0})
    for (const float sigma_a : {0.1f, 1.0f, 10.0f}) {
      Scene scene = body(Sphere{}, material(1.5, 0, sigma_s), run.next_seed());
      scene.lanes = {RgbLane{{sigma_a, sigma_a, sigma_a}}};
      look_from_afar(scene, 1.0, 64);
      const Measured developed =
          over_the_disc(image_mean(trace(scene, run.samples(256), run.threads())), 1);
      const Measured traced =
          ReferenceWalk{{sigma_s, 0}, 1.5, sigma_a, ReferenceWalk::Steps::absorbing}.leaving(
              run.walks(400'000), run.next_seed());
      table.add(text("developed = traced: sigma_s %g, sigma_a %g", sigma_s, sigma_a), developed,
                {traced.mean, traced.standard_error, 0, "traced absorption"});
    }
  for (const double sigma_s : {10.0, 100.0})
    for (const double sigma_a : {0.01, 1.0}) {
      const ReferenceWalk large{{sigma_s, 0}, 1.5, sigma_a};
      const ReferenceWalk analog{{sigma_s, 0}, 1.5, sigma_a, ReferenceWalk::Steps::analog};
      const int n = sigma_s > 50 ? 60'000 : 200'000;
      const Measured steps = large.leaving(run.walks(n), run.next_seed());
      const Measured flights = analog.leaving(run.walks(n), run.next_seed());
      table.add(text("large steps = analog walk: sigma_s %g, sigma_a %g", sigma_s, sigma_a), steps,
                {flights.mean, flights.standard_error, 0, "analog walk"});
    }
  for (const double sigma_s : {0.5, 4.0}) {
    const Material m = material(1.5, 0, sigma_s);
    Measured means[2];
    for (const bool mesh : {false, true}) {
      AnyShape shape = Sphere{};
      if (mesh) shape = build_mesh(icosphere(6)).mesh;
      Scene scene = body(shape, m, run.next_seed());
      scene.environment = half_space_light(true);
      look_from_afar(scene, 1.1, 32);
      means[mesh] = image_mean(trace(scene, run.samples(512), run.threads()));
    }
    table.add(text("81,920 triangles = sphere: lit from one side, sigma_s %g", sigma_s), means[1],
              {means[0].mean, means[0].standard_error, 0, "analytic sphere"});
  }
  const Measured ball = mean_path_of(build_mesh(icosphere(5)).mesh, material(1.5, 0, 2),
                                     run.samples(256), run.next_seed(), run.threads(), 48);
  table.add("mean path length in 20,480 triangles / 3 R", relative(ball, 3),
            {1, 0, 0, "Blanco and Fournier 2003"});
  return table;
}

}  // namespace translucube::accuracy

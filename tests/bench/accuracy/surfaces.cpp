// The microsurface by itself, and the opaque end of the scattering axis.

#include <cstdio>
#include <limits>

#include "tests/bench/accuracy/sections.h"
#include "tests/support/microsurface.h"
#include "tests/support/truths.h"

namespace translucube::accuracy {

using namespace test;

Table microsurfaces(Run& run) {
  Table table{
      "microsurface", "Microsurface",
      "GGX with all orders of scattering between its microfacets (renderer/microsurface.h). "
      "Reciprocity: the value of the BSDF, per index squared, over that with the directions "
      "exchanged; directions at cosines 0.8 and 0.35, transmission 0.8 and 0.5. Directional "
      "albedo: reflectance plus "
      "transmittance, worst over four cosines of incidence from 1 to 0.001."};
  const Vec3 a = from_angles(0.8, 0), b = from_angles(0.35, 2.0), below = from_angles(0.5, 2.6);
  const Vec3 a_from_below{a.x, a.y, -a.z}, below_from_a{below.x, below.y, -below.z};
  const auto compare = [&](const std::string& name, const Estimate& forth, const Estimate& back) {
    const double ratio = forth.mean / back.mean;
    const double error = std::fabs(ratio) * std::hypot(forth.standard_error / forth.mean,
                                                       back.standard_error / back.mean);
    table.add(name, {ratio, error}, {1, 0, 0, "Helmholtz reciprocity"});
  };
  for (const double alpha : {0.2, 0.6, 1.0})
    for (const double eta : {1.5, 1 / 1.5}) {
      const Ggx ggx{alpha};
      const char* const side = eta > 1 ? "outside" : "inside";
      const int n = run.walks(200'000);
      compare(text("reflection from %s, alpha %g", side, alpha),
              bsdf(ggx, eta, a, b, run.next_seed(), n), bsdf(ggx, eta, b, a, run.next_seed(), n));
      Estimate down = bsdf(ggx, eta, a, below_from_a, run.next_seed(), n);
      down.mean /= eta * eta;
      down.standard_error /= eta * eta;
      compare(text("transmission from %s, alpha %g", side, alpha), down,
              bsdf(ggx, 1 / eta, below, a_from_below, run.next_seed(), n));
    }
  for (const double alpha : {1e-4, 0.05, 0.3, 1.0})
    for (const double eta : {1.5, 1 / 1.5, 2.5, 1 / 2.5}) {
      double worst = 1;
      for (const double mu : {1.0, 0.6, 0.1, 1e-3}) {
        const DirectionalAlbedo d = directional_albedo({1.5, Ggx{alpha}, true}, eta, mu);
        const double sum = d.reflected + d.transmitted;
        if (!(std::fabs(sum - 1) <= std::fabs(worst - 1))) worst = sum;
      }
      table.add(text("R + T, alpha %g, index ratio %.3g", alpha, eta), {worst, 0},
                {1, 0, 1e-4, "energy conservation"});
    }
  return table;
}

Table interfaced_lambertian(Run& run) {
  Table table{
      "lambertian", "The opaque end",
      "At s = 1 the body is an interfaced Lambertian one (Elias, Simonot, Menu 2001); towards "
      "it, a half space of isotropic scatterers, whose light follows Chandrasekhar's H "
      "function and not Lambert's law. Both conserve energy, but their pictures differ by "
      "about a hundredth of the white, whatever the density: this is the step between the "
      "last density below s = 1 and s = 1 itself. Mean over a sphere lit by the half "
      "of the sky that the camera stands in, as a share of that sky's radiance.",
      Table::Layout::columns};
  const auto look = [&](double ior, double alpha, double sigma_s) {
    Scene scene = body(Sphere{}, material(ior, alpha, sigma_s), run.next_seed());
    scene.environment = half_space_light(true);
    look_from_afar(scene, 1.0, 64);
    return over_the_disc(image_mean(trace(scene, run.samples(512), run.threads())), 0);
  };
  for (const double ior : {1.0, 1.5})
    for (const double alpha : {0.0, 0.3}) {
      if (ior == 1 && alpha > 0) continue;
      const std::string row = text("ior %g, alpha %g", ior, alpha);
      const Estimate dense = look(ior, alpha, 1e5),
                     lambert = look(ior, alpha, std::numeric_limits<double>::infinity());
      table.add_column(row, "sigma_s R = 1e5", dense);
      table.add_column(row, "s = 1", lambert);
      table.add_column(
          row, "difference",
          {dense.mean - lambert.mean, std::hypot(dense.standard_error, lambert.standard_error)});
    }
  return table;
}

}  // namespace translucube::accuracy

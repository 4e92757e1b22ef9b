// The microsurface by itself.

#include <cstdio>

#include "tests/bench/accuracy/sections.h"
#include "tests/support/microsurface.h"

namespace translucube::accuracy {

using namespace test;

Table microsurfaces(Run& run) {
  Table table{
      "microsurface", "Microsurface",
      "GGX with all orders of scattering between its microfacets (renderer/optics/microsurface.h). "
      "Reciprocity: the value of the BSDF, per index squared, over that with the directions "
      "exchanged; directions at cosines 0.8 and 0.35, transmission 0.8 and 0.5. Directional "
      "albedo: reflectance plus "
      "transmittance, worst over index ratios of 1.5 and 2.5, both ways, and cosines of incidence "
      "from 1 to 0.001."};
  const Vec3 a = from_angles(0.8, 0), b = from_angles(0.35, 2.0), below = from_angles(0.5, 2.6);
  const Vec3 a_from_below{a.x, a.y, -a.z}, below_from_a{below.x, below.y, -below.z};
  const auto compare = [&](const std::string& name, const Measured& forth, const Measured& back) {
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
      Measured down = bsdf(ggx, eta, a, below_from_a, run.next_seed(), n);
      down.mean /= eta * eta;
      down.standard_error /= eta * eta;
      compare(text("transmission from %s, alpha %g", side, alpha), down,
              bsdf(ggx, 1 / eta, below, a_from_below, run.next_seed(), n));
    }
  for (const double alpha : {1e-4, 0.05, 0.3, 1.0}) {
    double worst = 1;
    for (const double eta : {1.5, 1 / 1.5, 2.5, 1 / 2.5})
      for (const double mu : {1.0, 0.6, 0.1, 1e-3}) {
        const DirectionalAlbedo d = directional_albedo({1.5, Ggx{alpha}, true}, eta, mu);
        const double sum = d.reflected + d.transmitted;
        if (!(std::fabs(sum - 1) <= std::fabs(worst - 1))) worst = sum;
      }
    table.add(text("R + T, alpha %g", alpha), {worst, 0}, {1, 0, 1e-4, "energy conservation"});
  }
  return table;
}

}  // namespace translucube::accuracy

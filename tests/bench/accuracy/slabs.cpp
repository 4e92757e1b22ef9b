// Flat slabs: rendered, and by the instruments' optics of renderer/slab/appearance.h.

#include "renderer/slab/appearance.h"
#include "tests/bench/accuracy/sections.h"
#include "tests/support/truths.h"

namespace translucube::accuracy {

using namespace test;

namespace {

/// The last digit of a printed value stands for a uniform error.
double rounded_at(double last_digit) { return last_digit / std::sqrt(12.0); }

const Truth van_de_hulst_r{.09739, rounded_at(1e-5), 0, "van de Hulst 1980, table 35"},
    van_de_hulst_t{.66096, rounded_at(1e-5), 0, "van de Hulst 1980, table 35"},
    giovanelli{.2600, rounded_at(1e-4), 0, "Giovanelli 1955"};

/// Between two faces of reflectance f, for a path of optical length tau from face to face.
struct Faces {
  double reflectance, transmittance;
};
Faces clear_slab(double f, double tau) {
  const double e = std::exp(-tau), back = 1 - f * f * e * e;
  return {f + f * (1 - f) * (1 - f) * e * e / back, (1 - f) * (1 - f) * e / back};
}
constexpr double f_normal = 0.04;  // ior 1.5

const char* const matched = "matched index, sigma_a 10, sigma_s 90, g 0.75, thickness 0.02";
const char* const half_space = "half space, ior 1.5, albedo 0.9";
const char* const clear_half = "clear slab, ior 1.5, sigma_a d 0.5";

}  // namespace

Table slabs(Run& run) {
  Table table{
      "slabs", "Slabs, rendered",
      "Reflectance and transmittance at normal incidence of slabs rendered as any body is."};
  const LitSlab thin = lit_slab(material(1, 0, 90 * 0.02, 0.75), 0.2f, run.samples(1024),
                                run.next_seed(), run.threads());
  table.add(std::string("R, ") + matched, thin.reflectance, van_de_hulst_r);
  table.add(std::string("T, ") + matched, thin.transmittance, van_de_hulst_t);
  constexpr float depth = 60;  // mean free paths of scattering: as good as infinitely deep
  table.add(
      std::string("R, ") + half_space,
      lit_slab(material(1.5, 0, depth), depth / 9, run.samples(256), run.next_seed(), run.threads())
          .reflectance,
      giovanelli);
  const LitSlab clear =
      lit_slab(material(1.5, 0, 0), 0.5f, run.samples(64), run.next_seed(), run.threads());
  const Faces faces = clear_slab(f_normal, 0.5);
  table.add(std::string("R, ") + clear_half, clear.reflectance,
            {faces.reflectance, 0, 0, "reflections summed"});
  table.add(std::string("T, ") + clear_half, clear.transmittance,
            {faces.transmittance, 0, 0, "reflections summed"});
  return table;
}

Table slab_appearances(Run& run) {
  Table table{
      "appearance", "Slabs, by `translucube appearance`",
      "The same slabs through the optics of flat samples (renderer/slab/appearance.h), whose walks "
      "are not the renderer's."};
  Material m;
  const auto measure = [&](double ior, double sigma_s, double sigma_a, double g, double thickness,
                           double error) {
    m.coefficients = {sigma_a, 0, sigma_s};
    m.ior = ior;
    m.g = g;
    m.absorber = RgbAbsorber{};
    return slab_appearance(m, thickness, run.error(error), run.next_seed(), run.threads());
  };
  const auto reflected = [](const SlabAppearance::AtIncidence& at) {
    return Measured{at.value.reflected.total[1], at.standard_error.reflected.total[1]};
  };
  const auto transmitted = [](const SlabAppearance::AtIncidence& at) {
    return Measured{at.value.transmitted.total[1], at.standard_error.transmitted.total[1]};
  };
  const SlabAppearance thin = measure(1, 90, 10, 0.75, 0.02, 1.5e-4);
  table.add(std::string("R, ") + matched, reflected(thin.normal), van_de_hulst_r);
  table.add(std::string("T, ") + matched, transmitted(thin.normal), van_de_hulst_t);
  table.add(std::string("R, ") + half_space, reflected(measure(1.5, 90, 10, 0, 1, 2e-4).normal),
            giovanelli);
  const SlabAppearance clear = measure(1.5, 0, 0.5, 0, 1, 1e-3);
  const Faces faces = clear_slab(f_normal, 0.5);
  table.add(std::string("R, ") + clear_half, reflected(clear.normal),
            {faces.reflectance, 0, 0, "reflections summed"});
  table.add(std::string("T, ") + clear_half, transmitted(clear.normal),
            {faces.transmittance, 0, 0, "reflections summed"});
  // Thick, white, of matched index, in diffuse light.
  constexpr double tau = 100, milne = 0.710446;
  table.add("T of diffuse light, matched index, sigma_s d 100",
            transmitted(measure(1, tau, 0, 0, 1, 1.5e-4).diffuse),
            {4.0 / 3 / (tau + 2 * milne), 0, 0,
             "diffusion with Milne's extrapolation length (Hopf 1934)"});
  return table;
}

}  // namespace translucube::accuracy

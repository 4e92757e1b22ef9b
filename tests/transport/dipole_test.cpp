// The paper's model: the dipole against its closed forms, its sampling, and the ends of w.

#include "renderer/optics/dipole.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "renderer/optics/fresnel.h"
#include "renderer/optics/material_cube.h"
#include "renderer/transport/incident_point.h"
#include "tests/support/chi2.h"
#include "tests/support/meshes.h"
#include "tests/support/repository.h"
#include "tests/support/scenes.h"

namespace translucube::test {
namespace {

using std::numbers::pi;

/// Jensen's closed form (2001, section 2.4), from the albedo alone.
double diffuse_reflectance(double albedo, double ior) {
  const double internal = 1 - (1 - diffuse_fresnel_outside(ior)) / (ior * ior);
  const double a = (1 + internal) / (1 - internal), k = std::sqrt(3 * (1 - albedo));
  return albedo / 2 * (1 + std::exp(-4.0 / 3 * a * k)) * std::exp(-k);
}

TEST(DipoleProfile, IntegratesToJensensDiffuseReflectance) {
  for (const double albedo : {0.01, 0.5, 0.9, 0.99, 0.9999, 1.0})
    for (const double ior : {1.0, 1.3, 1.5, 2.5}) {
      const double sigma_t = 3;
      const DipoleProfile profile(sigma_t * (1 - albedo), sigma_t * albedo, ior);
      double sum = 0;
      constexpr int n = 4000;  // midpoints in log r
      const double low = -14, step = 34.0 / n;
      for (int i = 0; i < n; ++i) {
        const double r = std::exp(low + (i + 0.5) * step);
        sum += 2 * pi * r * r * profile.reflectance(r) * step;
      }
      const double expected = diffuse_reflectance(albedo, ior);
      EXPECT_NEAR(sum / expected, 1, 1e-3) << albedo << " " << ior;
      EXPECT_NEAR(profile.total() / expected, 1, 1e-9);
      EXPECT_NEAR(profile.within(infinity) / expected, 1, 1e-9);
      if (albedo == 1) {
        EXPECT_NEAR(expected, 1, 1e-12);
      }
    }
}

// Jensen's fit (eq. of section 2.3) of the diffuse internal reflectance, which is exact here.
TEST(DipoleProfile, BoundaryAgreesWithEganAndHilgemansFit) {
  for (const double ior : {1.2, 1.3, 1.5}) {
    const double exact = 1 - (1 - diffuse_fresnel_outside(ior)) / (ior * ior);
    const double fit = -1.440 / (ior * ior) + 0.710 / ior + 0.668 + 0.0636 * ior;
    EXPECT_NEAR(exact, fit, 0.01) << ior;
  }
}

TEST(DipoleProfile, RadiiFollowTheirDensity) {
  constexpr int samples = 20'000;
  int tests = 0;
  // Kolmogorov's distance at 1 % for the family of 36 (Sidak 1967): exp(-2 n d^2) = level / 2.
  const double level = std::sqrt(-std::log(sidak(4 * 3 * 3) / 2) / (2.0 * samples));
  for (const double sigma_a : {0.0, 1e-3, 1.0, 100.0})
    for (const double sigma_s : {1e-4, 1.0, 1e4})
      for (const double reach : {0.01, 2.0, 1e6}) {
        const DipoleProfile profile(sigma_a, sigma_s, 1.5);
        Rng rng(hash_combine(7, tests++));
        std::vector<double> radii(samples);
        for (double& r : radii) r = profile.sample(rng.uniform(), reach);
        std::ranges::sort(radii);
        double distance = 0;
        for (int i = 0; i < samples; ++i) {
          ASSERT_GE(radii[i], 0);
          ASSERT_LE(radii[i], reach);
          const double expected = profile.within(radii[i]) / profile.within(reach);
          distance = std::fmax(distance, std::fabs(expected - (i + 0.5) / samples));
        }
        EXPECT_LT(distance, level + 0.5 / samples) << sigma_a << " " << sigma_s << " " << reach;
      }
}

TEST(DipoleColor, IsTheRatioOfTheProfiles) {
  const RgbAbsorber absorber{{0.15, 1, 0.4}};
  const DipoleColor color(absorber, 3, 5, 1.5, 2);
  const DipoleProfile clear(0, 5, 1.5);
  for (int c = 0; c < 3; ++c) {
    const DipoleProfile own(3 * absorber.relative[c], 5, 1.5);
    EXPECT_NEAR(color.total()[4 * c], own.total(), 1e-6);
    for (const double r : {0.0, 0.013, 0.1, 0.37, 1.1, 1.99})
      EXPECT_NEAR(color.at(r)[4 * c], own.reflectance(r) / clear.reflectance(r), 5e-4)
          << c << " " << r;
  }
}

TEST(DipoleColor, OfAFlatSpectrumIsGrey) {
  const SpectralAbsorber flat{{380, 780}, {2, 2}};
  const DipoleColor spectral(flat, 3, 5, 1.5, 2), rgb(RgbAbsorber{}, 3, 5, 1.5, 2);
  for (const double r : {0.0, 0.1, 1.1})
    for (int k = 0; k < 9; ++k) EXPECT_NEAR(spectral.at(r)[k], rgb.at(r)[k], 2e-5) << r << " " << k;
  const DipoleColor black(RgbAbsorber{}, infinity, 5, 1.5, 2);
  for (const double r : {0.0, 1.0, 2.0})
    for (const float m : black.at(r)) EXPECT_EQ(m, 0);
}

/// The dipole alone in a white furnace: no light crosses the body, no plastic.
Scene dipole_alone(AnyShape shape, const Material& m, double reach) {
  Scene scene = body(std::move(shape), m);
  scene.interior =
      make_dipole(m, scene.interface, 1, 0.5, reach, {{m.absorber, m.coefficients.sigma_a_peak}});
  auto& dipole = std::get<DipoleInterior>(scene.interior);
  dipole.clear_share = 0;
  dipole.here = dipole.radii.local() ? dipole.here : 0;
  scene.width = scene.height = 16;
  return scene;
}

TEST(DipoleSampling, OnAFlatSurfaceBringsTheClosedForm) {
  for (const double albedo : {0.3, 0.9, 0.999, 1.0})
    for (const double alpha : {0.0, 0.3}) {
      const double sigma_t = 1e4;  // a sphere of 10,000 mean free paths
      Material m = material(1.5, alpha, sigma_t * albedo);
      m.coefficients.sigma_a_peak = sigma_t * (1 - albedo);
      Scene scene = dipole_alone(Sphere{}, m, 2);
      look_from_afar(scene, 0.01, 16);  // normal incidence
      const auto& base = std::get<DipoleInterior>(scene.interior).base;
      double let_in = 0;  // T at normal incidence: B sends back what comes in
      constexpr int n = 4000;
      for (int i = 0; i < n; ++i) {
        const double mu = (i + 0.5) / n;
        let_in += 2 * pi / n * base.transmittance(1) * base.emit({0, 0, mu}).f_cos;
      }
      const double expected =
          1 - let_in + let_in * base.entering() * diffuse_reflectance(albedo, 1.5);
      const Measured e = image_mean(trace(scene, 1024));
      EXPECT_NEAR(e.mean, expected, 4 * e.standard_error + 1e-3)
          << albedo << " alpha " << alpha << " +- " << e.standard_error;
      EXPECT_LT(e.standard_error, 3e-3);
    }
}

TEST(DipoleSampling, OfATessellatedSphereIsThatOfTheSphere) {
  for (const double sigma_s : {0.3, 3.0, 50.0}) {
    Material m = material(1.5, 0, sigma_s);
    m.coefficients.sigma_a_peak = 0.2;
    m.absorber = RgbAbsorber{{0.1, 1, 1}};
    Scene sphere = dipole_alone(Sphere{}, m, 2),
          mesh = dipole_alone(build_mesh(icosphere(5)).mesh, m, 2);
    look_from_afar(sphere, 0.5, 16);
    look_from_afar(mesh, 0.5, 16);
    const Measured a = image_mean(trace(sphere, 1024)), b = image_mean(trace(mesh, 1024));
    EXPECT_NEAR(a.mean, b.mean, 4 * std::hypot(a.standard_error, b.standard_error) + 1e-3)
        << sigma_s;
  }
}

TEST(DipoleSampling, OfAPlateSeesBothItsFaces) {
  // Light comes out of a face that went in at both: the near face brings within(reach), the far one
  // the rest of the ball of that radius.
  const double reach = 40;
  Scene scene = dipole_alone(wide_plate(), material(1.5, 0, 2), reach);
  look_from_afar(scene, 0.1, 16);
  const auto& dipole = std::get<DipoleInterior>(scene.interior);
  double both = dipole.radii.mass();
  constexpr int n = 20'000;  // midpoints in log of the distance from 1 to reach
  for (int i = 0; i < n; ++i) {
    const double r = std::exp((i + 0.5) / n * std::log(reach));
    both += 2 * pi * r * r * dipole.radii.reflectance(r) * std::log(reach) / n;
  }
  const Measured e = image_mean(trace(scene, 4096));
  const double f = fresnel(1, 1.5);
  EXPECT_NEAR(e.mean, f + (1 - f) * dipole.base.entering() * both, 4 * e.standard_error + 1e-4);
}

// ---- the whole model

SceneSpec sphere_spec(double scattering, double absorption, double roughness) {
  SceneSpec spec;
  spec.material.coefficients = from_cube({absorption, roughness, scattering}, 0, 10);
  spec.material.absorber = RgbAbsorber{{0.15, 1, 1}};
  spec.model = DipoleModel{scattering};
  spec.environment.source = ImageEnvironmentSpec{in_repository("config/environments/forest.exr")};
  spec.width = spec.height = 48;
  return spec;
}

SceneSpec exactly(SceneSpec spec) {
  spec.model = ExactTransport{};
  return spec;
}

Film traced(const SceneSpec& spec, std::uint32_t samples, int threads = 0) {
  return trace(*build_scene(spec), samples, threads);
}

TEST(DipoleModel, OfAnEmptyOrBlackBodyIsTheTransport) {
  for (const double roughness : {0.0, 0.5}) {
    const SceneSpec empty = sphere_spec(0, 0.4, roughness), black = sphere_spec(0.5, 1, roughness);
    EXPECT_EQ(traced(empty, 16).sum, traced(exactly(empty), 16).sum);
    EXPECT_EQ(traced(black, 16).sum, traced(exactly(black), 16).sum);
  }
  EXPECT_EQ(transport_name(*build_scene(sphere_spec(0.5, 0.5, 0))), "dipole");
}

TEST(DipoleModel, HasNoJumpAtTheEmptyBody) {
  SceneSpec spec = sphere_spec(1e-7, 0.4, 0.3);
  const Measured thin = image_mean(traced(spec, 256));
  spec.material.coefficients.sigma_s = 0;
  const Measured empty = image_mean(traced(spec, 256));
  EXPECT_NEAR(thin.mean, empty.mean, 4 * std::hypot(thin.standard_error, empty.standard_error));
}

TEST(DipoleModel, EndsInTheOpaquePlastic) {
  for (const double roughness : {0.0, 0.5}) {
    SceneSpec spec = sphere_spec(1, 0, roughness);
    const Measured dipole = image_mean(traced(spec, 512)),
                   exact = image_mean(traced(exactly(spec), 512));
    EXPECT_NEAR(dipole.mean, exact.mean,
                4 * std::hypot(dipole.standard_error, exact.standard_error));
    const Measured almost = image_mean(traced(sphere_spec(0.9999, 0, roughness), 512));
    EXPECT_NEAR(almost.mean / dipole.mean, 1, 5e-3);
  }
}

TEST(DipoleModel, IsFiniteAtAnyDensityAndIndex) {
  for (const double density : {1e-300, 1e-30, 1e-6, 1e-3, 1.0, 1e3, 1e6, 1e12, 1e18})
    for (const double absorption : {0.0, 1e-6, 1.0, 1e6, 1e18})
      for (const double ior : {1.0, 1.0001, 4.0}) {
        Material m = material(ior, 0, density);
        m.coefficients.sigma_a_peak = absorption;
        m.absorber = RgbAbsorber{{0, 0.5, 1}};
        for (const bool mesh : {false, true}) {
          Scene scene =
              body(mesh ? AnyShape{build_mesh(box({1, 1, 1})).mesh} : AnyShape{Sphere{}}, m);
          scene.interior = make_dipole(m, scene.interface, 1, 0.3, 2, {{m.absorber, absorption}});
          scene.lanes = {make_lane(m.absorber, absorption)};
          look_from_afar(scene, 0.7, 8);
          const Film film = trace(scene, 8);
          ASSERT_EQ(film.counters.nan_samples, 0u)
              << density << " " << absorption << " " << ior << " " << mesh;
          for (const float p : film.sum) ASSERT_TRUE(std::isfinite(p) && p >= 0);
        }
      }
}

TEST(DipoleModel, LanesAreTheRendersOfTheirAbsorbers) {
  SceneSpec spec = sphere_spec(0.4, 0.2, 0.3);
  const Absorption more{RgbAbsorber{{1, 0.3, 0.1}}, 0.2};
  spec.more_absorptions = {more};
  const Film both = traced(spec, 8);
  spec.more_absorptions.clear();
  const Film first = traced(spec, 8);
  spec.material.absorber = more.absorber;
  spec.material.coefficients.sigma_a_peak = more.sigma_a_peak;
  const Film second = traced(spec, 8);
  EXPECT_EQ(develop(both, 0).pixels, develop(first).pixels);
  EXPECT_EQ(develop(both, 1).pixels, develop(second).pixels);
}

TEST(DipoleModel, StaysBoundedWhereBodiesLightThemselves) {
  // A concave body and a model that gains energy.
  const BuiltMesh built = build_mesh(knot(96, 24, 0.35));
  for (const double w : {0.1, 0.5}) {
    Scene scene = body(built.mesh, material(1.5, 0, 4));
    scene.interior =
        make_dipole(material(1.5, 0, 4), scene.interface, 1, w, 2, {{RgbAbsorber{}, 0}});
    look_from_afar(scene, 1, 24);
    const Film film = trace(scene, 32);
    EXPECT_EQ(film.counters.nan_samples, 0u);
    EXPECT_LT(film.counters.truncated_energy / double(film.counters.camera_samples), 1e-3);
    EXPECT_LT(film.counters.boundary_events, 200 * film.counters.camera_samples);
    EXPECT_LT(image_mean(film).mean, 6);
  }
}

TEST(DipoleModel, RefusesACameraInside) {
  SceneSpec spec = sphere_spec(0.5, 0, 0);
  spec.camera.position_mm = {0, 0, 5};
  EXPECT_THROW(build_scene(spec), SceneError);
}

// Not conserving energy is the model's own error: reported here, asserted nowhere.
TEST(DipoleModel, ReportsItsErrorAgainstTheTransport) {
  std::printf("     s   white furnace   luminance over the transport's\n");
  for (const double s : {0.0, 0.05, 0.25, 0.6, 1.0}) {
    SceneSpec spec = sphere_spec(s, 0, 0);
    const double ratio =
        image_mean(traced(spec, 128)).mean / image_mean(traced(exactly(spec), 128)).mean;
    Scene furnace = *build_scene(spec);
    furnace.environment = UniformEnvironment{};
    look_from_afar(furnace, 0.7, 24);
    const Measured gained = image_mean(trace(furnace, 256));
    std::printf("  %4.2f   %.4f +- %.4f   %.3f\n", s, gained.mean, gained.standard_error, ratio);
    EXPECT_TRUE(std::isfinite(gained.mean) && std::isfinite(ratio));
    if (s == 0 || s == 1) {
      EXPECT_NEAR(gained.mean, 1, 4 * gained.standard_error + 1e-3);
    }
  }
}

}  // namespace
}  // namespace translucube::test

// The opaque end of the scattering axis: the interfaced Lambertian body, and the dense half space
// below it.

#include <functional>
#include <limits>
#include <numbers>

#include "tests/bench/accuracy/sections.h"
#include "tests/support/truths.h"

namespace translucube::accuracy {

using namespace test;
using std::numbers::pi;

namespace {

/// Chandrasekhar's H function for isotropic scattering without absorption (Chandrasekhar 1950,
/// "Radiative Transfer", section 37): 1/H(mu) = 1/2 int x H(x) / (mu + x) dx, by iteration.
class ChandrasekharH {
 public:
  ChandrasekharH() : h_(nodes, 1.0) {
    for (int iteration = 0; iteration < 300; ++iteration) {
      std::vector<double> next(nodes);
      // The mean of two iterates: one alone closes in on H too slowly where nothing absorbs.
      for (int i = 0; i < nodes; ++i) next[i] = 0.5 * (h_[i] + at((i + 0.5) / nodes));
      h_ = next;
    }
  }
  double at(double mu) const {
    double sum = 0;
    for (int i = 0; i < nodes; ++i) {
      const double x = (i + 0.5) / nodes;
      sum += x * h_[i] / (mu + x) / nodes;
    }
    return 2 / sum;
  }

 private:
  static constexpr int nodes = 400;
  std::vector<double> h_;
};

/// Mean radiance of a unit sphere, seen along -z, under light 1 from within a cone about +z.
/// `f_cos(mu_o, mu_i)`: BRDF times the cosine of incidence, whatever the azimuth.
double lit_sphere(double cone_cosine, const std::function<double(double, double)>& f_cos) {
  constexpr int rings = 64, polar = 128, azimuths = 128;
  double mean = 0;
  for (int i = 0; i < rings; ++i) {
    const double mu = std::sqrt((i + 0.5) / rings);  // equal areas of the disc
    const double sine = std::sqrt(1 - mu * mu);
    for (int j = 0; j < polar; ++j) {
      const double z = cone_cosine + (1 - cone_cosine) * (j + 0.5) / polar;
      const double r = std::sqrt(1 - z * z);
      for (int k = 0; k < azimuths; ++k) {
        const double cos_i = mu * z + sine * r * std::cos(2 * pi * (k + 0.5) / azimuths);
        if (cos_i > 0) mean += f_cos(mu, cos_i);
      }
    }
  }
  return mean * 2 * pi * (1 - cone_cosine) / (double(rings) * polar * azimuths);
}

/// Radiance 1 from within a cone about +z, its edge smoothed over a pixel.
ImageEnvironment cone_light(double cone_cosine) {
  constexpr int sub = 8;
  Image image(1024, 512);
  for (int y = 0; y < image.height; ++y)
    for (int x = 0; x < image.width; ++x) {
      int lit = 0;
      for (int s = 0; s < sub * sub; ++s) {
        const double theta = pi * (y + (s / sub + 0.5) / sub) / image.height;
        const double phi = 2 * pi * (0.5 - (x + (s % sub + 0.5) / sub) / image.width);
        lit += std::sin(theta) * std::cos(phi) > cone_cosine;
      }
      for (int c = 0; c < 3; ++c)
        image.pixels[3 * (std::size_t(y) * image.width + x) + c] =
            static_cast<float>(lit) / (sub * sub);
    }
  return ImageEnvironment(image, 0, 1);
}

}  // namespace

Table interfaced_lambertian(Run& run) {
  Table table{"lambertian", "The opaque end",
              "At s = 1 the body is an interfaced Lambertian one (Elias, Simonot, Menu 2001). Just "
              "below, it is a half space of isotropic scatterers, whose light follows "
              "Chandrasekhar's H function and not Lambert's law. Both keep all energy, but the "
              "picture steps at s = 1: mean radiance over a sphere lit by the half of the sky "
              "behind the camera, or from within 30 degrees of it; the ratio is the step. "
              "Without an interface (ior 1) both have exact values."};
  const ChandrasekharH h;
  const auto chandrasekhar = [&h, table = std::vector<double>()](double mu, double mu_i) mutable {
    constexpr int n = 1024;
    if (table.empty())
      for (int i = 0; i <= n; ++i) table.push_back(h.at(std::fmax(1e-9, double(i) / n)));
    const auto value = [&](double x) {
      const int i = std::min(static_cast<int>(x * n), n - 1);
      return table[i] + (x * n - i) * (table[i + 1] - table[i]);
    };
    return value(mu) * value(mu_i) * mu_i / (4 * pi * (mu + mu_i));
  };
  const auto lambert = [](double, double mu_i) { return mu_i / pi; };
  for (const double cone : {0.0, std::cos(pi / 6)})
    for (const auto& [ior, alpha] : {std::pair{1.0, 0.0}, {1.5, 0.0}, {1.5, 0.3}}) {
      const std::string row =
          text("%s, ior %g, alpha %g", cone == 0 ? "half the sky" : "30 degrees", ior, alpha);
      const auto look = [&](double sigma_s) {
        Scene scene = body(Sphere{}, material(ior, alpha, sigma_s), run.next_seed());
        scene.environment = cone == 0 ? half_space_light(true) : cone_light(cone);
        look_from_afar(scene, 1.0, 64);
        return over_the_disc(image_mean(trace(scene, run.samples(192), run.threads())), 0);
      };
      const Measured dense = look(1e5), opaque = look(std::numeric_limits<double>::infinity());
      std::optional<Truth> dense_truth, opaque_truth;
      if (ior == 1) {
        dense_truth = Truth{lit_sphere(cone, chandrasekhar), 0, 0, "Chandrasekhar 1950"};
        opaque_truth = Truth{lit_sphere(cone, lambert), 0, 0, "Lambert"};
      }
      table.add_column(row, "sigma_s R = 1e5", dense, dense_truth);
      table.add_column(row, "s = 1", opaque, opaque_truth);
      const double ratio = dense.mean / opaque.mean;
      table.add_column(row, "ratio",
                       {ratio, ratio * std::hypot(dense.standard_error / dense.mean,
                                                  opaque.standard_error / opaque.mean)});
    }
  return table;
}

}  // namespace translucube::accuracy

#pragma once

#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "renderer/base/vec.h"

namespace translucube {

/// Absorption relative to its largest channel, one value a channel: plain RGB Beer-Lambert.
struct RgbAbsorber {
  std::array<double, 3> relative{1, 1, 1};  ///< >= 0, at least one > 0
  friend bool operator==(const RgbAbsorber&, const RgbAbsorber&) = default;
};

/// Absorption spectrum relative to its peak; linear between samples, constant beyond the ends.
struct SpectralAbsorber {
  std::vector<double> wavelengths_nm;  ///< strictly rising
  std::vector<double> values;          ///< same size, >= 0, at least one > 0
  friend bool operator==(const SpectralAbsorber&, const SpectralAbsorber&) = default;
};

using Absorber = std::variant<RgbAbsorber, SpectralAbsorber>;

/// An absorber and its density.
struct Absorption {
  Absorber absorber;
  double sigma_a_peak = 0;  ///< [1/mm], may be +infinity
};

/// The absorber at a wavelength, relative to its peak.
double relative_absorption(const SpectralAbsorber& absorber, double wavelength_nm);

/// A point of the translucency cube, each coordinate in [0, 1] (Gerardin et al. 2019).
struct CubePoint {
  double absorption = 0, roughness = 0, scattering = 0;
  friend bool operator==(const CubePoint&, const CubePoint&) = default;
};

/// The achromatic optical coefficients of a body.
struct Coefficients {
  double sigma_a_peak = 0;  ///< absorption at the absorber's peak [1/mm], may be +infinity
  double alpha = 0;         ///< GGX slope roughness of the interface, [0, 1]
  double sigma_s = 0;       ///< scattering [1/mm], may be +infinity
  friend bool operator==(const Coefficients&, const Coefficients&) = default;
};

/// A film of matching index over the part of the surface where dot(p, normal) >= offset_mm: there
/// the boundary is smooth, whatever the body's roughness, and nothing else changes.
struct OilFilm {
  Vec3 normal{1, 0, 0};  ///< unit
  double offset_mm = 0;
};

/// Everything optical about a body.
struct Material {
  Coefficients coefficients;
  double g = 0;      ///< Henyey-Greenstein mean cosine, (-1, 1)
  double ior = 1.5;  ///< index of the body relative to the vacuum around it, [1, 4]
  Absorber absorber;
  /// Pigments: the scatterers are the absorbers, sigma_a(lambda) = sigma_s x this x k(lambda), and
  /// coefficients.sigma_a_peak says the same. As sigma_s grows without bound the albedo stays.
  std::optional<double> absorption_per_scattering;
  std::optional<OilFilm> oil_film;
  /// Between microfacets (Heitz et al. 2016); without it a rough interface loses light.
  bool multiple_scattering = true;
};

}  // namespace translucube

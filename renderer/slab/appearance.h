#pragma once

// The optics of a material as a flat slab, infinite across, with its interface on both faces: what
// instruments for plastics, glass and paint measure of it. In this room stands all that takes,
// walks of light, adding and doubling, closed forms, in translucube::slab; it knows no scene.

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "renderer/optics/material.h"

namespace translucube {

/// Wavelength bands of equal width from 380 to 780 nm.
inline constexpr int slab_bands = 20;
inline constexpr double slab_band_width_nm = 20;

/// The light that a slab sends one way, for white light (D65) of irradiance 1.
struct SlabLight {
  /// Linear Rec.709 R, G, B. `direct` met no scatterer and only smooth faces: "specular" where
  /// reflected, "regular" where transmitted, each to any number of reflections between the faces.
  /// Behind rough faces all light is diffuse, however narrow: haze and clarity tell how narrow.
  std::array<double, 3> direct{}, diffuse{}, total{};
  std::array<double, 3> xyz{};  ///< CIE 1931, 2 degrees, of the total; Y = 1: all of the light
  std::array<double, 3> lab{};  ///< CIE 1976 L*, a*, b* of the total under D65
  /// Total by wavelength: means over the slab_bands. Empty where the absorber is
  /// given by R, G, B.
  std::vector<double> bands;
};

struct SlabOptics {
  SlabLight reflected, transmitted;
};

struct SlabAppearance {
  struct Estimate {
    double value = 0, standard_error = 0;
  };
  struct AtIncidence {
    SlabOptics value, standard_error;
  };
  AtIncidence normal;   ///< collimated, along the normal
  AtIncidence diffuse;  ///< Lambertian over the hemisphere

  // At normal incidence, by luminance under D65; empty where (next to) nothing is transmitted.
  /// ASTM D1003: share of the transmitted light more than 2.5 degrees off the incident direction.
  std::optional<Estimate> haze;
  /// (C - R) / (C + R) with C the light within 0.5 degrees of the incident direction and R that in
  /// the ring from there to 2.5 degrees: the form of the BYK haze-gard's clarity, whose apertures
  /// are the maker's own. 1: no small-angle scattering; -0.92: light spread evenly over both.
  std::optional<Estimate> clarity;

  std::uint64_t samples = 0;          ///< histories over both incidences, or paths through faces
  double largest_standard_error = 0;  ///< of all totals (R, G, B)
  double seconds = 0;
  /// "interface", "clear", "walk", "adding-doubling" (adding.h) or "interfaced-lambertian"
  std::string transport;
};

/// Traces until the standard error of every total is `standard_error` or less. The bits depend on
/// the seed, not on the number of threads (0: all cores). Expects thickness_mm and standard_error
/// > 0. Throws std::runtime_error if a result is not finite: a bug.
SlabAppearance slab_appearance(const Material& material, double thickness_mm, double standard_error,
                               std::uint64_t seed, int threads);

/// CIE 1976 L*, a*, b* (CIE 15:2018, section 8.2.1) of XYZ relative to a white.
std::array<double, 3> cielab(const std::array<double, 3>& xyz, const std::array<double, 3>& white);

}  // namespace translucube

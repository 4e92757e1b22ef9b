#pragma once

// Absorption is developed, not traced: a path has a radiance L and a length l inside the body, and
// a lane of the film applies one absorber to (L, l).

#include <array>
#include <cmath>
#include <utility>
#include <variant>

#include "renderer/base/color_operator.h"
#include "renderer/base/vec.h"
#include "renderer/optics/interior.h"
#include "renderer/optics/material.h"

namespace translucube {

/// Nothing absorbs.
struct ClearLane {
  Rgb apply(Rgb radiance, double) const { return radiance; }
};

/// exp(-sigma_a l) for each channel.
struct RgbLane {
  std::array<float, 3> sigma_a{};  ///< [1 / unit of l]

  Rgb apply(Rgb radiance, double length) const {
    const auto l = static_cast<float>(length);
    return {radiance.r * std::exp(-sigma_a[0] * l), radiance.g * std::exp(-sigma_a[1] * l),
            radiance.b * std::exp(-sigma_a[2] * l)};
  }
};

/// The 3 x 3 operator M(l) = integral of cmf_i(lambda) B_c(lambda) exp(-sigma_a(lambda) l), from
/// RGB to RGB, with B_c the illuminant-weighted basis spectra of spectrum.h; M(0) is the identity.
/// Tabulated over 1 + sigma_peak l (ColorOperatorTable): error below 3e-5 of the
/// clear value.
class SpectralLane {
 public:
  /// `sigma_a_peak` [1 / unit of l] >= 0.
  SpectralLane(const SpectralAbsorber& absorber, double sigma_a_peak);
  /// Any operator, over 1 + sigma_a_peak l.
  SpectralLane(double sigma_a_peak, ColorOperatorTable table)
      : sigma_a_peak_(sigma_a_peak), table_(std::move(table)) {}

  Rgb apply(Rgb radiance, double length) const {
    return apply_operator(table_.at(1 + sigma_a_peak_ * length), radiance);
  }
  double sigma_a_peak() const { return sigma_a_peak_; }
  /// The operators over 1 + sigma_a_peak l.
  const ColorOperatorTable& table() const { return table_; }

 private:
  double sigma_a_peak_;
  ColorOperatorTable table_;
};

/// Infinite density: what was inside the body is gone.
struct OpaqueLane {
  Rgb apply(Rgb radiance, double length) const { return length > 0 ? Rgb{0, 0, 0} : radiance; }
};

using Lane = std::variant<ClearLane, RgbLane, SpectralLane, OpaqueLane>;

/// The lane of an absorber. `sigma_a_peak` [1 / unit of l] >= 0, may be infinite.
Lane make_lane(const Absorber& absorber, double sigma_a_peak);
/// The material's lane in the lengths that the interior's paths bring.
Lane make_lane(const Material& material, const AnyInterior& interior, double unit_mm);

}  // namespace translucube

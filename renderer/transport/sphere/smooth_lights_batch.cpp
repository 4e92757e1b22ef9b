#include "renderer/transport/sphere/smooth_lights_batch.h"

#include <numbers>

// This file is compiled once for each instruction set: the order matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/transport/sphere/smooth_lights_batch.cpp"
#include <hwy/foreach_target.h>
#include "renderer/transport/sphere/smooth_exits_simd.h"
#include "renderer/transport/sphere/sphere_simd.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

/// About what leaves towards a light, by the cosine between it and the vertex's outward radius: in
/// proportion to the cosine next to the surface, the same in all directions from the centre; hardly
/// anything beyond the end of the branch.
struct Worth {
  Real end, scale, offset;

  HWY_INLINE Worth(Real n, Real rho) : end(Plane(n, rho, false).end().c) {
    const Real rho2 = rho * rho, cosine_part = rho2 * rho2;
    scale = cosine_part / (Real(1) - end);
    offset = fnma(scale, end, Real(1) - cosine_part);
  }
  HWY_INLINE Real of(Real cosine) const {
    constexpr float least = 0.01f;
    return max(least, select(cosine > end, fma(scale, cosine, offset), least));
  }
};

/// Directions turned about an axis.
struct Turning {
  Vector axis;

  /// Those of v that add up to v turned: `along` the axis, cos x `across`, sin x `ahead`.
  struct Parts {
    Vector along, across, ahead;

    /// Cosine between v, turned, and w.
    HWY_INLINE Real dot_turned(Turn angle, Vector w) const {
      return fma(angle.c, dot(across, w), fma(angle.s, dot(ahead, w), dot(along, w)));
    }
  };
  HWY_INLINE Parts parts_of(Vector v) const {
    const Vector along = dot(axis, v) * axis;
    return {along, v - along, cross(axis, v)};
  }
  HWY_INLINE Vector back(Turn angle, Vector w) const {
    const Real along = dot(axis, w) * (Real(1) - angle.c);
    return fma(along, axis, fnma(angle.s, cross(axis, w), angle.c * w));
  }
};

/// Which of the candidates was drawn, in proportion to their values.
struct Choice {
  Real candidate, value;

  /// `wanted`: the sum of all values times a number uniform in [0, 1].
  HWY_INLINE Choice(const std::array<Real, LightStrata::candidates>& values, Real wanted)
      : candidate(0), value(values[0]) {
    Real below = 0;
    for (std::size_t j = 1; j < values.size(); ++j) {
      below = below + values[j - 1];
      const Mask passed = wanted >= below;
      candidate = select(passed, static_cast<float>(j), candidate);
      value = select(passed, values[j], value);
    }
  }
};

void ChooseLights(const SmoothExitMedium& medium, const LightStrata& lights, std::size_t position,
                  SmoothExitBatch& batch) {
  constexpr std::uint32_t candidates = LightStrata::candidates, positions = LightStrata::positions,
                          stride = LightStrata::stride;
  std::array<Real, candidates> values;
  for (std::size_t i = 0; i < batch.size; i += at_once) {
    const Vertex vertex(batch, i);
    const Turning turning{load(batch.axis, i)};
    const Turning::Parts up = turning.parts_of(vertex.up);
    const Real angle = Real(2 * pi_f) * load(batch.turn, i);
    const Turn start{cos(angle), sin(angle)};
    const Worth worth(medium.ior, vertex.rho);
    const std::size_t at = (position + i) % positions;
    Real sum = 0;
    for (std::size_t j = 0; j < candidates; ++j) {
      const Turn turned = start + Turn{lights.cos_turn[j], lights.sin_turn[j]};
      const Vector light = load(lights.direction, j * stride + at);
      values[j] = worth.of(up.dot_turned(turned, light));
      sum = sum + values[j];
    }
    const Choice choice(values, sum * load(batch.choice, i));
    const Bits stratum = to_whole(choice.candidate), place = counting(at) & Bits(positions - 1);
    const Turn turned =
        start + Turn{load(lights.cos_turn, stratum), load(lights.sin_turn, stratum)};
    const Vector light = load(lights.direction, stratum * Bits(stride) + place);
    store(turning.back(turned, light), batch.light, i);
    store(stratum * Bits(positions) + place, batch.chosen, i);
    store(load(batch.light_pdf, i) * (choice.value * Real(float(candidates)) / sum),
          batch.light_pdf, i);
  }
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace translucube {

HWY_EXPORT(ChooseLights);

LightStrata::LightStrata() {
  for (std::size_t j = 0; j < candidates; ++j) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(j) / double(candidates);
    cos_turn[j] = static_cast<float>(std::cos(angle));
    sin_turn[j] = static_cast<float>(std::sin(angle));
  }
}

void LightStrata::set(std::size_t i, Vec3 direction_of_light) {
  const std::size_t begin = i / positions * stride, end = begin + stride;
  for (std::size_t at = begin + i % positions; at < end; at += positions)
    direction.set(at, direction_of_light);
}

void choose_lights(const SmoothExitMedium& medium, const LightStrata& lights, std::size_t position,
                   SmoothExitBatch& batch) {
  HWY_DYNAMIC_DISPATCH(ChooseLights)(medium, lights, position, batch);
}

}  // namespace translucube
#endif

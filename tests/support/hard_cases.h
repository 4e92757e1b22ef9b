#pragma once

// The hard cases of docs/design.md section 6, in white furnaces: the right answer is 1 whatever the
// body.

#include <cstdint>

#include "renderer/scene/spec.h"

namespace translucube::test {

/// The request's scene under white light: a sphere of this radius that fills the image.
inline SceneSpec hard_furnace(double radius_mm, double alpha, double sigma_s, double ior,
                              double g) {
  SceneSpec spec;
  spec.material.coefficients = {0, alpha, sigma_s};
  spec.material.ior = ior;
  spec.material.g = g;
  spec.object = SphereObject{radius_mm};
  spec.camera.position_mm = {0, 0, 4.5 * radius_mm};
  spec.camera.vfov_deg = 15;
  spec.width = spec.height = 16;
  return spec;
}

struct HardCase {
  const char* name;
  double radius_mm, alpha, sigma_s, ior, g;  ///< sigma_s [1/mm]
  std::uint32_t samples;                     ///< for a standard error below 5e-3
};

inline constexpr HardCase hard_cases[] = {
    {"alpha_1e_4", 1, 1e-4, 0, 1.5, 0, 256},
    {"alpha_1", 1, 1, 0, 1.5, 0, 256},
    {"alpha_1_dense", 1, 1, 100, 1.5, 0, 128},
    {"no_step_of_the_index", 1, 0.5, 10, 1, 0, 256},
    {"index_1_0001", 1, 0, 10, 1.0001, 0, 256},
    {"index_1_0001_rough", 1, 0.5, 10, 1.0001, 0, 256},
    {"index_4", 1, 0.2, 10, 4, 0, 512},
    {"thin_as_air", 1, 0, 1e-6, 1.5, 0, 64},
    {"a_million_mean_free_paths", 1, 0, 1e6, 1.5, 0, 128},
    {"a_million_mean_free_paths_rough", 1, 0.3, 1e6, 1.5, 0, 128},
    {"denser_than_any_matter", 20, 0, 1e15, 1.5, 0, 64},
    {"forward_0_99", 1, 0, 100, 1.5, 0.99, 128},
    {"backward_0_99", 1, 0, 100, 1.5, -0.99, 64},
    {"a_micrometre", 1e-3, 0.1, 1e4, 1.5, 0, 128},
    {"a_kilometre", 1e6, 0.1, 1e-5, 1.5, 0, 128}};

}  // namespace translucube::test

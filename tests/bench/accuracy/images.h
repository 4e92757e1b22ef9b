#pragma once

// The peers' scene (Cycles, Mitsuba 0.6, pbrt-v4) and what is read of its images.

#include <array>

#include "renderer/render.h"
#include "tests/support/scenes.h"

namespace translucube::accuracy {

/// A sphere of 1 mm in the forest; absorption is red (0.15, 1, 1).
SceneSpec peer_scene(const Coefficients& coefficients, int size, std::uint64_t seed);

/// Mean of each channel over all pixels.
std::array<test::Estimate, 3> channel_means(const Film& film);
test::Estimate mean_luminance(const Film& film);

/// Mean (x - ref)^2 / (ref^2 + 0.01), less what the noise of both images brings to it; the ref of
/// the denominator is smoothed over 5 x 5 pixels, so that noise cannot flatter it. The standard
/// error is that of the noise. None of the pixels is set aside.
test::Estimate rel_mse(const Film& film, const Film& reference);

}  // namespace translucube::accuracy

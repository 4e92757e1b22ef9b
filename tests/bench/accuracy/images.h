#pragma once

// What the report reads of images, of the peers' scene above all.

#include "tests/support/peers.h"

namespace translucube::accuracy {

using test::channel_means;
using test::peer_scene;

test::Measured mean_luminance(const Film& film);

/// Mean (x - ref)^2 / (ref^2 + 0.01), less what the noise of both images brings to it; the ref of
/// the denominator is smoothed over 5 x 5 pixels, so that noise cannot flatter it. The standard
/// error is that of the noise. None of the pixels is set aside.
test::Measured rel_mse(const Film& film, const Film& reference);

}  // namespace translucube::accuracy

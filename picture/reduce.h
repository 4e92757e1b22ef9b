#pragma once

#include "picture/image.h"

namespace translucube {

/// The picture at a smaller size: every pixel is the mean over its area (box filter), which is
/// right for linear light only. The same size gives the same values. Asserts 1 <= width <=
/// picture.width and likewise for the height.
Image reduce(const Image& picture, int width, int height);

}  // namespace translucube

#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "renderer/base/color_operator.h"

namespace translucube {

/// Pixels developed at once: their sums and one bin's halves stay in the L1 cache.
inline constexpr std::size_t pixels_at_once = 1024;

/// The light of up to pixels_at_once pixels through the operators, one for each bin, added up:
/// R, G, B of each pixel to `developed`. `halves`: red of the first pixel in the first bin; each
/// channel of each bin lies `plane` halves behind the one before it. The bits do not depend on the
/// instruction set.
void develop_halves(std::span<const ColorOperator> operators, const std::uint16_t* halves,
                    std::size_t plane, std::size_t pixels, float* developed);

}  // namespace translucube

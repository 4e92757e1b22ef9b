#pragma once

#include "picture/sheet/contact_sheet.h"
#include "picture/sheet/text.h"
#include "tests/bench/figures/figure.h"

namespace translucube::figures {

/// The cube in perspective, with a ball at each lattice point: columns to the right, rows into the
/// depth, layers upwards. The pictures show a ball that touches their borders.
Image draw_cube(const Figure& figure, const Pictures& pictures, const SheetLook& look,
                const Font& font);

}  // namespace translucube::figures

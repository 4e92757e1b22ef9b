#include "renderer/optics/ball_tables.h"

#include <cassert>

// The file that make_ball_tables wrote while the project was built.
asm(R"(
  .section .rodata
  .balign 64
  .global translucube_ball_exits
translucube_ball_exits:
  .incbin ")" TRANSLUCUBE_BALL_TABLES R"("
  .section .text
)");
extern "C" const translucube::BallExit translucube_ball_exits[];

namespace translucube {

const BallExit* ball_exits() { return translucube_ball_exits; }

BallCrossing cross_ball(int level, Rng& rng) {
  assert(level >= 0 && level < ball_levels);
  const int table = std::min(level, tabulated_levels - 1);
  BallCrossing crossing =
      cross_ball({ball_exits() + std::size_t(table) * exits_per_ball, exits_per_ball}, rng);
  crossing.length *= mean_ball_length(level) / mean_ball_length(table);
  return crossing;
}

}  // namespace translucube

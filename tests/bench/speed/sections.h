#pragma once

// The sections of docs/speed.md, each measured by one function.

#include <vector>

#include "tests/bench/speed/figures.h"

namespace translucube::speed {

using Tables = std::vector<Table>;

Tables materials(Run& run);
Tables single_scattering(Run& run);
Tables error_against_time(Run& run);
Tables density(Run& run);
Tables lanes(Run& run);
Tables sweeps(Run& run);
Tables cores(Run& run);
Tables pixels(Run& run);
/// What a render of this size holds beyond a tiny one of the same scene [bytes], in a process that
/// has rendered nothing else.
double film_memory(int size, int lanes, int threads);
Tables meshes(Run& run);
Tables bodies(Run& run);
Tables latency(Run& run);
Tables stopping(Run& run);
Tables hard_sun(Run& run);
Tables profile(Run& run);
/// Renders run.materials, for the tools that look at this program from outside.
void render_to_profile(const Run& run, int size);
Tables cycles(Run& run);

}  // namespace translucube::speed

#pragma once

// The tables of docs/accuracy.md, each measured by one function.

#include "tests/bench/accuracy/figures.h"

namespace translucube::accuracy {

Table white_furnaces(Run& run);
Table single_scattering(Run& run);
Table hard_cases(Run& run);
Table mean_path_lengths(Run& run);
Table walks(Run& run);
Table slabs(Run& run);
Table slab_appearances(Run& run);
Table image_means(Run& run);
Table microsurfaces(Run& run);
Table explorable_films(Run& run);
Table interfaced_lambertian(Run& run);
Table dipole(Run& run);

}  // namespace translucube::accuracy

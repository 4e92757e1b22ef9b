#pragma once

#include <string>
#include <vector>

#include "tests/bench/figures/figure.h"

namespace translucube::figures {

/// docs/figures/README.md: every figure with its caption, where its request is, and what to see.
std::string document(const std::vector<Figure>& figures);

}  // namespace translucube::figures

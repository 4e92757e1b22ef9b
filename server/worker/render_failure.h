#pragma once

#include <stdexcept>
#include <utility>

#include "api/base/problem.h"

namespace translucube::server {

/// The render cannot be made: it fails for good, with what its user is told.
struct RenderFailure : std::runtime_error {
  api::Problem problem;
  explicit RenderFailure(api::Problem p) : std::runtime_error(p.detail), problem(std::move(p)) {}
};

}  // namespace translucube::server

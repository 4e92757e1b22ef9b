#pragma once

// Why a store takes no render or sweep, or fails one; every store answers so.

#include "api/base/problem.h"

namespace translucube::server {

inline api::Problem idempotency_mismatch() {
  return {api::ProblemCode::idempotency_mismatch,
          "This Idempotency-Key came before, with another request.",
          {}};
}

inline api::Problem ended_the_process() {
  return {
      api::ProblemCode::internal, "The renderer process ended twice while it worked on this.", {}};
}

inline api::Problem queue_full() {
  return {api::ProblemCode::queue_full, "The queue has no room for this; try again later.", {}};
}

}  // namespace translucube::server

#include "server/service/answers.h"

namespace translucube::server {

using api::Problem;
using api::ProblemCode;

std::optional<Problem> no_picture(api::JobState state) {
  switch (state) {
    case api::JobState::queued:
    case api::JobState::running:
      return Problem{ProblemCode::not_ready, "The render is not finished yet.", {}};
    case api::JobState::failed:
      return Problem{ProblemCode::conflict, "The render failed: it has no image.", {}};
    case api::JobState::canceled:
      return Problem{ProblemCode::conflict, "The render was canceled: it has no image.", {}};
    case api::JobState::succeeded:
      break;
  }
  return std::nullopt;
}

}  // namespace translucube::server

#pragma once

#include <string>
#include <variant>

#include "api/answer/sweep_status.h"
#include "api/base/problem.h"
#include "server/pictures/image_artifacts.h"

namespace translucube::server {

/// The contact sheet of a sweep as far as it is, made on demand and kept until more of the sweep is
/// there. Only the format, display, view and colorspace of the query are looked at. Throws
/// FileError, StoreError.
std::variant<ImageFile, api::Problem> sheet_artifact(Darkroom& darkroom,
                                                     const api::SweepStatus& sweep,
                                                     const ImageQuery& query);

}  // namespace translucube::server

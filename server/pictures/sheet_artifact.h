#pragma once

#include <string>

#include "api/answer/sweep_status.h"
#include "api/base/result.h"
#include "server/pictures/image_artifacts.h"

namespace translucube::server {

/// The contact sheet of a sweep as far as it is, made on demand and kept until more of the sweep is
/// there. Only the format, display, view and colorspace of the query are looked at. Throws
/// FileError, StoreError.
api::Result<ImageFile> sheet_artifact(Darkroom& darkroom, const api::SweepStatus& sweep,
                                      const ImageQuery& query);

}  // namespace translucube::server

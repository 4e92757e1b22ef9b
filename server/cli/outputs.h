#pragma once

// The pictures that a verb of the command line writes.

#include <filesystem>
#include <string>
#include <vector>

#include "picture/color.h"
#include "server/cli/options.h"
#include "server/cli/output_files.h"
#include "server/pictures/image_artifacts.h"

namespace translucube::server {

struct Output {
  std::filesystem::path file;
  ImageForm form;
};

/// The outputs, which `files` writes from now on. Throws Refusal.
std::vector<Output> checked_outputs(const std::vector<std::filesystem::path>& names,
                                    const DisplayChoice& display, const ColorConfig& colors,
                                    OutputFiles& files);

void write_outputs(const std::vector<Output>& outputs, const Image& picture,
                   const ColorConfig& colors, const std::string& canonical_request,
                   OutputFiles& files);

}  // namespace translucube::server

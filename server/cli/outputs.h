#pragma once

// The pictures that a verb of the command line writes.

#include <filesystem>
#include <string>
#include <vector>

#include "picture/color.h"
#include "server/cli/options.h"
#include "server/pictures/image_artifacts.h"

namespace translucube::server {

struct Output {
  std::filesystem::path file;
  ImageForm form;
};

/// The finished file takes the place of what is there. Throws Refusal for a device, a pipe, a
/// folder, or where there is no folder for it.
void check_output_place(const std::filesystem::path& file);

/// All that can be wrong with the outputs is told before the work begins. Throws Refusal.
std::vector<Output> checked_outputs(const std::vector<std::filesystem::path>& files,
                                    const DisplayChoice& display, const ColorConfig& colors);

void write_outputs(const std::vector<Output>& outputs, const Image& picture,
                   const ColorConfig& colors, const std::string& canonical_request);

}  // namespace translucube::server

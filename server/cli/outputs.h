#pragma once

// The pictures that a verb of the command line writes.

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "api/base/problem.h"
#include "picture/color.h"
#include "server/pictures/image_artifacts.h"

namespace translucube::server {

/// Ends the command with a message and an exit status.
struct Refusal {
  int status;
  std::string message;
};
Refusal refusal_of(const api::Problem& problem);

/// Runs a verb: what it throws becomes a message on standard error and the exit status.
int ended_command(const std::function<int()>& verb);

struct Output {
  std::filesystem::path file;
  ImageForm form;
};

/// The finished file takes the place of what is there. Throws Refusal for a device, a pipe, a
/// folder, or where there is no folder for it.
void check_output_place(const std::filesystem::path& file);

/// All that can be wrong with the outputs is told before the work begins. Throws Refusal.
std::vector<Output> checked_outputs(const std::vector<std::filesystem::path>& files,
                                    const std::optional<std::string>& display,
                                    const std::optional<std::string>& view,
                                    const ColorConfig& colors);

void write_outputs(const std::vector<Output>& outputs, const Image& picture,
                   const ColorConfig& colors, const std::string& canonical_request);

}  // namespace translucube::server

#pragma once

#include <filesystem>
#include <string>

#include "tests/bench/speed/figures.h"

namespace translucube::speed {

/// The report as Markdown.
std::string markdown(const Report& report);

/// Draws the tables' plots as SVG into a folder. Throws std::runtime_error without gnuplot
/// (.ci/docs_packages.txt).
void draw_plots(const Report& report, const std::filesystem::path& folder);

}  // namespace translucube::speed

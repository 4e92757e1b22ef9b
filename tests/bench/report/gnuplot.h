#pragma once

// Plots by gnuplot (.ci/docs_packages.txt), on white so that they read on dark pages too.

#include <filesystem>
#include <string>

namespace translucube::bench {

/// The colours of Okabe and Ito (2008).
inline constexpr const char* colors[] = {"#000000", "#0072B2", "#D55E00", "#009E73",
                                         "#CC79A7", "#E69F00", "#56B4E9"};

/// Throws std::runtime_error without gnuplot.
void require_gnuplot();

/// Draws a script into an SVG file. Throws std::runtime_error where gnuplot cannot be run.
void draw(const std::string& script, const std::filesystem::path& file, int width = 720,
          int height = 400);

}  // namespace translucube::bench

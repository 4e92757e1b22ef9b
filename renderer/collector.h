#pragma once

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "renderer/path.h"
#include "renderer/scene_data.h"
#include "renderer/transport.h"

namespace translucube {

/// Where paths end: develops what they bring into the lanes of a tile, counts, and keeps the log.
class Collector {
 public:
  Collector(const Scene& scene, Tile& tile, std::string* log)
      : scene_(scene), tile_(tile), log_(log) {}

  TraceCounters& counters() { return tile_.counters; }

  void collect(const Path& path, Rgb radiance, double weight) {
    collect(path.pixel, path.length, path.tint, radiance * static_cast<float>(weight));
  }

  /// `brought`: radiance that travelled `length` inside the body.
  void collect(std::uint32_t pixel_index, double length, std::uint32_t tint, Rgb brought) {
    const std::size_t stride = std::size_t(3) * tile_.width * tile_.height;
    float* pixel = &tile_.sum[std::size_t(3) * pixel_index];
    if (scene_.spread) {
      if (!std::isfinite(brought.r + brought.g + brought.b + static_cast<float>(length))) {
        ++counters().nan_samples;
        return;
      }
      const BinWeights spread = (*scene_.spread)(length);
      pixel += spread.bin * stride;
      for (const float share : spread.weights) {
        pixel[0] += brought.r * share;
        pixel[1] += brought.g * share;
        pixel[2] += brought.b * share;
        pixel += stride;
      }
      return;
    }
    for (std::size_t i = 0; i < scene_.lanes.size(); ++i) {
      Rgb developed = std::visit([&](const auto& lane) { return lane.apply(brought, length); },
                                 scene_.lanes[i]);
      if (tint > 0) developed = apply_operator(tints_[tint * scene_.lanes.size() + i], developed);
      if (!std::isfinite(developed.r + developed.g + developed.b)) ++counters().nan_samples;
      pixel[0] += developed.r;
      pixel[1] += developed.g;
      pixel[2] += developed.b;
      pixel += stride;
    }
  }

  /// Colours what the path brings from here on, for each lane (the dipole model).
  template <class Operator>
  void tint(Path& path, const std::vector<DipoleColor>& colors, Operator&& color) {
    const std::size_t lanes = colors.size(), before = path.tint * lanes;
    if (tints_.empty()) tints_.assign(lanes, identity_operator);
    path.tint = static_cast<std::uint32_t>(tints_.size() / lanes);
    for (std::size_t lane = 0; lane < lanes; ++lane)
      tints_.push_back(multiply(tints_[before + lane], color(colors[lane])));
  }

  void give_up(const Path& path) {
    note("give up", path);
    counters().truncated_energy += path.weight;
  }

  void note(const char* event, const Path& path) {
    if (log_ == nullptr) return;
    char line[256];
    std::snprintf(
        line, sizeof line,
        "%-9s p (%.9g, %.9g, %.9g) d (%.6f, %.6f, %.6f) length %.9g weight %.9g pdf %.6g\n", event,
        path.p.x, path.p.y, path.p.z, path.d.x, path.d.y, path.d.z, path.length, path.weight,
        path.pdf);
    *log_ += line;
  }

 private:
  const Scene& scene_;
  Tile& tile_;
  std::string* log_;
  std::vector<ColorOperator> tints_;  ///< lanes to a tint; the first changes nothing
};

}  // namespace translucube

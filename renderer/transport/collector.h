#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "renderer/film/contribution_batch.h"
#include "renderer/scene/scene.h"
#include "renderer/transport/path.h"
#include "renderer/transport/transport.h"

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
    batch_.push(pixel_index, length, tint, brought);
    if (batch_.size == ContributionBatch::capacity) flush();
  }

  /// A control variate's part, of which each lane takes its own share: what is added here and taken
  /// away there is nothing in the mean, whatever the share.
  void collect_carried(std::uint32_t pixel_index, double length, std::uint32_t tint, Rgb brought) {
    batch_.push(pixel_index, length, tint,
                scene_.spread ? brought * share_of_absorbers_to_come : brought, true);
    if (batch_.size == ContributionBatch::capacity) flush();
  }
  /// One for each lane; without them nothing may be carried.
  void set_carried_shares(std::vector<float> shares) { carried_shares_ = std::move(shares); }
  static constexpr float share_of_absorbers_to_come = 0.7f;

  /// Develops what waits; to be called after the last path.
  void flush() {
    const std::size_t lane_floats = pixel_floats * tile_.width * tile_.height;
    if (scene_.spread) {
      counters().nan_samples += add_spread(*scene_.spread, batch_, tile_.sum.data(), lane_floats);
    } else {
      for (std::size_t lane = 0; lane < scene_.lanes.size(); ++lane) {
        develop(scene_.lanes[lane], batch_, developed_);
        if (!tints_.empty()) apply_tints(lane);
        if (!carried_shares_.empty()) apply_share(carried_shares_[lane]);
        counters().nan_samples += add(batch_, developed_, &tile_.sum[lane * lane_floats]);
      }
    }
    batch_.size = 0;
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
    note(event, path.p, path.d, path.length, path.weight, path.pdf);
  }
  void note(const char* event, Vec3 p, Vec3 d, double length, double weight, double pdf = 0) {
    if (log_ == nullptr) return;
    char line[256];
    std::snprintf(
        line, sizeof line,
        "%-9s p (%.9g, %.9g, %.9g) d (%.6f, %.6f, %.6f) length %.9g weight %.9g pdf %.6g\n", event,
        p.x, p.y, p.z, d.x, d.y, d.z, length, weight, pdf);
    *log_ += line;
  }

 private:
  void apply_tints(std::size_t lane) {
    for (std::size_t i = 0; i < batch_.size; ++i)
      if (batch_.tint[i] > 0)
        developed_.set(
            i, apply_operator(tints_[batch_.tint[i] * scene_.lanes.size() + lane], developed_[i]));
  }

  void apply_share(float share) {
    for (std::size_t i = 0; i < batch_.size; ++i) {
      const float factor = batch_.carried[i] ? share : 1;
      for (std::size_t c = 0; c < pixel_floats; ++c)
        developed_.light[pixel_floats * i + c] *= factor;
    }
  }

  const Scene& scene_;
  Tile& tile_;
  std::string* log_;
  ContributionBatch batch_;
  DevelopedBatch developed_;
  std::vector<float> carried_shares_;
  std::vector<ColorOperator> tints_;  ///< lanes to a tint; the first changes nothing
};

}  // namespace translucube

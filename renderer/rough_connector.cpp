#include "renderer/rough_connector.h"

namespace translucube {

RoughConnector::RoughConnector(const Scene& scene, Collector& collector, const LightList& lights)
    : collector_(collector),
      lights_(lights),
      medium_(std::get<ScatteringInterior>(scene.interior).medium) {
  const auto& interface = std::get<RoughInterface>(scene.interface);
  exit_ = {static_cast<float>(interface.ior), static_cast<float>(interface.microfacets.alpha),
           static_cast<float>(medium_.sigma_s), static_cast<float>(medium_.g)};
}

double RoughConnector::chance(Vec3 p) const {
  return std::exp(-falling * 0.5 * medium_.sigma_s * (1 - length_squared(p)));
}

void RoughConnector::place(RoughExitBatch& batch, Vec3 p, Vec3 d, Vec3 light) const {
  const std::size_t i = batch.size++;
  const double rho = std::fmax(length(p), 1e-12), scale = 1 / rho;
  batch.up_x[i] = static_cast<float>(p.x * scale);
  batch.up_y[i] = static_cast<float>(p.y * scale);
  batch.up_z[i] = static_cast<float>(p.z * scale);
  batch.depth2[i] = static_cast<float>((1 - rho) * (1 + rho));
  batch.light_x[i] = static_cast<float>(light.x);
  batch.light_y[i] = static_cast<float>(light.y);
  batch.light_z[i] = static_cast<float>(light.z);
  batch.d_x[i] = static_cast<float>(d.x);
  batch.d_y[i] = static_cast<float>(d.y);
  batch.d_z[i] = static_cast<float>(d.z);
}

void RoughConnector::connect(Path& path) {
  const double chance = this->chance(path.p);
  Rng& rng = path.sampler.rng();
  if (rng.uniform() >= chance) return;
  ++collector_.counters().connections;
  collector_.note("connect", path);
  const auto light = static_cast<std::uint32_t>(rng.bits() & (LightList::size - 1));
  const std::size_t i = connections_.size;
  place(connections_, path.p, path.d, {lights_.x[light], lights_.y[light], lights_.z[light]});
  connections_.light_pdf[i] = static_cast<float>(chance * lights_.pdf[light]);
  const std::uint64_t key = rng.bits();
  connections_.key_low[i] = static_cast<std::uint32_t>(key);
  connections_.key_high[i] = static_cast<std::uint32_t>(key >> 32);
  waiting_[i] = {path.length, static_cast<float>(path.weight), path.pixel, light};
  if (connections_.size == RoughExitBatch::capacity) flush();
}

void RoughConnector::flush() {
  connect_rough(exit_, connections_);
  for (std::size_t i = 0; i < connections_.size; ++i) {
    if (connections_.share[i] == 0) continue;
    const Waiting& from = waiting_[i];
    collector_.collect(from.pixel, from.length + connections_.distance[i], 0,
                       lights_.radiance[from.light] * (from.weight * connections_.share[i]));
  }
  connections_.size = 0;
}

void RoughConnector::push_way(const Path& path, Vec3 light, double pdf) {
  const Vec3 way = path.p - path.vertex;
  const double distance = length(way);
  walked_[ways_.size] = static_cast<float>(path.phase * std::exp(-medium_.sigma_s * distance) *
                                           pdf / chance(path.vertex));
  place(ways_, path.vertex, path.d, light);
}

const RoughWays::Floats& RoughConnector::weigh_ways() {
  densities_of(exit_, ways_);
  for (std::size_t i = 0; i < ways_.size; ++i)
    walked_[i] = ways_.density[i] > 0 ? walked_[i] / ways_.density[i] : 0;
  ways_.size = 0;
  return walked_;
}

}  // namespace translucube

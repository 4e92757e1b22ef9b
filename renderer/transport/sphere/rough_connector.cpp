#include "renderer/transport/sphere/rough_connector.h"

#include <bit>

namespace translucube {

RoughConnector::RoughConnector(const Scene& scene, Collector& collector, const LightList& lights)
    : collector_(collector),
      lights_(lights),
      medium_(std::get<ScatteringInterior>(scene.interior).medium) {
  const auto& interface = std::get<RoughInterface>(scene.interface);
  exit_ = {static_cast<float>(interface.ior), static_cast<float>(interface.microfacets.alpha),
           static_cast<float>(medium_.sigma_s), static_cast<float>(medium_.g)};
}

void RoughConnector::place(RoughExitBatch& batch, Vec3 p, double depth2, Vec3 d, Vec3 light) {
  const std::size_t i = batch.size++;
  const double scale = 1 / std::fmax(length(p), 1e-12);
  batch.up_x[i] = static_cast<float>(p.x * scale);
  batch.up_y[i] = static_cast<float>(p.y * scale);
  batch.up_z[i] = static_cast<float>(p.z * scale);
  batch.depth2[i] = static_cast<float>(depth2);
  batch.light_x[i] = static_cast<float>(light.x);
  batch.light_y[i] = static_cast<float>(light.y);
  batch.light_z[i] = static_cast<float>(light.z);
  batch.d_x[i] = static_cast<float>(d.x);
  batch.d_y[i] = static_cast<float>(d.y);
  batch.d_z[i] = static_cast<float>(d.z);
}

void RoughConnector::connect(const SphereWalk::Vertices& vertices, std::span<const Path> paths) {
  collector_.counters().light_samples += vertices.size;
  for (std::size_t v = 0; v < vertices.size; ++v) {
    const Path& path = paths[vertices.slot[v]];
    const Vec3 p{vertices.p_x[v], vertices.p_y[v], vertices.p_z[v]},
        d{vertices.d_x[v], vertices.d_y[v], vertices.d_z[v]};
    const double length = path.length + vertices.length[v];
    const std::uint32_t light = vertices.bits[v] & (LightList::size - 1);
    collector_.note("connect", p, d, length, path.weight);
    const std::size_t i = connections_.size;
    place(connections_, p, vertices.depth2[v], d,
          {lights_.x[light], lights_.y[light], lights_.z[light]});
    connections_.light_pdf[i] = vertices.chance[v] * lights_.pdf[light];
    connections_.key_low[i] = std::bit_cast<std::uint32_t>(vertices.u[v]) ^ vertices.bits[v];
    connections_.key_high[i] = std::bit_cast<std::uint32_t>(vertices.v[v]);
    waiting_[i] = {length, static_cast<float>(path.weight), path.pixel, light};
    if (connections_.size == RoughExitBatch::capacity) flush();
  }
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
  const Path::Vertex& from = path.vertex;
  walked_[ways_.size] = static_cast<float>(from.phase * std::exp(-medium_.sigma_s * from.flight) *
                                           pdf / walk_medium().chance(from.depth2));
  place(ways_, from.p, from.depth2, path.d, light);
}

const RoughWays::Floats& RoughConnector::weigh_ways() {
  densities_of(exit_, ways_);
  for (std::size_t i = 0; i < ways_.size; ++i)
    walked_[i] = ways_.density[i] > 0 ? walked_[i] / ways_.density[i] : 0;
  ways_.size = 0;
  return walked_;
}

}  // namespace translucube

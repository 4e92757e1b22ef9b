#include "renderer/transport/sphere/rough_connector.h"

#include <bit>

namespace translucube {

RoughConnector::RoughConnector(const Scene& scene, Collector& collector, const LightList& lights)
    : lighting_(scene.environment),
      collector_(collector),
      lights_(lights),
      medium_(std::get<ScatteringInterior>(scene.interior).medium) {
  const auto& interface = std::get<RoughInterface>(scene.interface);
  exit_ = {static_cast<float>(interface.ior), static_cast<float>(interface.microfacets.alpha),
           static_cast<float>(medium_.sigma_s), static_cast<float>(medium_.g)};
}

void RoughConnector::connect(const SphereWalk::Vertices& vertices, std::span<const Path> paths) {
  collector_.counters().light_samples += vertices.size;
  for (std::size_t v = 0; v < vertices.size; ++v) {
    const Path& path = paths[vertices.slot[v]];
    const Vec3 p = vertices.p[v], d = vertices.d[v];
    const double length = path.length + vertices.length[v];
    const std::uint32_t light = vertices.bits[v] & (LightList::size - 1);
    collector_.note("connect", p, d, length, path.weight);
    const std::size_t i = connections_.push(p, vertices.depth2[v], d, lights_.direction[light]);
    connections_.light_pdf[i] = vertices.chance[v] * lights_.pdf[light];
    const auto bits = [](float number) { return std::bit_cast<std::uint32_t>(number); };
    connections_.random.start(
        i, std::uint64_t{bits(vertices.v[v])} << 32 | (bits(vertices.u[v]) ^ vertices.bits[v]));
    waiting_[i] = {length, static_cast<float>(path.weight), path.pixel, light};
    if (connections_.size == RoughConnections::capacity) flush();
  }
}

void RoughConnector::flush() {
  connect_rough(exit_, connections_);
  for (std::size_t i = 0; i < connections_.size; ++i) {
    if (connections_.share[i] == 0) continue;
    const Waiting& from = waiting_[i];
    const Rgb radiance = lights_.radiance[from.light] +
                         lighting_.from_near(connections_.normal[i], lights_.direction[from.light]);
    collector_.collect(from.pixel, from.length + connections_.distance[i], 0,
                       radiance * (from.weight * connections_.share[i]));
  }
  connections_.size = 0;
}

void RoughConnector::push_way(const Path& path, Vec3 light, double pdf) {
  const Path::Vertex& from = path.vertex;
  walked_[ways_.size] = static_cast<float>(from.phase * std::exp(-medium_.sigma_s * from.flight) *
                                           pdf / walk_medium().chance(from.depth2));
  ways_.push(from.p, from.depth2, path.d, light);
}

const RoughWays::Floats& RoughConnector::weigh_ways() {
  densities_of(exit_, ways_);
  for (std::size_t i = 0; i < ways_.size; ++i)
    walked_[i] = ways_.density[i] > 0 ? walked_[i] / ways_.density[i] : 0;
  ways_.size = 0;
  return walked_;
}

}  // namespace translucube

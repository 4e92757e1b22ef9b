#include "renderer/transport/sphere/smooth_connector.h"

#include <algorithm>
#include <numbers>

namespace translucube {

SmoothConnector::SmoothConnector(const Scene& scene, Collector& collector, std::uint64_t key)
    : collector_(collector),
      lighting_(scene.environment),
      medium_(std::get<ScatteringInterior>(scene.interior).medium),
      ior_(std::get<SmoothInterface>(scene.interface).ior),
      rng_(key) {
  if (!active()) return;
  std::vector<float> shares;
  for (const Lane& lane : scene.lanes) shares.push_back(carried_share(lane));
  collector_.set_carried_shares(std::move(shares));
  lights_ = lighting_.sample_each(LightStrata::size, rng_);
  for (std::size_t i = 0; i < LightStrata::size; ++i) strata_.set(i, lights_[i].direction);
}

float SmoothConnector::carried_share(const Lane& lane) const {
  const Rgb clear = std::visit(
      [&](const auto& which) {
        return which.apply({1, 1, 1}, 1 / medium_.sigma_s);
      },
      lane);
  const float absorbed = std::clamp(1 - luminance(clear), 0.0f, 1.0f);  // in a mean free path
  return 1 / (1 + 4 * std::sqrt(absorbed));
}

void SmoothConnector::start(Path& path) {
  if (!active()) return;
  const double rho = length(path.p);
  const Vec3 axis = rho > 0 ? path.p * (1 / rho) : Vec3{0, 0, 1};
  path.start = static_cast<std::uint32_t>(walks_.size());
  walks_.push_back({axis, lighting_.irradiance_by_order(axis)});
  for (Rgb& order : walks_.back().expected) order = order * std::numbers::inv_pi_v<float>;
}

bool SmoothConnector::reaches_far(const SmoothExits& exits) const {
  return medium_.sigma_s * exits.shortest_far() < longest_way;
}

void SmoothConnector::connect(const SphereWalk::Vertices& vertices, std::span<const Path> paths) {
  collector_.counters().light_samples += vertices.size;
  // The shortest of all ways out on the far branch begins at the radius 1 / ior.
  const bool far = medium_.sigma_s * std::sqrt(1 - 1 / (ior_ * ior_)) < longest_way;
  for (std::size_t i = 0; i < vertices.size; ++i) {
    const Path& path = paths[vertices.slot[i]];
    const auto weight = static_cast<float>(path.weight);
    const float chance = vertices.chance[i];
    const std::uint32_t drawn = vertices.bits[i] & std::uint32_t{LightStrata::size - 1};
    const EnvironmentSample& light = lights_[drawn];
    collector_.note("connect", vertices.p[i], vertices.d[i], path.length + vertices.length[i],
                    path.weight);
    SmoothExitBatch& near = near_.batch;
    if (near_alone()) {
      near.axis.set(near.size, walks_[path.start].axis);
      near.choice[near.size] = vertices.u[i];
      near.drawn[near.size] = vertices.v[i];
      near.turn[near.size] = vertices.w[i];
      push(near_, vertices, i, path, weight / chance, 0, {}, 1);
    } else {
      push(near_, vertices, i, path, weight, drawn, light.direction, chance * light.value.pdf);
    }
    if (near.size == SmoothExitBatch::capacity) flush_near();
    if (!far || !reaches_far(SmoothExits(ior_, vertices.p[i], vertices.depth2[i]))) continue;
    push(far_, vertices, i, path, weight, drawn, light.direction, chance * light.value.pdf);
    if (far_.batch.size == SmoothExitBatch::capacity) flush_far();
  }
}

void SmoothConnector::push(Queue& queue, const SphereWalk::Vertices& vertices, std::size_t i,
                           const Path& path, float weight, std::uint32_t light, Vec3 direction,
                           double pdf) {
  queue.waiting[queue.batch.size] = {path.length + vertices.length[i], weight, path.pixel,
                                     path.start, light};
  queue.batch.push(vertices.p[i], vertices.depth2[i], vertices.d[i], direction, pdf);
}

double SmoothConnector::pdf(const Path& path) const {
  const Path::Vertex& from = path.vertex;
  if (!from.connected()) return Path::not_looked_for;
  const SmoothExits exits(ior_, from.p, from.depth2);
  const bool far = exits.is_far(path.d);
  if (far && !reaches_far(exits)) return Path::not_looked_for;
  if (!far && near_alone()) return Path::found_by_connecting;
  return from.phase * std::exp(-medium_.sigma_s * from.flight) * exits.jacobian(path.d) /
         walk_medium().chance(from.depth2);
}

void SmoothConnector::flush_near() {
  if (near_alone())
    collect_near(near_);
  else
    collect_balanced(near_, ExitBranch::near);
  near_.batch.size = 0;
}

void SmoothConnector::flush_far() {
  find_minima(exit_medium(), far_.batch);
  for (const ExitBranch branch : far_branches) collect_balanced(far_, branch);
  far_.batch.size = 0;
}

std::optional<SmoothConnector::WayOut> SmoothConnector::way_out(const SmoothExitBatch& batch,
                                                                std::size_t i, Vec3 towards,
                                                                ExitBranch branch,
                                                                Division division) const {
  if (batch.share[i] == 0) return {};
  if (batch.share[i] > 0) return WayOut{batch.share[i], batch.distance[i], batch.normal[i]};
  // Not found, or not finite: sought in double precision.
  const auto exit = batch.exits(i, ior_).towards(towards, branch);
  if (!exit) return {};
  return WayOut{share_of(medium_, ior_, *exit, batch.d[i], batch.light_pdf[i], division),
                exit->distance, batch.vertex(i) + exit->distance * exit->d};
}

void SmoothConnector::collect_balanced(Queue& queue, ExitBranch branch) {
  SmoothExitBatch& batch = queue.batch;
  find_exits(exit_medium(), branch, Division::balanced, batch);
  for (std::size_t i = 0; i < batch.size; ++i) {
    const Waiting& from = queue.waiting[i];
    const EnvironmentSample& light = lights_[from.light];
    const auto way = way_out(batch, i, light.direction, branch, Division::balanced);
    if (!way) continue;
    const Rgb radiance = light.value.radiance + lighting_.from_near(way->normal, light.direction);
    const Rgb brought = radiance - expected(way->normal, from.walk) * far_share;
    collector_.collect(from.pixel, from.length + way->distance, 0,
                       brought * static_cast<float>(from.weight * way->share));
  }
}

Vec3 SmoothConnector::turned(const SmoothExitBatch& batch, std::size_t i, Vec3 p) {
  const auto stratum = static_cast<double>(batch.chosen[i] / LightStrata::positions);
  const double angle = 2 * std::numbers::pi * (batch.turn[i] + stratum / LightStrata::candidates);
  const Vec3 axis = batch.axis[i];
  return std::cos(angle) * p + std::sin(angle) * cross(axis, p) +
         (1 - std::cos(angle)) * dot(axis, p) * axis;
}

void SmoothConnector::collect_near(Queue& queue) {
  SmoothExitBatch& batch = queue.batch;
  choose_lights(exit_medium(), strata_, rng_.bits() & (LightStrata::positions - 1), batch);
  find_exits(exit_medium(), ExitBranch::near, Division::connected, batch);
  draw_exits(exit_medium(), batch);
  for (std::size_t i = 0; i < batch.size; ++i) {
    const Waiting& from = queue.waiting[i];
    const Walk& walk = walks_[from.walk];
    // What the walk carries of the light that leaves from here is taken away.
    const auto up = static_cast<float>(dot(batch.up[i], walk.axis));
    const float out = batch.drawn_cosine[i];
    const Rgb carried = walk.expected[0] + walk.expected[1] * (up * out) +
                        walk.expected[2] * (legendre2(up) * legendre2(out));
    collector_.collect_carried(from.pixel, from.length + batch.drawn_distance[i], 0,
                               carried * (-from.weight * batch.drawn_share[i]));
    const auto way = way_out(batch, i, batch.light[i], ExitBranch::near, Division::connected);
    if (!way) continue;
    const EnvironmentSample& light = lights_[batch.chosen[i]];
    Rgb radiance = light.value.radiance;
    if (lighting_.has_near())
      radiance += lighting_.from_near(turned(batch, i, way->normal), light.direction);
    collector_.collect(from.pixel, from.length + way->distance, 0,
                       radiance * static_cast<float>(from.weight * way->share / light.value.pdf));
  }
}

}  // namespace translucube

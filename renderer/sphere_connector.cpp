#include "renderer/sphere_connector.h"

#include <algorithm>
#include <numbers>

namespace translucube {

SphereConnector::SphereConnector(const Scene& scene, Collector& collector, std::uint64_t key)
    : collector_(collector),
      environment_(scene.next_event_estimation ? std::get_if<ImageEnvironment>(&scene.environment)
                                               : nullptr),
      medium_(std::get<ScatteringInterior>(scene.interior).medium),
      ior_(std::get<SmoothInterface>(scene.interface).ior),
      carried_(carried_share * std::numbers::inv_pi_v<float>),
      rng_(key) {
  if (!active()) return;
  std::vector<Sample2> numbers;
  numbers.reserve(LightStrata::size);
  for (std::size_t i = 0; i < LightStrata::size; ++i)
    numbers.push_back(
        {(static_cast<double>(i) + rng_.uniform()) / LightStrata::size, rng_.uniform()});
  lights_ = environment_->sample(numbers);
  for (std::size_t i = 0; i < LightStrata::size; ++i) strata_.set(i, lights_[i].direction);
}

void SphereConnector::start(Path& path) {
  if (!active()) return;
  const double rho = length(path.p);
  const Vec3 axis = rho > 0 ? path.p * (1 / rho) : Vec3{0, 0, 1};
  path.walk = static_cast<std::uint32_t>(walks_.size());
  walks_.push_back({axis, environment_->irradiance_by_order(axis)});
  for (Rgb& order : walks_.back().expected) order = order * carried_;
}

double SphereConnector::chance(Vec3 p) const {
  const double depth = 0.5 * medium_.sigma_s * (1 - length_squared(p));
  return std::exp(-falling * depth);
}

bool SphereConnector::reaches_far(const SphereExits& exits) const {
  return medium_.sigma_s * exits.shortest_far() < longest_way;
}

void SphereConnector::connect(Path& path) {
  const double chance = this->chance(path.p);
  Rng& rng = path.sampler.rng();
  if (rng.uniform() >= chance) return;
  ++collector_.counters().connections;
  collector_.note("connect", path);
  Waiting vertex{path.p,    path.d, path.length, static_cast<float>(path.weight), path.pixel,
                 path.walk, 0};
  const SphereExits exits(ior_, path.p);
  const double rho = std::fmax(exits.rho(), 1e-12);
  if (near_alone()) {
    ExitBatch& batch = near_.batch;
    const std::size_t i = batch.size;
    const Vec3 axis = walks_[path.walk].axis;
    const Sample2 u = rng.uniform2();
    batch.axis_x[i] = static_cast<float>(axis.x);
    batch.axis_y[i] = static_cast<float>(axis.y);
    batch.axis_z[i] = static_cast<float>(axis.z);
    batch.choice[i] = static_cast<float>(u.u);
    batch.drawn[i] = static_cast<float>(u.v);
    batch.turn[i] = static_cast<float>(rng.uniform());
    near_.waiting[i] = vertex;
    near_.waiting[i].weight = static_cast<float>(path.weight / chance);
    batch.push(path.p, rho, path.d, {}, 1);
    if (batch.size == ExitBatch::capacity) flush_near();
    if (!reaches_far(exits)) return;
  }
  vertex.light = static_cast<std::uint32_t>(rng.bits() & (LightStrata::size - 1));
  const double pdf = chance * lights_[vertex.light].value.pdf;
  if (!near_alone()) {
    push(near_, vertex, rho, pdf);
    if (near_.batch.size == ExitBatch::capacity) flush_near();
  }
  if (!reaches_far(exits)) return;
  push(far_, vertex, rho, pdf);
  if (far_.batch.size == ExitBatch::capacity) flush_far();
}

void SphereConnector::push(Queue& queue, const Waiting& vertex, double rho, double pdf) const {
  queue.waiting[queue.batch.size] = vertex;
  queue.batch.push(vertex.p, rho, vertex.d, lights_[vertex.light].direction, pdf);
}

double SphereConnector::pdf(const Path& path) const {
  if (path.phase == 0) return 0;
  const SphereExits exits(ior_, path.vertex);
  const bool far = exits.is_far(path.d);
  if (far && !reaches_far(exits)) return 0;
  if (!far && near_alone()) return Path::found_by_connecting;
  return path.phase * std::exp(-medium_.sigma_s * length(path.p - path.vertex)) *
         exits.jacobian(path.d) / chance(path.vertex);
}

void SphereConnector::flush_near() {
  if (near_alone())
    collect_near(near_);
  else
    collect_balanced(near_, ExitBranch::near);
  near_.batch.size = 0;
}

void SphereConnector::flush_far() {
  for (const ExitBranch branch : far_branches) collect_balanced(far_, branch);
  far_.batch.size = 0;
}

void SphereConnector::collect_balanced(Queue& queue, ExitBranch branch) {
  ExitBatch& batch = queue.batch;
  find_exits(exit_medium(), branch, Division::balanced, batch);
  for (std::size_t i = 0; i < batch.size; ++i) {
    const Waiting& from = queue.waiting[i];
    const EnvironmentSample& light = lights_[from.light];
    double share = batch.share[i], distance = batch.distance[i];
    Vec3 normal{batch.normal_x[i], batch.normal_y[i], batch.normal_z[i]};
    if (share == 0) continue;
    if (!(share > 0)) {  // not found, or not finite: sought in double precision
      const auto exit = SphereExits(ior_, from.p).towards(light.direction, branch);
      if (!exit) continue;
      share =
          translucube::share(medium_, ior_, *exit, from.d, batch.light_pdf[i], Division::balanced);
      distance = exit->distance;
      normal = from.p + distance * exit->d;
    }
    const Rgb brought = light.value.radiance - expected(normal, from.walk);
    collector_.collect(from.pixel, from.length + distance, 0,
                       brought * static_cast<float>(from.weight * share));
  }
}

void SphereConnector::collect_near(Queue& queue) {
  ExitBatch& batch = queue.batch;
  choose_lights(exit_medium(), strata_, rng_.bits() & (LightStrata::positions - 1), batch);
  find_exits(exit_medium(), ExitBranch::near, Division::connected, batch);
  draw_exits(exit_medium(), batch);
  for (std::size_t i = 0; i < batch.size; ++i) {
    const Waiting& from = queue.waiting[i];
    const Walk& walk = walks_[from.walk];
    // What the walk carries of the light that leaves from here is taken away.
    const auto up = static_cast<float>(batch.up_x[i] * walk.axis.x + batch.up_y[i] * walk.axis.y +
                                       batch.up_z[i] * walk.axis.z);
    const float out = batch.drawn_cosine[i];
    const Rgb carried = walk.expected[0] + walk.expected[1] * (up * out) +
                        walk.expected[2] * (legendre2(up) * legendre2(out));
    collector_.collect(from.pixel, from.length + batch.drawn_distance[i], 0,
                       carried * (-from.weight * batch.drawn_share[i]));
    const EnvironmentSample& light = lights_[batch.light[i]];
    double share = batch.share[i], distance = batch.distance[i];
    if (share == 0) continue;
    if (!(share > 0)) {  // not found, or not finite: sought in double precision
      const Vec3 w{batch.light_x[i], batch.light_y[i], batch.light_z[i]};
      const auto exit = SphereExits(ior_, from.p).towards(w, ExitBranch::near);
      if (!exit) continue;
      share =
          translucube::share(medium_, ior_, *exit, from.d, batch.light_pdf[i], Division::connected);
      distance = exit->distance;
    }
    collector_.collect(
        from.pixel, from.length + distance, 0,
        light.value.radiance * static_cast<float>(from.weight * share / light.value.pdf));
  }
}

}  // namespace translucube

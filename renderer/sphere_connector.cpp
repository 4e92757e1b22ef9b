#include "renderer/sphere_connector.h"

namespace translucube {

SphereConnector::SphereConnector(const Scene& scene, Collector& collector, std::uint64_t key)
    : collector_(collector),
      environment_(scene.next_event_estimation ? std::get_if<ImageEnvironment>(&scene.environment)
                                               : nullptr),
      medium_(std::get<ScatteringInterior>(scene.interior).medium),
      ior_(std::get<SmoothInterface>(scene.interface).ior) {
  if (!active()) return;
  Rng rng(key);
  lights_.reserve(light_count);
  for (std::size_t i = 0; i < light_count; ++i)
    lights_.push_back(environment_->sample(
        {(static_cast<double>(i) + rng.uniform()) / light_count, rng.uniform()}));
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
  const auto light = static_cast<std::uint32_t>(rng.bits() & (light_count - 1));
  const double pdf = chance * lights_[light].value.pdf;
  const Waiting vertex{path.p,     path.d, path.length, static_cast<float>(path.weight),
                       path.pixel, light};
  const SphereExits exits(ior_, path.p);
  push(near_, vertex, exits.rho(), pdf);
  if (near_.batch.size == ExitBatch::capacity) flush_near();
  if (!reaches_far(exits)) return;
  push(far_, vertex, exits.rho(), pdf);
  if (far_.batch.size == ExitBatch::capacity) flush_far();
}

void SphereConnector::push(Queue& queue, const Waiting& vertex, double rho, double pdf) const {
  queue.waiting[queue.batch.size] = vertex;
  queue.batch.push(vertex.p, std::fmax(rho, 1e-12), vertex.d, lights_[vertex.light].direction, pdf);
}

double SphereConnector::pdf(const Path& path) const {
  if (path.phase == 0) return 0;
  const SphereExits exits(ior_, path.vertex);
  if (exits.is_far(path.d) && !reaches_far(exits)) return 0;
  return path.phase * std::exp(-medium_.sigma_s * length(path.p - path.vertex)) *
         exits.jacobian(path.d) / chance(path.vertex);
}

void SphereConnector::flush_near() {
  collect(near_, ExitBranch::near);
  near_.batch.size = 0;
}

void SphereConnector::flush_far() {
  for (const ExitBranch branch : far_branches) collect(far_, branch);
  far_.batch.size = 0;
}

void SphereConnector::collect(Queue& queue, ExitBranch branch) {
  ExitBatch& batch = queue.batch;
  find_exits({static_cast<float>(ior_), static_cast<float>(medium_.sigma_s),
              static_cast<float>(medium_.g)},
             branch, batch);
  for (std::size_t i = 0; i < batch.size; ++i) {
    const Waiting& from = queue.waiting[i];
    if (batch.share[i] > 0) {
      collect(from, batch.distance[i], {batch.normal_x[i], batch.normal_y[i], batch.normal_z[i]},
              batch.share[i]);
    } else if (batch.share[i] != 0) {  // not found, or not finite: sought in double precision
      const Vec3 w = lights_[from.light].direction;
      if (const auto exit = SphereExits(ior_, from.p).towards(w, branch))
        collect(from, exit->distance, from.p + exit->distance * exit->d,
                share(medium_, ior_, *exit, from.d, batch.light_pdf[i]));
    }
  }
}

void SphereConnector::collect(const Waiting& from, double distance, Vec3 normal, double share) {
  const Rgb light = lights_[from.light].value.radiance - expected(normal);
  collector_.collect(from.pixel, from.length + distance, 0,
                     light * static_cast<float>(from.weight * share));
}

}  // namespace translucube

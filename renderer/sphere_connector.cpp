#include "renderer/sphere_connector.h"

namespace translucube {

SphereConnector::SphereConnector(const Scene& scene, Collector& collector, std::uint64_t key)
    : collector_(collector),
      environment_(std::get_if<ImageEnvironment>(&scene.environment)),
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

double SphereConnector::share_of(const SphereExit& exit, Vec3 before, double light_pdf) const {
  const double pdf = medium_.phase(dot(before, exit.d)) *
                     std::exp(-medium_.sigma_s * exit.distance) * exit.jacobian;
  return (1 - fresnel(exit.cos_i, 1 / ior_)) * pdf / (light_pdf + pdf);
}

void SphereConnector::connect(Path& path) {
  const double chance = this->chance(path.p);
  Rng& rng = path.sampler.rng();
  if (rng.uniform() >= chance) return;
  ++collector_.counters().connections;
  collector_.note("connect", path);
  const auto index = static_cast<std::uint32_t>(rng.bits() & (light_count - 1));
  const EnvironmentSample& light = lights_[index];
  const double pdf = chance * light.value.pdf;
  const Waiting from{path.p,     path.d, path.length, static_cast<float>(path.weight),
                     path.pixel, index};
  const SphereExits exits(ior_, path.p);
  if (reaches_far(exits))
    exits.far_towards(light.direction, [&](const SphereExit& exit) {
      collect(from, exit.distance, path.p + exit.distance * exit.d, share_of(exit, path.d, pdf));
    });
  waiting_[batch_.size] = from;
  batch_.push(path.p, std::fmax(length(path.p), 1e-12), path.d, light.direction, pdf);
  if (batch_.size == ExitBatch::capacity) flush();
}

double SphereConnector::pdf(const Path& path) const {
  if (path.phase == 0) return 0;
  const SphereExits exits(ior_, path.vertex);
  if (exits.is_far(path.d) && !reaches_far(exits)) return 0;
  return path.phase * std::exp(-medium_.sigma_s * length(path.p - path.vertex)) *
         exits.jacobian(path.d) / chance(path.vertex);
}

void SphereConnector::flush() {
  find_near_exits({static_cast<float>(ior_), static_cast<float>(medium_.sigma_s),
                   static_cast<float>(medium_.g)},
                  batch_);
  for (std::size_t i = 0; i < batch_.size; ++i) {
    if (batch_.share[i] > 0) {
      collect(waiting_[i], batch_.distance[i],
              {batch_.normal_x[i], batch_.normal_y[i], batch_.normal_z[i]}, batch_.share[i]);
    } else if (batch_.share[i] != 0) {  // not found, or not finite: sought again
      const Waiting& from = waiting_[i];
      SphereExits(ior_, from.p)
          .near_towards(lights_[from.light].direction, [&](const SphereExit& exit) {
            collect(from, exit.distance, from.p + exit.distance * exit.d,
                    share_of(exit, from.d, batch_.light_pdf[i]));
          });
    }
  }
  batch_.size = 0;
}

void SphereConnector::collect(const Waiting& from, double distance, Vec3 normal, double share) {
  const Rgb light = lights_[from.light].value.radiance - expected(normal);
  collector_.collect(from.pixel, from.length + distance, 0,
                     light * static_cast<float>(from.weight * share));
}

}  // namespace translucube

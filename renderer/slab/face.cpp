#include "renderer/slab/face.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "renderer/base/lagrange.h"
#include "renderer/optics/microsurface.h"
#include "renderer/slab/body.h"

namespace translucube::slab {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Samples of either incidence for one of each stream: all of the light passes through them.
constexpr std::uint64_t incident_samples = 16;

Face empty_face(int streams) {
  return {MatrixXd::Zero(streams, streams),
          MatrixXd::Zero(3, streams),
          MatrixXd::Zero(streams, 2),
          {0, 0}};
}

/// The row of Face::leaves.
int exit_row(double sin2) { return static_cast<int>(cone_of(sin2)) - static_cast<int>(Exit::core); }

}  // namespace

Face smooth_face(const Streams& streams, double ior) {
  Face face = empty_face(streams.count());
  for (int i = 0; i < streams.trapped; ++i) face.reflects(i, i) = 1;
  for (int i = streams.trapped; i < streams.count(); ++i) {
    const double mu = streams.mu_outside[i - streams.trapped], reflectance = fresnel(mu, ior);
    face.reflects(i, i) = reflectance;
    face.leaves(exit_row(1 - mu * mu), i) = 1 - reflectance;
    const double arrives = 2 * mu * streams.weight_outside[i - streams.trapped];
    face.enters(i, 1) = arrives * (1 - reflectance);
    face.reflected[1] += arrives * reflectance;
  }
  face.reflected[0] = fresnel(1, ior);
  face.enters(streams.core(), 0) = 1 - face.reflected[0];
  return face;
}

RoughFaceSampler::RoughFaceSampler(const Streams& streams, const RoughInterface& interface,
                                   std::uint64_t key)
    : streams_(&streams), interface_(interface), key_(key), sums_(empty_face(streams.count())) {}

void RoughFaceSampler::sample_to(std::uint64_t samples) {
  for (int from = 0; from < streams_->count(); ++from) sample_stream(from, samples_, samples);
  for (const int incidence : {0, 1})
    sample_incidence(incidence, incident_samples * samples_, incident_samples * samples);
  samples_ = samples;
}

std::uint64_t RoughFaceSampler::samples_taken() const {
  return samples_ * (static_cast<std::uint64_t>(streams_->count()) + 2 * incident_samples);
}

namespace {

/// Sample `index` of the light that arrives as `what`: its low-discrepancy points are 2^16 to a
/// key.
PathSampler sampler_of(std::uint64_t key, int what, std::uint64_t index) {
  return {hash_combine(hash_combine(key, static_cast<std::uint64_t>(what)), index >> 16),
          static_cast<std::uint32_t>(index & 0xffff)};
}

Vec3 direction(double mu) { return {std::sqrt(std::fmax(0.0, 1 - mu * mu)), 0, mu}; }

}  // namespace

void RoughFaceSampler::sample_stream(int from, std::uint64_t first, std::uint64_t last) {
  const double ior = interface_.ior;
  for (std::uint64_t i = first; i < last; ++i) {
    PathSampler sampler = sampler_of(key_, 2 + from, i);
    cross_microsurface(interface_, 1 / ior, direction(streams_->mu[from]), sampler,
                       [&](Vec3 wi, double weight) {
                         if (wi.z > 0)
                           add_inside(sums_.reflects.col(from), wi.z, weight);
                         else
                           sums_.leaves(exit_row(wi.x * wi.x + wi.y * wi.y), from) += weight;
                       });
  }
}

void RoughFaceSampler::sample_incidence(int incidence, std::uint64_t first, std::uint64_t last) {
  for (std::uint64_t i = first; i < last; ++i) {
    PathSampler sampler = sampler_of(key_, incidence, i);
    const double u = sampler.next2().u;
    cross_microsurface(interface_, interface_.ior, direction(incidence == 0 ? 1 : std::sqrt(1 - u)),
                       sampler, [&](Vec3 wi, double weight) {
                         if (wi.z > 0)
                           sums_.reflected[incidence] += weight;
                         else
                           add_inside(sums_.enters.col(incidence), -wi.z, weight);
                       });
  }
}

/// Spreads light of a direction between the streams over the nearest four so that the fluxes of any
/// cubic in mu are right (Lagrange).
void RoughFaceSampler::add_inside(Eigen::Ref<VectorXd> shares, double mu, double weight) const {
  const int row = exit_row(interface_.ior * interface_.ior * (1 - mu * mu));
  if (row < 2) {
    shares[row == 0 ? streams_->core() : streams_->ring()] += weight;
    return;
  }
  const double* nodes = streams_->mu.data();
  const int count = streams_->ring();
  const int above = static_cast<int>(std::upper_bound(nodes, nodes + count, mu) - nodes);
  const int first = std::clamp(above - 2, 0, count - 4);
  const std::span<const double, 4> nearest(nodes + first, 4);
  const std::array<double, 4> nearest_shares = lagrange_weights(nearest, mu, weight);
  for (int i = 0; i < 4; ++i) shares[first + i] += nearest_shares[i];
}

Face RoughFaceSampler::face() const {
  Face face = sums_;
  // Roulette keeps energy on the average alone: with columns that sum to 1 every estimate does.
  const bool lossless = interface_.multiple_scattering;
  for (int from = 0; from < streams_->count(); ++from) {
    const double all = lossless ? face.reflects.col(from).sum() + face.leaves.col(from).sum()
                                : static_cast<double>(samples_);
    face.reflects.col(from) /= all;
    face.leaves.col(from) /= all;
  }
  for (const int incidence : {0, 1}) {
    const double all = lossless ? face.enters.col(incidence).sum() + face.reflected[incidence]
                                : static_cast<double>(samples_ * incident_samples);
    face.enters.col(incidence) /= all;
    face.reflected[incidence] /= all;
  }
  return face;
}

}  // namespace translucube::slab

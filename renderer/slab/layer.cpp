#include "renderer/slab/layer.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "renderer/base/quadrature.h"
#include "renderer/slab/body.h"

namespace translucube::slab {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Legendre moments of the phase function that are kept.
int moments(int points) { return 2 * points; }

/// Denser than this [transport mean free paths] a slab transmits less than 1.4e-6, and reflects all
/// that a half space of the same albedo does but as much.
constexpr double densest = 1e6;

/// sum_l (2l + 1) chi_l P_l(mu_i) P_l(+- mu_j), chi the moments of Henyey and Greenstein's phase
/// function with its peak taken off, for light that keeps its side (+) and light that turns (-).
void phase_matrices(const VectorXd& mu, double g, int count, MatrixXd& keeps, MatrixXd& turns) {
  const double peak = std::pow(g, count);
  const auto n = mu.size();
  keeps = turns = MatrixXd::Zero(n, n);
  VectorXd before = VectorXd::Zero(n), p = VectorXd::Ones(n);
  for (int l = 0; l < count; ++l) {
    const double chi = (std::pow(g, l) - peak) / (1 - peak);
    const MatrixXd term = (2 * l + 1) * chi * p * p.transpose();
    keeps += term;
    turns += l % 2 == 0 ? term : MatrixXd(-term);
    const VectorXd next = ((2 * l + 1) * mu.cwiseProduct(p) - l * before) / (l + 1);
    before = p;
    p = next;
  }
}

/// Scales a symmetric phase matrix by c_i c_j so that every stream scatters all of its light
/// (Grant and Hunt 1969): the rule of the streams does not integrate all moments exactly.
void normalize(const VectorXd& weight, MatrixXd& keeps, MatrixXd& turns) {
  VectorXd c = VectorXd::Ones(weight.size());
  for (int step = 0; step < 30; ++step) {
    const VectorXd all = 0.5 * c.cwiseProduct((keeps + turns) * weight.cwiseProduct(c));
    c = c.cwiseQuotient(all.cwiseSqrt());
  }
  keeps = c.asDiagonal() * keeps * c.asDiagonal();
  turns = c.asDiagonal() * turns * c.asDiagonal();
}

}  // namespace

Streams make_streams(double ior, int points) {
  const Quadrature rule = gauss_legendre(points);
  const double critical = std::sqrt(1 - 1 / (ior * ior));
  std::vector<double> mu, weight;
  Streams streams;
  if (ior > 1)
    for (int i = 0; i < points; ++i) {
      mu.push_back(critical * rule.x[i]);
      weight.push_back(critical * rule.weight[i]);
    }
  streams.trapped = static_cast<int>(mu.size());
  const auto add = [&](double outside, double measure) {
    const double inside = std::sqrt(1 - (1 - outside * outside) / (ior * ior));
    mu.push_back(inside);
    weight.push_back(measure * outside / (ior * ior * inside));
    streams.mu_outside.push_back(outside);
    streams.weight_outside.push_back(measure);
  };
  const double to_core = std::cos(core_half_angle_deg * std::numbers::pi / 180);
  const double to_ring = std::cos(ring_half_angle_deg * std::numbers::pi / 180);
  for (int i = 0; i < points; ++i) add(to_ring * rule.x[i], to_ring * rule.weight[i]);
  add((to_ring + to_core) / 2, to_core - to_ring);
  add((to_core + 1) / 2, 1 - to_core);
  streams.mu = VectorXd::Map(mu.data(), static_cast<Eigen::Index>(mu.size()));
  streams.weight = VectorXd::Map(weight.data(), static_cast<Eigen::Index>(weight.size()));
  return streams;
}

double Layers::straight_share(double g, int points) { return std::pow(g, moments(points)); }

Layers::Layers(const Streams& streams, const Medium& medium, double first_depth)
    : inverse_mu_(streams.mu.cwiseInverse()), first_depth_(first_depth) {
  const int points = static_cast<int>(streams.mu_outside.size()) - 2;
  const double transport = medium.sigma_s * (1 - medium.g);
  if (transport > densest) limit_scale_ = densest / transport;
  sigma_s_ = medium.sigma_s * limit_scale_ * (1 - straight_share(medium.g, points));
  phase_matrices(streams.mu, medium.g, moments(points), forward_, backward_);
  normalize(streams.weight, forward_, backward_);
  for (MatrixXd* matrix : {&forward_, &backward_})
    *matrix = (0.5 * sigma_s_ * streams.weight).asDiagonal() * *matrix * inverse_mu_.asDiagonal();
}

Layer Layers::layer(double sigma_a) const {
  const double absorption = sigma_a * limit_scale_, extinction = sigma_s_ + absorption;
  int doublings = 0;
  double depth = 1;
  for (; depth * extinction > first_depth_; ++doublings) depth /= 2;
  // With u down and v up: du/dz = -A u + B v, -dv/dz = -A v + B u, so that u + v where the light is
  // even, u - v where it is odd, stay apart; over a thin layer by the diamond rule (Wiscombe 1976).
  const MatrixXd identity = MatrixXd::Identity(forward_.rows(), forward_.cols());
  const MatrixXd loss = MatrixXd((extinction * inverse_mu_).asDiagonal()) - forward_;
  const MatrixXd half_even = 0.5 * depth * (loss - backward_);
  const MatrixXd half_odd = 0.5 * depth * (loss + backward_);
  Layer layer{(identity + half_even).partialPivLu().solve(identity - half_even),
              -(identity + half_odd).partialPivLu().solve(identity - half_odd)};
  for (int i = 0; i < doublings; ++i) {
    // By symmetry the light in the middle of two layers is even, or odd, itself.
    const MatrixXd reflected = 0.5 * (layer.even + layer.odd);
    const MatrixXd transmitted = 0.5 * (layer.even - layer.odd);
    layer.even = reflected + transmitted * (identity - reflected).partialPivLu().solve(transmitted);
    layer.odd = reflected - transmitted * (identity + reflected).partialPivLu().solve(transmitted);
    // What absorbs nothing keeps all: rounding would add up to an absorption.
    if (sigma_a == 0)
      layer.even = layer.even * layer.even.colwise().sum().cwiseInverse().asDiagonal();
  }
  return layer;
}

}  // namespace translucube::slab

#pragma once

// The faces of a slab between the streams of layer.h: what they let in, keep and let out.

#include <array>
#include <cstdint>

#include "renderer/optics/interface.h"
#include "renderer/slab/layer.h"

namespace translucube::slab {

/// Shares of the light that arrives.
struct Face {
  Eigen::MatrixXd reflects;           ///< inside, to each stream (row) from each stream (column)
  Eigen::MatrixXd leaves;             ///< rows: core, ring, wide; from each stream
  Eigen::MatrixXd enters;             ///< columns: normal and diffuse incidence, to each stream
  std::array<double, 2> reflected{};  ///< of normal and diffuse incidence
};

Face smooth_face(const Streams& streams, double ior);

/// A rough face is sampled; estimates with other keys are independent.
class RoughFaceSampler {
 public:
  RoughFaceSampler(const Streams& streams, const RoughInterface& interface, std::uint64_t key);

  /// Takes samples up to this many of each stream, and more of the incident light; never fewer than
  /// before.
  void sample_to(std::uint64_t samples);
  Face face() const;
  std::uint64_t samples_taken() const;

 private:
  void sample_stream(int from, std::uint64_t first, std::uint64_t last);
  void sample_incidence(int incidence, std::uint64_t first, std::uint64_t last);
  void add_inside(Eigen::Ref<Eigen::VectorXd> shares, double mu, double weight) const;

  const Streams* streams_;
  RoughInterface interface_;
  std::uint64_t key_, samples_ = 0;
  Face sums_;
};

}  // namespace translucube::slab

#include "renderer/slab/adding.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "renderer/base/parallel.h"
#include "renderer/slab/face.h"
#include "renderer/slab/layer.h"

namespace translucube::slab {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Points on either side of the critical angle, depth of the first layer.
struct Resolution {
  int points;
  double first_depth;
};

/// Coarse and fine: totals between smooth faces are right to 1e-5 up to |g| = 0.7 and to 1e-4
/// beyond (against 64 points).
std::array<Resolution, 2> resolutions(double g) {
  if (g <= 0.7) return {{{8, 0x1p-6}, {12, 0x1p-7}}};
  return {{{16, 0x1p-6}, {24, 0x1p-7}}};
}

/// Narrow peaks of what is scattered back are not resolved, nor can they count as straight on.
constexpr double least_g = -0.7;
/// Thinner layers are for walks: light meets few scatterers, and narrow cones matter. A rough face
/// makes a narrow lobe of the light that meets none: next to nothing of it may be left.
constexpr double thinnest = 3, thinnest_rough = 8;
/// Most of the incident light that may count as not scattered though it was, by a little.
constexpr double most_straight = 5e-4;
/// Below it the streams' own error would have to be known better than their difference tells.
constexpr double least_standard_error = 1e-4;

constexpr int rough_replicates = 32;
constexpr std::uint64_t first_samples = 16, most_samples = std::uint64_t{1} << 14;

bool applies(const Body& body, double standard_error) {
  const auto* interior = std::get_if<ScatteringInterior>(&body.interior);
  if (!interior || standard_error < least_standard_error) return false;
  const auto [sigma_s, g] = interior->medium;
  if (g < least_g) return false;
  const double scattered = sigma_s * (1 - Layers::straight_share(g, resolutions(g)[0].points));
  const bool smooth = std::holds_alternative<SmoothInterface>(body.interface);
  return scattered >= (smooth ? thinnest : thinnest_rough) &&
         std::exp(-scattered) - std::exp(-sigma_s) <= most_straight;
}

/// Totals of every channel, by where the light leaves.
struct Exits {
  std::vector<double> reflected, core, ring, wide;
};

/// The layer between two equal faces. Light from above is half of even and half of odd light.
void add_faces(const Layer& layer, const Face& face, std::array<Exits, 2>& exits) {
  const MatrixXd identity = MatrixXd::Identity(face.reflects.rows(), face.reflects.cols());
  const auto outwards = [&](const MatrixXd& response) -> MatrixXd {
    const MatrixXd inwards =
        (identity - face.reflects * response).partialPivLu().solve(0.5 * face.enters);
    return face.leaves * (response * inwards);
  };
  const MatrixXd even = outwards(layer.even), odd = outwards(layer.odd);
  for (const int incidence : {0, 1}) {
    Exits& e = exits[incidence];
    e.reflected.push_back(face.reflected[incidence] + (even + odd).col(incidence).sum());
    const auto transmitted = (even - odd).col(incidence);
    e.core.push_back(transmitted[0]);
    e.ring.push_back(transmitted[1]);
    e.wide.push_back(transmitted[2]);
  }
}

/// What met a scatterer, of all the light.
Reading diffuse_reading(const Exits& exits, const Reading& unwalked, Incidence incidence,
                        const Channels& channels) {
  Reading read = unwalked;
  const auto at = [&](Exit exit) -> std::vector<double>& {
    return read.diffuse[static_cast<int>(exit)];
  };
  at(Exit::reflected) = channels.read(exits.reflected);
  at(Exit::core) = channels.read(exits.core);
  at(Exit::ring) = channels.read(exits.ring);
  at(Exit::wide) = channels.read(exits.wide);
  const bool normal = incidence == Incidence::normal;
  std::vector<double>& straight = at(normal ? Exit::core : Exit::wide);
  for (std::size_t i = 0; i < straight.size(); ++i) {
    if (!normal) {  // has no direction to be near to
      straight[i] += at(Exit::core)[i] + at(Exit::ring)[i];
      at(Exit::core)[i] = at(Exit::ring)[i] = 0;
    }
    at(Exit::reflected)[i] -= unwalked.specular[i];
    straight[i] -= unwalked.regular[i];
  }
  std::fill(read.specular.begin(), read.specular.end(), 0);
  std::fill(read.regular.begin(), read.regular.end(), 0);
  return read;
}

/// A body's layers, solved once with either resolution, between the faces of each replicate:
/// alternately with the coarse and the fine one.
class Replicates {
 public:
  Replicates(const Body& body, const Channels& channels, int count, int threads)
      : channels_(channels) {
    const Medium& medium = std::get<ScatteringInterior>(body.interior).medium;
    const double ior = std::visit([](const auto& i) { return i.ior; }, body.interface);
    std::vector<Layers> media;
    for (const auto& [points, first_depth] : resolutions(medium.g)) {
      streams_.push_back(make_streams(ior, points));
      media.emplace_back(streams_.back(), medium, first_depth);
    }
    const int n = static_cast<int>(channels.size());
    layers_.resize(media.size() * channels.size());
    parallel_for(threads, static_cast<int>(layers_.size()),
                 [&](int i) { layers_[i] = media[i / n].layer(channels.sigma_a[i % n]); });
    for (const Incidence incidence : incidences) {
      Readings& readings = at(incidence);
      readings.unwalked = read_unwalked(body, incidence, channels);
      readings.replicates.resize(count);
    }
  }

  const Streams& streams(int replicate) const { return streams_[replicate % 2]; }

  /// Other replicates may be solved meanwhile.
  void solve(int replicate, const Face& face) {
    std::array<Exits, 2> exits;
    for (std::size_t c = 0; c < channels_.size(); ++c)
      add_faces(layers_[replicate % 2 * channels_.size() + c], face, exits);
    for (const Incidence incidence : incidences) {
      Readings& readings = at(incidence);
      readings.replicates[replicate] = diffuse_reading(exits[static_cast<int>(incidence)],
                                                       readings.unwalked, incidence, channels_);
    }
  }

  double largest_error() const {
    double largest = 0;
    for (const Readings& readings : readings_) {
      const double error = largest_error_of_totals(readings);
      if (!std::isfinite(error)) throw std::runtime_error("slab optics that are not finite: a bug");
      largest = std::max(largest, error);
    }
    return largest;
  }

  AddedReadings take(std::uint64_t samples) { return {std::move(readings_), samples}; }

 private:
  Readings& at(Incidence incidence) { return readings_[static_cast<int>(incidence)]; }

  const Channels& channels_;
  std::vector<Streams> streams_;
  std::vector<Layer> layers_;  ///< resolutions x channels
  std::array<Readings, 2> readings_;
};

std::optional<AddedReadings> between_smooth_faces(const SmoothInterface& interface,
                                                  Replicates& replicates, double standard_error) {
  for (const int i : {0, 1}) replicates.solve(i, smooth_face(replicates.streams(i), interface.ior));
  if (replicates.largest_error() > standard_error) return std::nullopt;
  return replicates.take(0);
}

std::optional<AddedReadings> between_rough_faces(const RoughInterface& interface,
                                                 Replicates& replicates, double standard_error,
                                                 std::uint64_t seed, int threads) {
  std::vector<RoughFaceSampler> faces;
  for (int i = 0; i < rough_replicates; ++i)
    faces.emplace_back(replicates.streams(i), interface,
                       hash_combine(seed, static_cast<std::uint64_t>(i)));
  for (std::uint64_t samples = first_samples; samples <= most_samples;) {
    parallel_for(threads, rough_replicates, [&](int i) {
      faces[i].sample_to(samples);
      replicates.solve(i, faces[i].face());
    });
    const double reached = replicates.largest_error();
    if (reached <= standard_error) {
      std::uint64_t taken = 0;
      for (const RoughFaceSampler& face : faces) taken += face.samples_taken();
      return replicates.take(taken);
    }
    const double more = std::pow(reached / standard_error, 2) * 1.1;
    samples = static_cast<std::uint64_t>(
        std::ceil(static_cast<double>(samples) * std::clamp(more, 1.25, 16.0)));
  }
  return std::nullopt;
}

}  // namespace

std::optional<AddedReadings> add_layers(const Body& body, const Channels& channels,
                                        double standard_error, std::uint64_t seed, int threads) {
  if (!applies(body, standard_error)) return std::nullopt;
  if (const auto* smooth = std::get_if<SmoothInterface>(&body.interface)) {
    Replicates replicates(body, channels, 2, threads);
    return between_smooth_faces(*smooth, replicates, standard_error);
  }
  Replicates replicates(body, channels, rough_replicates, threads);
  return between_rough_faces(std::get<RoughInterface>(body.interface), replicates, standard_error,
                             seed, threads);
}

}  // namespace translucube::slab

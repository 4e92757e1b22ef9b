#include "renderer/slab/adding.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "renderer/base/parallel.h"
#include "renderer/slab/face.h"
#include "renderer/slab/layer.h"

namespace translucube {
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

bool applies(const SlabBody& body, double standard_error) {
  const auto* interior = std::get_if<ScatteringInterior>(&body.interior);
  if (!interior || standard_error < least_standard_error) return false;
  const auto [sigma_s, g] = interior->medium;
  if (g < least_g) return false;
  const double scattered = sigma_s * (1 - SlabLayers::straight_share(g, resolutions(g)[0].points));
  const bool smooth = std::holds_alternative<SmoothInterface>(body.interface);
  return scattered >= (smooth ? thinnest : thinnest_rough) &&
         std::exp(-scattered) - std::exp(-sigma_s) <= most_straight;
}

/// Totals of every channel, by where the light leaves.
struct Exits {
  std::vector<double> reflected, core, ring, wide;
};

/// The layer between two equal faces. Light from above is half of even and half of odd light.
void add_faces(const SlabLayer& layer, const SlabFace& face, std::array<Exits, 2>& exits) {
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
SlabRead diffuse_read(const Exits& exits, const SlabRead& unwalked, Incidence incidence,
                      const SlabChannels& channels) {
  SlabRead read = unwalked;
  const auto at = [&](SlabExit exit) -> std::vector<double>& {
    return read.diffuse[static_cast<int>(exit)];
  };
  at(SlabExit::reflected) = channels.read(exits.reflected);
  at(SlabExit::core) = channels.read(exits.core);
  at(SlabExit::ring) = channels.read(exits.ring);
  at(SlabExit::wide) = channels.read(exits.wide);
  const bool normal = incidence == Incidence::normal;
  std::vector<double>& straight = at(normal ? SlabExit::core : SlabExit::wide);
  for (std::size_t i = 0; i < straight.size(); ++i) {
    if (!normal) {  // has no direction to be near to
      straight[i] += at(SlabExit::core)[i] + at(SlabExit::ring)[i];
      at(SlabExit::core)[i] = at(SlabExit::ring)[i] = 0;
    }
    at(SlabExit::reflected)[i] -= unwalked.specular[i];
    straight[i] -= unwalked.regular[i];
  }
  std::fill(read.specular.begin(), read.specular.end(), 0);
  std::fill(read.regular.begin(), read.regular.end(), 0);
  return read;
}

}  // namespace

std::optional<AddedReadings> add_layers(const SlabBody& body, const SlabChannels& channels,
                                        double standard_error, std::uint64_t seed, int threads) {
  if (!applies(body, standard_error)) return std::nullopt;
  const auto& medium = std::get<ScatteringInterior>(body.interior).medium;
  const double ior = std::visit([](const auto& i) { return i.ior; }, body.interface);

  std::vector<SlabStreams> streams;
  std::vector<SlabLayers> media;
  for (const auto& [points, first_depth] : resolutions(medium.g)) {
    streams.push_back(slab_streams(ior, points));
    media.emplace_back(streams.back(), medium, first_depth);
  }
  const int n = static_cast<int>(channels.size());
  std::vector<SlabLayer> layers(2 * n);
  parallel_for(threads, static_cast<int>(layers.size()),
               [&](int i) { layers[i] = media[i / n].layer(channels.sigma_a[i % n]); });

  AddedReadings added;
  std::array<SlabRead, 2> unwalked;
  for (const Incidence incidence : {Incidence::normal, Incidence::diffuse})
    added.at[static_cast<int>(incidence)].unwalked = unwalked[static_cast<int>(incidence)] =
        read_unwalked(body, incidence, channels);
  const auto solve = [&](int replicate, const SlabFace& face) {
    std::array<Exits, 2> exits;
    for (int c = 0; c < n; ++c) add_faces(layers[replicate % 2 * n + c], face, exits);
    for (const Incidence incidence : {Incidence::normal, Incidence::diffuse}) {
      const int at = static_cast<int>(incidence);
      added.at[at].replicates[replicate] =
          diffuse_read(exits[at], unwalked[at], incidence, channels);
    }
  };
  const auto error = [&] {
    const double normal = largest_error_of_totals(added.at[0]);
    const double diffuse = largest_error_of_totals(added.at[1]);
    if (!std::isfinite(normal) || !std::isfinite(diffuse))
      throw std::runtime_error("slab optics that are not finite: a bug");
    return std::max(normal, diffuse);
  };
  const auto resize = [&](int replicates) {
    for (Readings& readings : added.at) readings.replicates.resize(replicates);
  };

  if (std::holds_alternative<SmoothInterface>(body.interface)) {
    resize(2);
    for (const int i : {0, 1}) solve(i, smooth_face(streams[i], ior));
    if (error() > standard_error) return std::nullopt;
    return added;
  }
  resize(rough_replicates);
  std::vector<RoughFaceSampler> faces;
  for (int i = 0; i < rough_replicates; ++i)
    faces.emplace_back(streams[i % 2], std::get<RoughInterface>(body.interface),
                       hash_combine(seed, static_cast<std::uint64_t>(i)));
  for (std::uint64_t samples = first_samples; samples <= most_samples;) {
    parallel_for(threads, rough_replicates, [&](int i) {
      faces[i].sample_to(samples);
      solve(i, faces[i].face());
    });
    const double reached = error();
    if (reached <= standard_error) {
      for (const RoughFaceSampler& face : faces) added.samples += face.samples_taken();
      return added;
    }
    const double more = std::pow(reached / standard_error, 2) * 1.1;
    samples = static_cast<std::uint64_t>(
        std::ceil(static_cast<double>(samples) * std::clamp(more, 1.25, 16.0)));
  }
  return std::nullopt;
}

}  // namespace translucube

#include "renderer/slab/walk.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include "renderer/optics/microsurface.h"
#include "renderer/slab/direct.h"
#include "renderer/slab/jump.h"

namespace translucube::slab {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Weight, relative to the start, down to which light is split at a face or a microfacet; from
/// there on it goes one way as a whole, by chance. Unlike Russian roulette this keeps the energy of
/// every history: the error of R is no larger than that of T and of what is absorbed.
constexpr double least_split = 1.0 / 2, least_split_of_microfacets = 1.0 / 2;

template <class Interface, class Interior>
class Walk {
  static constexpr bool smooth = Interface::smooth;
  static constexpr bool scattering = Interior::facts.scatters;
  static constexpr bool open = Interior::facts.open;

 public:
  Walk(const Body& body, const Interface& interface, const Interior& interior, Incidence incidence,
       bool jumps, Tally& tally)
      : interface_(interface), interior_(interior), incidence_(incidence), tally_(tally) {
    half_length_ = std::numbers::ln2 / body.least_sigma_a;
    const double sin_critical2 = 1 / (interface.ior * interface.ior);
    trapped_mu2_ = 1 - sin_critical2;
    if constexpr (scattering) {
      const Medium& medium = interior.medium;
      transport_length_ = 1 / (medium.sigma_s * (1 - medium.g));
      if (jumps) jump_depth_ = jump_depth * transport_length_;
    }
  }

  void run(const PathSampler& sampler) {
    sampler_ = sampler;
    length_ = 0;
    next_roulette_ = half_length_;
    const Sample2 u = sampler_.next2();
    const double mu = incidence_ == Incidence::normal ? 1 : std::sqrt(1 - u.u);
    if constexpr (smooth) {
      if (!scatter_first(mu, u.v)) return;
    } else {
      z_ = 0;
      weight_ = 1;
      if (!cross_rough(mu, interface_.ior, true, 1 - u.v)) return;
    }
    if constexpr (open) {
      floor_ = weight_ * least_split;
      walk();
    }
  }

 private:
  // ---- inside

  /// Moves to the first scatterer, by whichever of the crossings; false if light meets none.
  bool scatter_first(double mu, double u) {
    const FirstScatterer first =
        sample_first_scatterer(interface_.ior, interior_.medium.sigma_s, mu, u);
    if (!(first.weight > 0)) return false;
    weight_ = first.weight;
    z_ = first.z;
    mu_ = first.mu;
    length_ = first.length;
    const Sample2 turn = sampler_.next2();
    scatter(turn.u, std::cos(2 * std::numbers::pi * turn.v));
    return true;
  }

  void walk() {
    Rng& rng = sampler_.rng();
    while (true) {
      const double to_face = mu_ == 0 ? infinity : std::fmax(0.0, (mu_ > 0 ? 1 - z_ : -z_) / mu_);
      if constexpr (scattering) {
        const double flight = interior_.medium.sample_flight(rng);
        // Light that no smooth face lets out goes from face to face up to its next scatterer.
        const bool trapped = smooth && mu_ * mu_ < trapped_mu2_;
        if (flight < to_face || trapped) {
          length_ += flight;
          z_ += flight * mu_;
          if (!(flight < to_face)) fold();
          if (length_ > next_roulette_ && !outlives_absorption()) return;
          if (std::fmin(z_, 1 - z_) > jump_depth_)
            jump();
          else
            scatter(rng.uniform(), interior_.medium.g == 0 ? 0 : sample_cos_phi(rng));
          continue;
        }
      }
      length_ += to_face;
      z_ = mu_ > 0 ? 1 : 0;
      if (length_ > next_roulette_ && !outlives_absorption()) return;
      if constexpr (smooth) {
        if (!stays_smooth()) return;
      } else if (!cross_rough(std::fabs(mu_), 1 / interface_.ior, false, rng.uniform_positive())) {
        return;
      }
    }
  }

  void scatter(double u, double cos_phi) {
    const double g = interior_.medium.g;
    if (g == 0) {
      mu_ = 2 * u - 1;
      return;
    }
    const double cos_theta = sample_henyey_greenstein(g, u);
    const double sines = (1 - cos_theta * cos_theta) * std::fmax(0.0, 1 - mu_ * mu_);
    mu_ = mu_ * cos_theta + std::sqrt(std::fmax(0.0, sines)) * cos_phi;
    mu_ = std::fmin(1.0, std::fmax(-1.0, mu_));
  }

  /// The cosine of a random azimuth, without taking one: that of twice the angle of a point in the
  /// unit disc (von Neumann 1951).
  static double sample_cos_phi(Rng& rng) {
    while (true) {
      const Sample2 u = rng.uniform2();
      const double a = 2 * u.u - 1, b = 2 * u.v - 1, s = a * a + b * b;
      if (s < 1 && s > 0) return (a * a - b * b) / s;
    }
  }

  /// Mirrors the path at the faces, back into the slab.
  void fold() {
    const double whole = std::floor(z_);
    z_ -= whole;
    if (std::fmod(whole, 2) != 0) {
      z_ = 1 - z_;
      mu_ = -mu_;
    }
  }

  void jump() {
    const Jump jump = sample_jump(z_, mu_, interior_.medium.g, transport_length_, sampler_.rng());
    z_ = jump.z;
    mu_ = jump.mu;
    length_ += jump.length;
  }

  // ---- faces

  /// Sends out the transmitted share, keeps the reflected one; false if nothing is kept.
  bool stays_smooth() {
    const double reflectance = fresnel(std::fabs(mu_), 1 / interface_.ior);
    const double sin2 = interface_.ior * interface_.ior * (1 - mu_ * mu_);
    mu_ = -mu_;
    if (weight_ >= floor_) {
      leave(weight_ * (1 - reflectance), sin2);
      weight_ *= reflectance;
      return weight_ > 0;
    }
    if (sampler_.rng().uniform() < reflectance) return true;
    leave(weight_, sin2);
    return false;
  }

  /// Light goes from microfacet to microfacet: what escapes outwards is sent out, and one of the
  /// rays that escape into the slab stands for all of them (a reservoir of one: Chao 1982); false
  /// if there is none.
  bool cross_rough(double mu, double eta, bool from_outside, double u) {
    if (!(mu > 0)) return false;  // along the face: no light crosses it
    const double arriving = weight_;
    const bool splits = from_outside || arriving >= floor_;
    Rng& rng = sampler_.rng();
    double inward = 0, inward_weight = 0;
    const auto escape = [&](Vec3 wi, double weight) {
      if (!(weight > 0)) return;
      if ((wi.z > 0) == from_outside) {
        leave(weight, wi.x * wi.x + wi.y * wi.y);
      } else if (open) {
        inward_weight += weight;
        if (rng.uniform() * inward_weight < weight) inward = std::fabs(wi.z);
      }
    };
    const Vec3 wo{std::sqrt(std::fmax(0.0, 1 - mu * mu)), 0, mu};
    MicroVertex vertex(interface_.microfacets, eta, wo, u);
    while (true) {
      const MicroSample sample = vertex.sample(sampler_.next2());
      const MicroBranch &up = sample.reflected, &down = sample.transmitted;
      const double weight = vertex.weight();
      const double out_up = up.weight * up.escape, out_down = down.weight * down.escape;
      if (splits && weight >= least_split_of_microfacets) {
        escape(vertex.to_first_side(up.wi), arriving * weight * out_up);
        escape(vertex.to_first_side(down.wi), arriving * weight * out_down);
        if (!interface_.multiple_scattering) break;
        vertex.advance(sample, rng.uniform_positive(), rng.uniform_positive());
        continue;
      }
      const double choice = rng.uniform();
      if (choice < out_up + out_down) {
        escape(vertex.to_first_side(choice < out_up ? up.wi : down.wi), arriving * weight);
        break;
      }
      if (!interface_.multiple_scattering) break;
      vertex.advance(sample, rng.uniform_positive(), rng.uniform_positive());
      vertex.set_weight(weight);
    }
    weight_ = inward_weight;
    mu_ = z_ > 0 ? -inward : inward;
    return inward_weight > 0;
  }

  void leave(double weight, double sin2) {
    const Exit far_side = incidence_ == Incidence::normal ? cone_of(sin2) : Exit::wide;
    tally_.add(z_ == 0 ? Exit::reflected : far_side, weight, length_);
  }

  /// Russian roulette: past every length that halves even the least absorbed channel, half of the
  /// paths go on, with the weight of all.
  bool outlives_absorption() {
    while (length_ > next_roulette_) {
      if (sampler_.rng().uniform() < 0.5) return false;
      weight_ *= 2;
      floor_ *= 2;
      next_roulette_ += half_length_;
    }
    return true;
  }

  const Interface& interface_;
  const Interior& interior_;
  Incidence incidence_;
  Tally& tally_;
  double half_length_, trapped_mu2_, transport_length_ = 0, jump_depth_ = infinity;

  PathSampler sampler_;
  double z_ = 0, mu_ = 0, length_ = 0, weight_ = 0, floor_ = 0, next_roulette_ = 0;
};

void walk(const Body& body, Incidence incidence, std::uint64_t key, std::uint64_t first,
          std::uint64_t count, bool jumps, Tally& tally) {
  std::visit(
      [&](const auto& interface, const auto& interior) {
        using Interface = std::decay_t<decltype(interface)>;
        using Interior = std::decay_t<decltype(interior)>;
        constexpr bool scattering = Interior::facts.scatters;
        constexpr bool smooth = Interface::smooth;
        if constexpr (scattering || (!smooth && !Interior::facts.diffuse)) {
          Walk walk(body, interface, interior, incidence, jumps, tally);
          // The low-discrepancy points are 2^16 to a key.
          for (std::uint64_t i = first; i < first + count; ++i)
            walk.run(PathSampler(hash_combine(key, i >> 16), std::uint32_t(i & 0xffff)));
        }
      },
      body.interface, body.interior);
}

}  // namespace

bool needs_walks(const Body& body) {
  if (std::holds_alternative<ScatteringInterior>(body.interior)) return true;
  return std::holds_alternative<RoughInterface>(body.interface) &&
         !std::holds_alternative<LambertianInterior>(body.interior);
}

void walk(const Body& body, Incidence incidence, std::uint64_t key, std::uint64_t first,
          std::uint64_t count, Tally& tally) {
  walk(body, incidence, key, first, count, true, tally);
}

void walk_analog(const Body& body, Incidence incidence, std::uint64_t key, std::uint64_t first,
                 std::uint64_t count, Tally& tally) {
  walk(body, incidence, key, first, count, false, tally);
}

}  // namespace translucube::slab

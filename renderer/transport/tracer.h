#pragma once

// Light transport in the cube, backwards from the camera, in stages:
//
//   emit -> enter -> walk -> boundary -> connect
//
// Each stage is one loop over a queue of paths. What is carried is an achromatic weight and the
// length travelled inside the body; absorption comes with the film's lanes. At a smooth boundary
// both branches are followed; the light that no particle deflects is enumerated, not sampled, and
// one scattered path stands for all that is deflected on the way (a reservoir of one: Chao 1982).
// Paths of small weight are played out by Russian roulette, so that the branches in flight stay
// bounded.

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <type_traits>
#include <variant>

#include "renderer/light/environment_batch.h"
#include "renderer/optics/microsurface_batch.h"
#include "renderer/transport/collector.h"
#include "renderer/transport/path.h"
#include "renderer/transport/sphere/rough_connector.h"
#include "renderer/transport/sphere/smooth_connector.h"
#include "renderer/transport/sphere/sphere_walk.h"
#include "renderer/transport/trace_body.h"

namespace translucube {

/// Below this weight a path survives with probability weight / threshold: low where following it is
/// cheap, high where each turn is a long walk (chosen by relMSE x CPU on the peers' materials).
inline constexpr double roulette_of_clear = 1.0 / 64;
/// The same for a scattered path, relative to its weight at the first scattering.
inline constexpr double roulette_of_scattered = 1.0 / 4;
/// The same inside a clear body under a rough interface.
inline constexpr double roulette_of_rough = 1.0 / 8;
/// Lights that a collision with a microfacet looks for.
inline constexpr std::uint32_t lights_of_a_collision = 8;
/// Below this scattering coefficient [1 / unit] a walk is so short that a camera sample starts two.
inline constexpr double short_walk_sigma_s = 2;
/// Boundary events after which a path is given up and its weight counted as truncated energy: only
/// light that is trapped gets there, for good (a camera inside a clear body) or, in a mesh, for
/// nearly as long (a medium of millions of bounding radii to the mean free path).
inline constexpr std::uint32_t clear_event_cap = 20'000, scattering_event_cap = 2'000'000;
/// In the dipole model, times that light may come back to the body from outside, likewise.
inline constexpr std::uint32_t dipole_arrival_cap = 16;

template <class Shape, class Interface, class Interior>
class Tracer {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  static constexpr bool smooth = Interface::smooth;
  static constexpr bool scattering = Interior::facts.scatters;
  static constexpr bool lambertian = Interior::facts.diffuse;
  static constexpr bool dense = Interior::facts.half_space;
  static constexpr bool dipole = Interior::facts.dipole;
  /// Whether walks go on together in SIMD, and their vertices may look for light through the
  /// boundary.
  static constexpr bool connecting = scattering && std::is_same_v<Shape, Sphere>;
  using Connector = std::conditional_t<!connecting, NoConnector,
                                       std::conditional_t<smooth, SmoothConnector, RoughConnector>>;
  /// Whether light goes on inside the body.
  static constexpr bool open = Interior::facts.open || dense;

 public:
  Tracer(const Scene& scene, const Shape& shape, const Interface& interface,
         const Interior& interior, Tile& tile, std::uint64_t key, std::string* log)
      : scene_(scene),
        shape_(shape),
        interface_(interface),
        interior_(interior),
        tile_(tile),
        collector_(scene, tile, log),
        lights_(lights_of(scene, key)),
        may_come_back_(!shape.convex() ||
                       (scene.backdrop && scene.backdrop->kind == BackdropKind::print)),
        connector_(make_connector(scene, key)),
        arriving_(tile.queues.arriving),
        walking_(tile.queues.walking),
        leaving_(tile.queues.leaving),
        crossing_(tile.queues.crossing) {}

  void run(std::uint32_t pass_index, std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t s = first; s < first + count; ++s) emit(pass_index, s);
    while (!arriving_.empty() || !walking_.empty()) {
      enter();
      walk();
      boundary();
    }
    connector_.flush();
    for (Escapes& escapes : escapes_) collect(escapes);
    collector_.flush();
  }

 private:
  // ---- stages

  void emit(std::uint32_t pass_index, std::uint32_t sample) {
    for (int y = 0; y < tile_.height; ++y)
      for (int x = 0; x < tile_.width; ++x) {
        const int px = tile_.x0 + x, py = tile_.y0 + y;
        const std::uint64_t pixel_key =
            hash_combine(hash_combine(scene_.seed, pass_index),
                         std::uint64_t(py) * std::uint64_t(scene_.width) + std::uint64_t(px));
        Path path;
        path.sampler = PathSampler(pixel_key, sample);
        path.pixel = static_cast<std::uint32_t>(y * tile_.width + x);
        path.roulette = roulette_of_clear;
        const Sample2 u = path.sampler.next2();
        path.p = scene_.camera.position;
        path.d = scene_.camera.direction(px + u.u, py + u.v);
        collector_.note("emit", path);
        ++tile_.counters.camera_samples;
        if (!scene_.camera_inside) {
          arriving_.push_back(path);
        } else if constexpr (open) {
          inward(path);
        }
      }
  }

  static LightList lights_of(const Scene& scene, std::uint64_t key) {
    return smooth || !scene.next_event_estimation ? LightList() : LightList(scene.environment, key);
  }

  Connector make_connector(const Scene& scene, std::uint64_t key) {
    // Vertices look for light through one interface: where there are two, the walk finds it.
    static const LightList none;
    if constexpr (connecting && !smooth)
      return Connector(scene, collector_, scene.oiled ? none : lights_);
    else
      return Connector(scene, collector_, key);
  }

  /// Rays outside: to the environment, or through the interface into the body.
  void enter() {
    std::size_t i = 0;
    do {
      for (; i < arriving_.size(); ++i) arrive_outside(arriving_[i]);
      if constexpr (!smooth) cross_rough(true);  // what it sends may arrive again
    } while (i < arriving_.size());
    arriving_.clear();
  }

  void arrive_outside(Path path) {
    Hit hit;
    if (!shape_.enter(path.p, path.d, hit)) return escape(path);
    path.p = hit.p;
    path.n = hit.n;
    collector_.note("enter", path);
    if (!count_event(path)) return;
    if (is_smooth_at(path))
      enter_smooth(path);
    else if constexpr (!smooth)
      enter_rough(path);
  }

  // ---- inside the body (tracer_walk.h)

  /// Flights inside until the boundary.
  void walk();
  void walk_together();
  /// 1 - |p|^2 of a walk's start.
  static double depth2(const Path& path) {
    return path.p == path.n ? 0 : std::fmax(0.0, 1 - length_squared(path.p));
  }
  /// Where walks of many have come to the boundary.
  void arrive(const SphereWalk::Arrivals& arrivals, std::span<const Path> paths);
  /// To the boundary; false for a path that lost its way.
  bool cross_body(Path& path, Hit& hit);
  /// `collide(surroundings)` gives the particle its new direction.
  template <class Place, class Collide>
  bool walk_to_boundary(const Place& body, const Medium& medium, Particle& particle, Rng& rng,
                        Hit& hit, Collide&& collide);

  /// At a collision.
  void collide(Path& path) {
    if constexpr (connecting)
      path.colliding = true;
    else
      scatter(shape_, interior_.medium, path, path.sampler.rng());
  }

  /// Paths inside at the boundary: what leaves is collected with its weight, what stays walks on.
  void boundary() {
    if constexpr (open) {
      for (Path& path : leaving_) {
        if (!count_event(path)) continue;
        if (is_smooth_at(path)) {
          leave_smooth(path);
          if (path.survives()) walking_.push_back(path);
        } else if constexpr (!smooth) {
          leave_rough(path);
        }
      }
      if constexpr (!smooth) cross_rough(false);
    }
    leaving_.clear();
  }

  // ---- the smooth interface (tracer_smooth.h)

  void enter_smooth(Path path);
  /// The light that crosses the body unscattered, all of it; what is scattered on the way goes to
  /// walk() as one path.
  void follow_unscattered(Path path);
  /// Whether all light is reflected here, and again at every other place until it is scattered.
  bool traps(const Path& path) const;
  /// From total reflection to the next collision, over all reflections between.
  void roll(Path& path);
  /// At the boundary from inside: sends out the transmitted share, keeps the reflected one.
  void leave_smooth(Path& path);

  // ---- the rough interface (tracer_rough.h)

  void enter_rough(Path path);
  void leave_rough(const Path& path);
  /// Has the path wait at the interface, for others to cross with it.
  void await_crossing(const Path& path, bool from_outside);
  /// All that wait, from microfacet to microfacet: what escapes outwards is sent out, and one of
  /// the rays that escape into the body stands for all of them.
  void cross_rough(bool from_outside);
  /// What left at the collisions just made.
  void send_out(std::uint32_t lights_each);

  // ---- light that leaves in all directions (tracer_diffuse.h)

  /// The body right below the interface at path.p.
  const InterfacedLambertian& diffuse_base(const Path& path) const {
    if constexpr (lambertian && !smooth)
      if (is_smooth_at(path)) return interior_.oiled;
    return interior_.base;
  }
  /// What the background below path.p sends back through the interface, all that came in.
  void return_diffuse(Path& path);
  /// What the body sends out at a point, of light that went in there or elsewhere: one sample for
  /// plastic's diffuse half and the dipole together (dipole.h).
  void enter_dipole(Path& arriving);

  // ---- between stages

  /// Next-event estimation at a rough exit (tracer_escapes.h): a direction of the environment,
  /// weighted by the balance heuristic (Veach 1995) against those that the interface samples
  /// itself.
  template <class Evaluate>
  void connect(Path& path, const Frame& frame, Evaluate&& evaluate);

  /// Into the body.
  void inward(Path& path) {
    if (!path.survives()) return;
    if constexpr (smooth && !dense) {
      follow_unscattered(path);
    } else {
      path.roulette =
          (scattering || dense ? roulette_of_scattered : roulette_of_rough) * path.weight;
      walking_.push_back(path);
    }
  }

  /// Out of the body: to the environment, or where the body may be hit again, back to enter().
  void leave(Path& from, Vec3 direction, double weight, double pdf) {
    Path path = from;
    path.d = direction;
    path.weight = weight;
    path.pdf = pdf;
    if (!may_come_back_) return escape(path);
    path.sampler = from.sampler.split();
    go_back(path);
  }

  /// Towards the body once more.
  void go_back(Path& path) {
    // A model that gains energy has no answer in deep cavities: the branches must not multiply.
    if constexpr (dipole) {
      if (++path.arrivals > 2) path.roulette = 1;
      if (path.arrivals > dipole_arrival_cap) return collector_.give_up(path);
    }
    if (path.survives()) arriving_.push_back(path);
  }

  /// A path that leaves towards the backdrop (tracer_backdrop.h): collects its light, or sends it
  /// back.
  void meet_backdrop(const Path& path);
  /// From a print, in all directions.
  void leave_print(Path path);

  struct Escape {
    Vec3 n;
    double length, weight, pdf;
    std::uint32_t walk, pixel, tint;
  };
  struct Escapes {
    EnvironmentBatch batch;
    std::array<Escape, EnvironmentBatch::capacity> from;
  };

  /// To the environment, where many look together (tracer_escapes.h).
  void escape(const Path& path);
  void collect(Escapes& escapes);

  void arrive_inside(Path& path, const Hit& hit) {
    path.length += hit.t;
    path.p = hit.p;
    path.n = hit.n;
    collector_.note("boundary", path);
  }

  bool is_smooth_at(const Path& path) const {
    return smooth || (scene_.oiled && scene_.oiled->covers(path.p));
  }

  bool count_event(Path& path) {
    ++tile_.counters.boundary_events;
    if (++path.events < (scattering ? scattering_event_cap : clear_event_cap)) return true;
    collector_.give_up(path);
    return false;
  }

  /// A path that slipped out of a mesh by rounding would walk for ever.
  static bool strayed(const Particle& particle) {
    if constexpr (std::is_same_v<Shape, Mesh> && !dense) return length_squared(particle.p) > 1.01;
    return false;
  }

  const Scene& scene_;
  const Shape& shape_;
  const Interface& interface_;
  const Interior& interior_;
  Tile& tile_;
  Collector collector_;
  LightList lights_;    ///< of the rough interface
  bool may_come_back_;  ///< whether what leaves may arrive again
  Connector connector_;
  std::conditional_t<connecting, SphereWalk, std::monostate> sphere_walk_;
  /// What was never inside waits apart from the rest: sums of floats depend on their order, and a
  /// black body traced alone must have the bits of a black lane.
  std::array<Escapes, 2> escapes_;
  std::vector<Path>&arriving_, &walking_, &leaving_;
  std::vector<Path>& crossing_;  ///< at the rough interface
  MicrosurfaceBatch microsurface_;
};

/// Of what the paths of a tile share, a few samples at a time.
inline std::uint64_t shared_key(const Scene& scene, std::uint32_t pass_index, std::uint32_t first,
                                const Tile& tile) {
  const std::uint64_t batch = hash_combine(pass_index, first / samples_at_once);
  return hash_combine(hash_combine(scene.seed, tile.index), batch);
}

template <class Shape>
void trace_body(const Shape& shape, const Scene& scene, std::uint32_t pass_index,
                std::uint32_t first, std::uint32_t count, Tile& tile, std::string* log) {
  std::visit(
      [&](const auto& interface, const auto& interior) {
        Tracer(scene, shape, interface, interior, tile, shared_key(scene, pass_index, first, tile),
               log)
            .run(pass_index, first, count);
      },
      scene.interface, scene.interior);
}

}  // namespace translucube

#include "renderer/transport/tracer_backdrop.h"
#include "renderer/transport/tracer_diffuse.h"
#include "renderer/transport/tracer_escapes.h"
#include "renderer/transport/tracer_rough.h"
#include "renderer/transport/tracer_smooth.h"
#include "renderer/transport/tracer_walk.h"

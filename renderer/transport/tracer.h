#pragma once

// Light transport in the cube, backwards from the camera. What is carried is an achromatic weight
// and the length travelled inside the body; absorption comes with the film's lanes. In stages, each
// one loop over a queue of paths:
//
//   emit    camera samples                                                  emit.inl
//   enter   rays outside: to where they hit the body, and a share goes in   enter.inl
//   walk    flights inside, from scatterer to scatterer, to the boundary    walk.inl
//   leave   paths inside at the boundary: a share goes out, the rest walks  leave.inl
//   escape  what went out for good: to the environment or the backdrop      escape.inl
//
// and between them, where light
//
//   crosses a rough interface, from microfacet to microfacet                cross.inl
//   comes back in all directions: a Lambertian body, the dipole             diffuse.inl
//
// At a smooth boundary both branches are followed; the light that no particle deflects is
// enumerated, not sampled, and one scattered path stands for all that is deflected on the way (a
// reservoir of one: Chao 1982). Paths of small weight are played out by Russian roulette, so that
// the branches in flight stay bounded.
//
// Light that differs between directions is found by escape, and looked for as well (next-event
// estimation). It counts once: by the balance heuristic (Veach 1995), or because one of the two
// ways leaves it to the other. Three estimators look for it:
//
//   direct light      where light goes out in all directions (Lambertian    diffuse.inl,
//                     body, dipole, print): one light for each path         escape.inl
//   microfacet light  at each collision with a microfacet, on either side   cross.inl
//                     of the interface: eight lights of the tile's list
//   connections       from scatterers through the boundary, smooth or       walk.inl,
//                     rough                                                 sphere/*_connector.h,
//                                                                           boundary/
//
// What runs inside, by interior and shape:
//
//                  sphere                               any other shape
//   black          nothing                              the same
//   clear          straight flights                     the same
//   dipole         straight flights, return_dipole()    the same
//   Lambertian     return_diffuse()                     the same
//   dense pigment  walk_alone() in a half space         the same
//   scattering     walk_together(), in SIMD;            walk_alone(), in a mesh with a Clearing;
//                  vertices connect to lights by        vertices connect by FacetConnector (but in
//                  SmoothConnector or RoughConnector    a bowl) or MicrofacetConnector

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <type_traits>
#include <variant>

#include "renderer/light/lighting.h"
#include "renderer/optics/lambertian.h"
#include "renderer/optics/microsurface_batch.h"
#include "renderer/transport/body.h"
#include "renderer/transport/collector.h"
#include "renderer/transport/incident_point.h"
#include "renderer/transport/path.h"
#include "renderer/transport/sphere/sphere_walk.h"
#include "renderer/transport/transport.h"

namespace translucube {

/// Boundary events after which a path is given up and its weight counted as truncated energy: only
/// light that is trapped gets there, for good (a camera inside a clear body) or, in a mesh, for
/// nearly as long (a medium of millions of bounding radii to the mean free path).
inline constexpr std::uint32_t clear_event_cap = 20'000, scattering_event_cap = 2'000'000;

template <class Body>
class Tracer {
  static constexpr double infinity = std::numeric_limits<double>::infinity();
  using Connector = typename Body::Connector;
  static constexpr bool facetted = Body::connects_alone && Body::smooth;

 public:
  Tracer(const Scene& scene, const Body& body, Tile& tile, std::uint64_t key,
         const Patience& patience, std::string* log)
      : scene_(scene),
        shape_(body.shape),
        interface_(body.interface),
        interior_(body.interior),
        tile_(tile),
        collector_(scene, tile, log),
        patience_(patience),
        lights_(lights_of(scene, key)),
        may_come_back_(!shape_.convex() ||
                       (scene.backdrop && scene.backdrop->kind == BackdropKind::print)),
        connector_(make_connector(scene, key)),
        entering_(tile.queues.entering),
        walking_(tile.queues.walking),
        leaving_(tile.queues.leaving),
        crossing_(tile.queues.crossing) {}

  void run(const SampleRange& samples) {
    for (std::uint32_t i = 0; i < samples.count; ++i) emit(samples.pass_index, samples.first + i);
    while (!entering_.empty() || !walking_.empty()) {
      enter();
      walk();
      leave();
    }
    connector_.flush();
    for (Escapes& escapes : escapes_) meet_environment(escapes);
    collector_.flush();
  }

 private:
  static LightList lights_of(const Scene& scene, std::uint64_t key) {
    return Body::smooth ? LightList() : LightList(scene.environment, key);
  }

  Connector make_connector(const Scene& scene, std::uint64_t key) {
    // Vertices connect through one interface: where there are two, the walk finds the light.
    static const LightList none;
    const LightList& lights = scene.oiled ? none : lights_;
    if constexpr (!Body::connects || (Body::walks_together && Body::smooth))
      return Connector(scene, collector_, key);
    else if constexpr (Body::walks_together)
      return Connector(scene, collector_, lights);
    else if constexpr (Body::smooth)
      return Connector(scene, shape_, collector_, key);
    else
      return Connector(scene, shape_, collector_, lights);
  }

  // ---- emit.inl

  void emit(std::uint32_t pass_index, std::uint32_t sample);

  // ---- enter.inl

  void enter();
  void arrive_outside(Path path);
  /// Follows the reflected and the refracted branch.
  void enter_smooth(Path path);
  /// Starts a path inside, d its direction there.
  void go_in(Path& path);

  // ---- walk.inl

  void walk();
  void walk_together();
  /// Takes over the walks that have come to the boundary together.
  void arrive(const SphereWalk::Arrivals& arrivals, std::span<const Path> paths);
  /// Finds where a path comes to the boundary; false if it lost its way.
  bool walk_alone(Path& path, Hit& hit);
  /// `around`: the place as a walk asks it; `collide`: what happens between flights.
  template <class Place, class Around, class Moving, class Collide>
  bool walk_to_boundary(const Place& place, Around&& around, const Medium& medium, Moving& moving,
                        Rng& rng, Hit& hit, Collide&& collide);
  /// At a collision: looks for light, then a new direction or a large step.
  template <class Place>
  void collide_alone(Place&& around, Path& path);
  /// Follows all the light that crosses the body unscattered, up to its end; what is scattered on
  /// the way goes to walk() as one path.
  void follow_unscattered(Path path);
  void start_walks(const Path& scattered, double weight, PathSampler& sampler);
  /// Gives a path at a collision its new direction, or leaves that to the walk.
  void collide(Path& path);
  void arrive_inside(Path& path, const Hit& hit);

  // ---- leave.inl

  void leave();
  /// Sends out the transmitted share, keeps the reflected one.
  void leave_smooth(Path& path);
  /// Whether all light is reflected here, and again at every other place until it is scattered.
  bool traps(const Path& path) const;
  /// Moves a path from total reflection to its next collision, over all reflections between.
  void roll(Path& path);
  /// Starts a path outside: it escapes or, where the body may be hit again, goes back.
  void go_out(Path& from, Vec3 direction, double weight, double pdf);
  /// Has a path enter once more.
  void go_back(Path& path);

  // ---- cross.inl

  /// Has a path wait at the interface, for others to cross with it.
  void await_crossing(const Path& path, bool from_outside);
  /// Takes all that wait from microfacet to microfacet: what escapes outwards is sent out, and one
  /// of the rays that escape into the body stands for all of them.
  void cross_rough(bool from_outside);
  /// Sends out what left at the collisions just made.
  void send_out(std::uint32_t lights_each);
  void go_on_inside(Path& path, bool from_outside);

  // ---- diffuse.inl

  /// The body right below the interface at path.p.
  const InterfacedLambertian& diffuse_base(const Path& path) const;
  /// Sends out what the background below path.p sends back through the interface, all that came in.
  void return_diffuse(Path& path);
  /// Sends out what the body does at a point, of light that went in there or elsewhere: one sample
  /// for plastic's diffuse half and the dipole together (dipole.h).
  void return_dipole(Path& arriving);
  /// Looks for a light of the environment, weighted by the balance heuristic against the directions
  /// that the body samples itself.
  void add_direct_light(Path& path, const Frame& frame, const InterfacedLambertian& base);

  // ---- escape.inl

  struct Escape {
    Vec3 n;
    double length, weight, pdf;
    std::uint32_t start, pixel, tint;
    Rgb near;  ///< of lamps near by
    struct Nothing {};
    struct Flight {
      Path::Vertex from;
      Vec3 d;
    };
    [[no_unique_address]] std::conditional_t<facetted, Flight, Nothing> flight{};
  };
  struct Escapes {
    EnvironmentBatch batch;
    std::array<Escape, EnvironmentBatch::capacity> from;
  };
  void escape(const Path& path);
  void meet_environment(Escapes& escapes);
  /// Collects the backdrop's light, or sends the path back.
  void meet_backdrop(const Path& path);
  /// Sends a path back from a print, in any direction.
  void reflect_from_print(Path path);

  // ---- at any boundary

  /// Whether the body itself hides what lies along d from a point of its surface.
  bool hides(Vec3 p, Vec3 d) const {
    Hit hit;
    return !shape_.convex() && shape_.intersect_outside(p, d, hit);
  }

  bool is_smooth_at(const Path& path) const {
    return Body::smooth || (scene_.oiled && scene_.oiled->covers(path.p));
  }

  /// Whether the time is over, once asked in `every` (a power of two) calls.
  bool out_of_time(std::uint32_t every) {
    if ((++asked_ & (every - 1)) == 0 && patience_.over()) over_ = true;
    return over_;
  }

  bool count_event(Path& path) {
    ++tile_.counters.boundary_events;
    if (!out_of_time(64) &&
        ++path.events < (Body::inside.scatters ? scattering_event_cap : clear_event_cap))
      return true;
    collector_.give_up(path);
    return false;
  }

  const Scene& scene_;
  const typename Body::Shape& shape_;
  const typename Body::Interface& interface_;
  const typename Body::Interior& interior_;
  Tile& tile_;
  Collector collector_;
  const Patience& patience_;
  std::uint32_t asked_ = 0;
  bool over_ = false;   ///< all paths are given up
  LightList lights_;    ///< for microfacets
  bool may_come_back_;  ///< whether what leaves may arrive again
  Connector connector_;
  std::conditional_t<Body::walks_together, SphereWalk, std::monostate> sphere_walk_;
  /// Paths that were never inside wait apart from the rest: sums of floats depend on their order,
  /// and a black body traced alone must have the bits of a black lane.
  std::array<Escapes, 2> escapes_;
  std::vector<Path>&entering_, &walking_, &leaving_;
  std::vector<Path>& crossing_;  ///< at the rough interface
  MicrosurfaceBatch microsurface_;
};

}  // namespace translucube

#include "renderer/transport/cross.inl"
#include "renderer/transport/diffuse.inl"
#include "renderer/transport/emit.inl"
#include "renderer/transport/enter.inl"
#include "renderer/transport/escape.inl"
#include "renderer/transport/leave.inl"
#include "renderer/transport/trace_body.inl"
#include "renderer/transport/walk.inl"

// Flights inside the body: those in a sphere together, in SIMD, all others one after the other.

namespace translucube {

/// Below this scattering coefficient [1 / unit] a walk is so short that a camera sample starts two.
inline constexpr double short_walk_sigma_s = 2;

template <class Body>
void Tracer<Body>::walk() {
  if constexpr (Body::walks_together) {
    walk_together();
  } else if constexpr (Body::lets_in) {
    for (Path& path : walking_) {
      Hit hit;
      if (!walk_alone(path, hit)) {
        collector_.give_up(path);
        continue;
      }
      arrive_inside(path, hit);
      leaving_.push_back(path);
    }
  }
  walking_.clear();
}

template <class Body>
void Tracer<Body>::walk_together() {
  const WalkMedium medium = connector_.walk_medium();
  for (std::size_t first = 0; first < walking_.size(); first += SphereWalk::capacity) {
    const std::span<Path> paths(&walking_[first],
                                std::min(SphereWalk::capacity, walking_.size() - first));
    if (out_of_time(1)) {
      for (const Path& path : paths) collector_.give_up(path);
      continue;
    }
    for (std::size_t i = 0; i < paths.size(); ++i) {
      Path& path = paths[i];
      const double depth2 = path.on_unit_sphere() ? 0 : std::fmax(0.0, 1 - length_squared(path.p));
      sphere_walk_.push(static_cast<std::uint32_t>(i), path.p, depth2, path.d, path.colliding,
                        path.sampler.rng().bits());
    }
    while (sphere_walk_.under_way() > 0) {
      tile_.counters.flights += sphere_walk_.under_way();
      sphere_walk_.advance(medium);
      connector_.connect(sphere_walk_.vertices(), paths);
      arrive(sphere_walk_.arrivals(), paths);
      if (out_of_time(8))
        sphere_walk_.abandon([&](std::uint32_t slot) { collector_.give_up(paths[slot]); });
    }
  }
}

template <class Body>
void Tracer<Body>::arrive(const SphereWalk::Arrivals& arrivals, std::span<const Path> paths) {
  for (std::size_t i = 0; i < arrivals.size; ++i) {
    Path& path = leaving_.emplace_back(paths[arrivals.slot[i]]);
    path.p = path.n = arrivals.n[i];
    path.d = arrivals.d[i];
    path.length += arrivals.length[i];
    path.vertex = {arrivals.from[i], arrivals.from_depth2[i], arrivals.flight[i],
                   arrivals.phase[i]};
    path.colliding = false;
    collector_.note("boundary", path);
  }
}

template <class Body>
bool Tracer<Body>::walk_alone(Path& path, Hit& hit) {
  Rng& rng = path.sampler.rng();
  if (over_) return false;
  path.vertex = {};
  if constexpr (Body::inside.scatters) {
    auto&& around = surroundings(shape_, interior_.medium);
    if (path.colliding) collide_alone(around, path);
    path.colliding = false;
    const auto collide = [&](Path& at) { collide_alone(around, at); };
    if (!walk_to_boundary(shape_, around, interior_.medium, path, rng, hit, collide)) return false;
    if (path.vertex.connected()) path.vertex.flight = hit.t;
    return true;
  } else if constexpr (Body::inside.half_space) {
    // In the half space below the point where it entered, to leave at that very point.
    const Frame frame(path.n);
    Particle below{{}, frame.to_local(path.d), path.length};
    constexpr HalfSpace place;
    const auto collide = [&](Particle& at) { scatter(place, interior_.medium, at, rng); };
    if (!walk_to_boundary(place, place, interior_.medium, below, rng, hit, collide)) return false;
    path.d = frame.to_world(below.d);
    path.length = below.length;
    hit.p = path.p;
    hit.n = path.n;
    return true;
  } else {
    return shape_.intersect_inside(path.p, path.d, infinity, hit);
  }
}

template <class Body>
template <class Place, class Around, class Moving, class Collide>
bool Tracer<Body>::walk_to_boundary(const Place& place, Around&& around, const Medium& medium,
                                    Moving& moving, Rng& rng, Hit& hit, Collide&& collide) {
  ++tile_.counters.flights;
  while (fly(around, medium, moving, rng, hit)) {
    ++tile_.counters.flights;
    if (strayed(place, moving) || out_of_time(256)) return false;
    collide(moving);
  }
  return true;
}

template <class Body>
template <class Place>
void Tracer<Body>::collide_alone(Place&& around, Path& path) {
  const Medium& medium = interior_.medium;
  Rng& rng = path.sampler.rng();
  path.vertex = {};
  if constexpr (Body::connects_alone) {
    if (large_step(around, medium, path, rng, connector_.margin())) return;
    if (!connector_.active()) {
      path.d = medium.scatter(path.d, rng);
      return;
    }
    connector_.connect(path, rng);
    const Vec3 before = path.d;
    path.d = medium.scatter(path.d, rng);
    path.vertex = {.p = path.p, .phase = medium.phase(dot(before, path.d)), .d = path.d};
  } else {
    scatter(around, medium, path, rng);
  }
}

template <class Body>
void Tracer<Body>::follow_unscattered(Path path) {
  Path scattered;
  double scattered_weight = 0;
  Rng& rng = path.sampler.rng();
  while (true) {
    Hit hit;
    if (!shape_.intersect_inside(path.p, path.d, infinity, hit)) {
      collector_.give_up(path);
      break;
    }
    if constexpr (Body::inside.scatters) {
      const double sigma_s = interior_.medium.sigma_s;
      const double deflected = -std::expm1(-sigma_s * hit.t);
      const double weight = path.weight * deflected;
      scattered_weight += weight;
      ++tile_.counters.flights;
      if (rng.uniform() * scattered_weight < weight) {
        const double s = -std::log1p(-rng.uniform() * deflected) / sigma_s;
        scattered = path;
        scattered.p = path.p + std::fmin(s, hit.t) * path.d;
        scattered.length += std::fmin(s, hit.t);
      }
      path.weight *= std::exp(-sigma_s * hit.t);
      if (!path.survives()) break;
    }
    arrive_inside(path, hit);
    if (!count_event(path)) break;
    if (traps(path)) {
      scattered_weight += path.weight;
      if (rng.uniform() * scattered_weight < path.weight) {
        scattered = path;
        roll(scattered);
      }
      break;
    }
    leave_smooth(path);
    if (!path.survives()) break;
  }
  if constexpr (Body::inside.scatters)
    if (scattered_weight > 0) start_walks(scattered, scattered_weight, path.sampler);
}

template <class Body>
void Tracer<Body>::start_walks(const Path& scattered, double weight, PathSampler& sampler) {
  const int walks = interior_.medium.sigma_s < short_walk_sigma_s ? 2 : 1;
  for (int i = 0; i < walks; ++i) {
    Path path = scattered;
    path.weight = weight / walks;
    // Its own numbers from here on: those that it was copied with have decided over others since.
    path.sampler = sampler.split();
    if (!path.survives()) continue;
    path.play_below(roulette_of_scattered);
    collector_.note("scatter", path);
    connector_.start(path);
    collide(path);
    walking_.push_back(path);
  }
}

template <class Body>
void Tracer<Body>::collide(Path& path) {
  path.colliding = true;
}

template <class Body>
void Tracer<Body>::arrive_inside(Path& path, const Hit& hit) {
  path.length += hit.t;
  path.p = hit.p;
  path.n = hit.n;
  collector_.note("boundary", path);
}

}  // namespace translucube

// Paths inside at the boundary: what leaves is collected with its weight, what stays walks on.

namespace translucube {

/// In the dipole model, times that light may come back to the body from outside before its path is
/// given up.
inline constexpr std::uint32_t dipole_arrival_cap = 16;

template <class Body>
void Tracer<Body>::leave() {
  if constexpr (Body::lets_in) {
    for (Path& path : leaving_) {
      if (!count_event(path)) continue;
      if (is_smooth_at(path)) {
        leave_smooth(path);
        if (path.survives()) walking_.push_back(path);
      } else if constexpr (!Body::smooth) {
        await_crossing(path, false);
      }
    }
    if constexpr (!Body::smooth) cross_rough(false);
  }
  leaving_.clear();
}

template <class Body>
void Tracer<Body>::leave_smooth(Path& path) {
  if (traps(path)) {
    roll(path);
    if constexpr (Body::inside.scatters) collide(path);
    return;
  }
  const double reflectance = fresnel(dot(path.d, path.n), 1 / interface_.ior);
  if (reflectance < 1) {
    const Vec3 out = *refract(-path.d, -path.n, 1 / interface_.ior);
    double pdf = Path::not_looked_for;
    if constexpr (Body::smooth && !facetted) pdf = connector_.pdf(path);
    go_out(path, out, path.weight * (1 - reflectance), pdf);
  }
  path.weight *= reflectance;
  path.d = reflect(-path.d, path.n);
}

template <class Body>
bool Tracer<Body>::traps(const Path& path) const {
  if constexpr (Body::smooth && Body::rolls)
    return fresnel(dot(path.d, path.n), 1 / interface_.ior) == 1;
  return false;
}

template <class Body>
void Tracer<Body>::roll(Path& path) {
  if constexpr (Body::rolls) {
    const double flight = interior_.medium.sample_flight(path.sampler.rng());
    path.d = reflect(-path.d, path.n);
    Sphere::roll(path.p, path.d, flight);
    path.length += flight;
    ++tile_.counters.flights;
  }
}

template <class Body>
void Tracer<Body>::go_out(Path& from, Vec3 direction, double weight, double pdf) {
  Path path = from;
  path.d = direction;
  path.weight = weight;
  path.pdf = pdf;
  if (!may_come_back_) return escape(path);
  path.sampler = from.sampler.split();
  go_back(path);
}

template <class Body>
void Tracer<Body>::go_back(Path& path) {
  ++path.arrivals;
  if (path.arrivals > returns_before_floor)
    path.roulette = std::max(path.roulette, roulette_of_returned);
  // A model that gains energy has no answer in deep cavities: the branches must not multiply.
  if constexpr (Body::inside.dipole) {
    if (path.arrivals > 2) path.roulette = 1;
    if (path.arrivals > dipole_arrival_cap) return collector_.give_up(path);
  }
  if (path.survives()) entering_.push_back(path);
}

}  // namespace translucube

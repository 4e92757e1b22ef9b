// Rays outside: to the environment, or through the interface into the body.

namespace translucube {

template <class Body>
void Tracer<Body>::enter() {
  std::size_t i = 0;
  do {
    for (; i < entering_.size(); ++i) arrive_outside(entering_[i]);
    if constexpr (!Body::smooth) cross_rough(true);  // what it sends may arrive again
  } while (i < entering_.size());
  entering_.clear();
}

template <class Body>
void Tracer<Body>::arrive_outside(Path path) {
  Hit hit;
  if (!shape_.intersect_outside(path.p, path.d, hit)) return escape(path);
  path.p = hit.p;
  path.n = hit.n;
  path.vertex = {};
  collector_.note("enter", path);
  if (!count_event(path)) return;
  if (is_smooth_at(path)) {
    enter_smooth(path);
  } else if constexpr (!Body::smooth) {
    if constexpr (Body::inside.dipole) return_dipole(path);
    await_crossing(path, true);
  }
}

template <class Body>
void Tracer<Body>::enter_smooth(Path path) {
  const Vec3 wo = -path.d;
  const double reflectance = fresnel(dot(wo, path.n), interface_.ior);
  if constexpr (Body::inside.dipole) return_dipole(path);
  if (reflectance > 0)
    go_out(path, reflect(wo, path.n), path.weight * reflectance, Path::not_looked_for);
  if constexpr (Body::inside.diffuse) {
    path.weight *= 1 - reflectance;
    return_diffuse(path);
  }
  if constexpr (Body::lets_in) {
    if (reflectance == 1) return;
    path.d = *refract(wo, path.n, interface_.ior);
    path.weight *= 1 - reflectance;
    if constexpr (Body::inside.dipole) path.weight *= interior_.clear_share;
    path.pdf = Path::not_looked_for;
    go_in(path);
  }
}

template <class Body>
void Tracer<Body>::go_in(Path& path) {
  constexpr bool straight = !Body::inside.scatters && !Body::inside.half_space;
  if (!path.survives()) return;
  if constexpr (Body::smooth && Body::inside.open) {
    follow_unscattered(path);
  } else {
    path.play_below(straight ? roulette_of_rough : roulette_of_scattered);
    walking_.push_back(path);
  }
}

}  // namespace translucube

// Light that comes back in all directions: of the Lambertian body, and of the dipole model.

namespace translucube {

template <class Body>
const InterfacedLambertian& Tracer<Body>::diffuse_base(const Path& path) const {
  if constexpr (Body::inside.diffuse && !Body::smooth)
    if (is_smooth_at(path)) return interior_.oiled;
  return interior_.base;
}

template <class Body>
void Tracer<Body>::return_diffuse(Path& path) {
  path.length += shortest_length;  // it was inside
  const Frame frame(path.n);
  const InterfacedLambertian& base = diffuse_base(path);
  add_direct_light(path, frame, base);
  const Vec3 wi = InterfacedLambertian::sample(path.sampler.next2());
  const LobeValue value = base.emit(wi);
  if (value.f_cos > 0)
    go_out(path, frame.to_world(wi), path.weight * value.f_cos / value.pdf, value.pdf);
}

template <class Body>
void Tracer<Body>::return_dipole(Path& arriving) {
  const double all = interior_.here + interior_.elsewhere;
  if (all <= 0) return;
  Path path = arriving;
  const double cos_o = -dot(path.d, path.n), share_here = interior_.here / all;
  path.weight *= all;
  Sample2 u = path.sampler.next2();
  if (u.u < share_here) {
    if (interior_.absorbing)
      collector_.tint(path, interior_.colors,
                      [](const DipoleColor& color) { return color.total(); });
  } else {
    u.u = (u.u - share_here) / (1 - share_here);
    const IncidentPoint from =
        sample_incident_point(shape_, interior_.radii, path.p, path.n, u, path.sampler.rng());
    path.weight *= from.weight / interior_.radii.mass();
    arriving.sampler = path.sampler;
    if (from.lost) collector_.give_up(path);
    if (path.weight <= 0) return;
    path.p = from.p;
    path.n = from.n;
    if (interior_.absorbing)
      collector_.tint(path, interior_.colors,
                      [&](const DipoleColor& color) { return color.at(from.r); });
  }
  collector_.note("dipole", path);
  path.weight *= interior_.base.transmittance(cos_o);
  return_diffuse(path);
  arriving.sampler = path.sampler;
}

template <class Body>
void Tracer<Body>::add_direct_light(Path& path, const Frame& frame,
                                    const InterfacedLambertian& base) {
  if (scene_.environment.uniform()) return;
  const EnvironmentSample light = scene_.environment.sample(path.sampler.next2());
  ++tile_.counters.light_samples;
  const LobeValue value = base.emit(frame.to_local(light.direction));
  if (value.f_cos <= 0) return;
  if (hides(path.p, light.direction)) return;
  collector_.note("connect", path);
  collector_.collect(path,
                     light.value.radiance + scene_.environment.from_near(path.p, light.direction),
                     path.weight * value.f_cos / (light.value.pdf + value.pdf));
}

}  // namespace translucube

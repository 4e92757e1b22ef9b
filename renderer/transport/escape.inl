// Paths that went out for good: to the environment, where many look together, or to the backdrop.

namespace translucube {

template <class Body>
void Tracer<Body>::escape(const Path& path) {
  collector_.note("escape", path);
  if (scene_.backdrop && scene_.backdrop->faces(path.d)) {
    meet_backdrop(path);
    // Nothing of the environment, but a connection may have taken its share of nothing.
    if ((path.pdf == Path::not_looked_for && !scene_.environment.has_near()) ||
        scene_.environment.uniform())
      return;
  }
  if (const UniformEnvironment* uniform = scene_.environment.uniform())
    return collector_.collect(path, uniform->radiance, path.weight);
  if constexpr (Body::walks_together && Body::smooth)
    if (path.pdf == Path::found_by_connecting)
      return collector_.collect_carried(
          path.pixel, path.length, path.tint,
          connector_.expected(path.n, path.start) * static_cast<float>(path.weight));
  Escapes& escapes = escapes_[path.length > 0 ? 1 : 0];
  EnvironmentBatch& batch = escapes.batch;
  const std::size_t i = batch.size++;
  batch.direction.set(i, path.d);
  escapes.from[i] = {
      path.n,     path.length, path.weight, path.pdf,
      path.start, path.pixel,  path.tint,   scene_.environment.from_near(path.p, path.d)};
  if constexpr (facetted) escapes.from[i].flight = {path.vertex, path.vertex.d};
  if (batch.size == EnvironmentBatch::capacity) meet_environment(escapes);
}

template <class Body>
void Tracer<Body>::meet_environment(Escapes& escapes) {
  EnvironmentBatch& batch = escapes.batch;
  if (batch.size == 0) return;
  scene_.environment.look_up(batch);
  for (std::size_t i = 0; i < batch.size; ++i) {
    const Escape& from = escapes.from[i];
    const EnvironmentValue& light = batch.value[i];
    Rgb radiance = light.radiance + from.near;
    if constexpr (facetted) {
      const Path::Vertex& vertex = from.flight.from;
      if (vertex.connected())
        radiance = radiance * static_cast<float>(
                                  connector_.share_of_walk(vertex, from.flight.d, from.n, light));
    } else if (from.pdf != Path::not_looked_for) {
      const auto share = static_cast<float>(from.pdf / (from.pdf + light.pdf));
      if constexpr (Body::walks_together && Body::smooth) {
        const Rgb expected = connector_.expected(from.n, from.start) * Connector::far_share;
        radiance = expected + (radiance - expected) * share;
      } else {
        radiance = radiance * share;
      }
    }
    collector_.collect(from.pixel, from.length, from.tint,
                       radiance * static_cast<float>(from.weight));
  }
  batch.size = 0;
}

template <class Body>
void Tracer<Body>::meet_backdrop(const Path& path) {
  const Backdrop& backdrop = *scene_.backdrop;
  const Vec3 p = backdrop.meet(path.p, path.d);
  const float value = backdrop.value(p);
  if (backdrop.kind == BackdropKind::light_table)
    return collector_.collect(path, {value, value, value}, path.weight);
  Path reflected = path;
  reflected.p = p;
  reflected.n = backdrop.normal();
  reflected.weight *= value;
  reflected.pdf = Path::not_looked_for;
  reflected.vertex = {};
  if (reflected.weight > 0) reflect_from_print(reflected);
}

template <class Body>
void Tracer<Body>::reflect_from_print(Path path) {
  // Light that falls on the print straight from the environment is looked for; what comes by way of
  // the body is found by going there.
  collector_.note("print", path);
  const UniformEnvironment* uniform = scene_.environment.uniform();
  Hit hit;
  if (!uniform) {
    const EnvironmentSample light = scene_.environment.sample(path.sampler.next2());
    ++tile_.counters.light_samples;
    const double cosine = dot(light.direction, path.n);
    if (cosine > 0 && light.value.pdf > 0 &&
        !shape_.intersect_outside(path.p, light.direction, hit))
      collector_.collect(
          path, light.value.radiance + scene_.environment.from_near(path.p, light.direction),
          path.weight * cosine / (std::numbers::pi * light.value.pdf));
  }
  path.d = Frame(path.n).to_world(InterfacedLambertian::sample(path.sampler.next2()));
  if (shape_.intersect_outside(path.p, path.d, hit)) return go_back(path);
  if (uniform) collector_.collect(path, uniform->radiance, path.weight);
}

}  // namespace translucube

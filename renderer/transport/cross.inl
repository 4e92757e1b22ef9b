// The rough boundary, from either side: from microfacet to microfacet, many paths at a time.

namespace translucube {

/// Lights that a collision with a microfacet looks for.
inline constexpr std::uint32_t lights_of_a_collision = 8;

template <class Body>
void Tracer<Body>::await_crossing(const Path& path, bool from_outside) {
  crossing_.push_back(path);
  PathSampler& sampler = crossing_.back().sampler;
  microsurface_.push(from_outside ? path.n : -path.n, path.d, sampler.next2(), sampler.rng().bits(),
                     Body::connects && !from_outside && path.vertex.connected());
  if (crossing_.size() == MicrosurfaceBatch::capacity) cross_rough(from_outside);
}

template <class Body>
void Tracer<Body>::cross_rough(bool from_outside) {
  const double ior = interface_.ior;
  const BatchInterface interface {
    static_cast<float>(interface_.microfacets.alpha),
        static_cast<float>(from_outside ? ior : 1 / ior), from_outside,
        interface_.multiple_scattering
  };
  const std::uint32_t lights_each = lights_.empty() ? 0 : lights_of_a_collision;
  std::array<Rgb, MicrosurfaceBatch::capacity> found{};
  microsurface_.start(interface);
  while (microsurface_.under_way() > 0) {
    tile_.counters.light_samples += lights_each * microsurface_.under_way();
    microsurface_.collide(interface, lights_, lights_each);
    const MicrosurfaceBatch::Lit& lit = microsurface_.lit();
    for (std::size_t i = 0; i < lit.size; ++i) {
      const Vec3 direction = lights_.direction[lit.light[i]];
      const Vec3 p = crossing_[lit.slot[i]].p;
      if (hides(p, direction)) continue;
      found[lit.slot[i]] +=
          (lights_.radiance[lit.light[i]] + scene_.environment.from_near(p, direction)) *
          lit.share[i];
    }
    send_out(lights_each);
  }
  for (std::size_t i = 0; i < crossing_.size(); ++i) {
    Path& path = crossing_[i];
    collector_.collect(path, found[i], path.weight);
    if constexpr (Body::lets_in || Body::inside.diffuse) {
      path.weight *= microsurface_.inward_weight(i);
      path.pdf = Path::not_looked_for;
      path.d = microsurface_.inward(i);
      if (path.weight > 0) go_on_inside(path, from_outside);
    }
  }
  crossing_.clear();
}

template <class Body>
void Tracer<Body>::go_on_inside(Path& path, bool from_outside) {
  if (!from_outside) {
    if (path.survives()) walking_.push_back(path);
    return;
  }
  if constexpr (Body::inside.dipole) path.weight *= interior_.clear_share;
  if constexpr (Body::inside.diffuse) return_diffuse(path);
  if constexpr (Body::lets_in)
    if (path.weight > 0) go_in(path);
}

template <class Body>
void Tracer<Body>::send_out(std::uint32_t lights_each) {
  const MicrosurfaceBatch::Sent& sent = microsurface_.sent();
  const float* ways = nullptr;
  if constexpr (Body::connects) {
    for (std::size_t i = 0; i < sent.size; ++i)
      if (sent.connected[i] > 0)
        connector_.push_way(crossing_[sent.slot[i]], sent.direction[i], sent.pdf[i]);
    ways = connector_.weigh_ways().data();
  }
  for (std::size_t i = 0; i < sent.size; ++i) {
    Path& path = crossing_[sent.slot[i]];
    const double pdf = sent.connected[i] > 0 ? *ways++ : sent.pdf[i] / lights_each;
    go_out(path, sent.direction[i], path.weight * sent.weight[i],
           lights_each > 0 ? pdf : Path::not_looked_for);
  }
}

}  // namespace translucube

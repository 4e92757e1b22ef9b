// The transport's door: a tracer for the interface and the interior that a scene has.

namespace translucube {

/// The key of what the paths of a tile share, a few samples at a time.
inline std::uint64_t shared_key(const Scene& scene, const SampleRange& samples, const Tile& tile) {
  const std::uint64_t batch = hash_combine(samples.pass_index, samples.first / samples_at_once);
  return hash_combine(hash_combine(scene.seed, tile.index), batch);
}

template <class Shape>
void trace_body(const Shape& shape, const Scene& scene, const SampleRange& samples, Tile& tile,
                const Patience& patience, std::string* log) {
  std::visit(
      [&](const auto& interface, const auto& interior) {
        Tracer(scene, Body{shape, interface, interior}, tile, shared_key(scene, samples, tile),
               patience, log)
            .run(samples);
      },
      scene.interface, scene.interior);
}

}  // namespace translucube

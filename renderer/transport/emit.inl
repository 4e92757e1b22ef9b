// Camera samples: one for each pixel of the tile.

namespace translucube {

template <class Body>
void Tracer<Body>::emit(std::uint32_t pass_index, std::uint32_t sample) {
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
        entering_.push_back(path);
      } else if constexpr (Body::inside.open) {
        go_in(path);
      }
    }
}

}  // namespace translucube

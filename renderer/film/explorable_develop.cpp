#include "renderer/film/explorable_develop.h"

#include <algorithm>
#include <thread>

#include "renderer/base/half.h"

namespace translucube {
namespace {

using Operator = std::array<float, 9>;  ///< row-major

/// What a lane does to light of each bin, the bin's scale included.
std::vector<Operator> operators(const LengthBins& bins, const std::vector<float>& scales,
                                const Lane& lane) {
  std::vector<Operator> all(static_cast<std::size_t>(bins.count()));
  for (int bin = 0; bin < bins.count(); ++bin)
    for (int c = 0; c < 3; ++c) {
      const Rgb unit{c == 0 ? 1.0f : 0.0f, c == 1 ? 1.0f : 0.0f, c == 2 ? 1.0f : 0.0f};
      const Rgb column =
          std::visit([&](const auto& l) { return l.apply(unit, bins.length(bin)); }, lane);
      all[bin][c] = column.r * scales[bin];
      all[bin][3 + c] = column.g * scales[bin];
      all[bin][6 + c] = column.b * scales[bin];
    }
  return all;
}

/// Pixels developed at once: their sums and one bin's halves stay in the L1 cache.
constexpr std::size_t block = 1024;

/// One source for every instruction set: loops that the compiler turns into vectors. Without fused
/// multiply-add the bits are the same on all of them.
[[gnu::always_inline]] inline void develop_block(const ExplorableFilm& film,
                                                 const std::vector<Operator>& all,
                                                 std::size_t begin, std::size_t count, float* out) {
  alignas(64) float sum[3][block] = {};
  const std::size_t pixels = std::size_t(film.width) * film.height;
  const std::uint16_t* r = film.halves.data() + begin;
  for (const Operator& m : all) {
    const std::uint16_t *g = r + pixels, *b = g + pixels;
    for (std::size_t i = 0; i < count; ++i) {
      const float hr = half_to_float(r[i]), hg = half_to_float(g[i]), hb = half_to_float(b[i]);
      sum[0][i] += m[0] * hr + m[1] * hg + m[2] * hb;
      sum[1][i] += m[3] * hr + m[4] * hg + m[5] * hb;
      sum[2][i] += m[6] * hr + m[7] * hg + m[8] * hb;
    }
    r = b + pixels;
  }
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < 3; ++c) out[3 * (begin + i) + c] = sum[c][i];
}

using BlockFunction = void (*)(const ExplorableFilm&, const std::vector<Operator>&, std::size_t,
                               std::size_t, float*);

void develop_block_anywhere(const ExplorableFilm& film, const std::vector<Operator>& all,
                            std::size_t begin, std::size_t count, float* out) {
  develop_block(film, all, begin, count, out);
}

#if defined(__x86_64__)
[[gnu::target("avx2")]] void develop_block_avx2(const ExplorableFilm& film,
                                                const std::vector<Operator>& all, std::size_t begin,
                                                std::size_t count, float* out) {
  develop_block(film, all, begin, count, out);
}
#endif

BlockFunction fastest_block_function() {
#if defined(__x86_64__)
  if (__builtin_cpu_supports("avx2")) return develop_block_avx2;
#endif
  return develop_block_anywhere;
}

}  // namespace

Image develop_explorable(const ExplorableFilm& film, const Lane& lane, int threads) {
  Image image(film.width, film.height);
  const std::vector<Operator> all = operators(film.bins, film.scales, lane);
  const std::size_t pixels = image.pixels.size() / 3;
  const BlockFunction develop_some = fastest_block_function();
  const auto work = [&](std::size_t begin, std::size_t end) {
    for (; begin < end; begin += block)
      develop_some(film, all, begin, std::min(block, end - begin), image.pixels.data());
  };
  // Not worth a thread below a few hundred thousand values.
  const std::size_t useful = std::max<std::size_t>(1, pixels / (16 * block));
  const std::size_t workers = std::min<std::size_t>(
      useful, threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency()));
  const std::size_t share = (pixels + workers - 1) / workers;
  std::vector<std::jthread> helpers;
  for (std::size_t i = 1; i < workers; ++i)
    helpers.emplace_back(work, std::min(i * share, pixels), std::min((i + 1) * share, pixels));
  work(0, std::min(share, pixels));
  return image;
}

Image develop_explorable(const ExplorableFilm& film, const Absorber& absorber, double sigma_a_peak,
                         int threads) {
  return develop_explorable(film, make_lane(absorber, sigma_a_peak * film.unit_mm), threads);
}

Image develop_shares(const LengthBins& bins, const Film& film, const Lane& lane) {
  const std::vector<float> scales(static_cast<std::size_t>(film.lanes), to_mean(film));
  const std::vector<Operator> all = operators(bins, scales, lane);
  Image image(film.width, film.height);
  const float* in = film.sum.data();
  for (const Operator& m : all)
    for (float* out = image.pixels.data(); out < image.pixels.data() + image.pixels.size();
         in += 3, out += 3) {
      out[0] += m[0] * in[0] + m[1] * in[1] + m[2] * in[2];
      out[1] += m[3] * in[0] + m[4] * in[1] + m[5] * in[2];
      out[2] += m[6] * in[0] + m[7] * in[1] + m[8] * in[2];
    }
  return image;
}

}  // namespace translucube

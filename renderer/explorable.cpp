#include "renderer/explorable.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <map>
#include <sstream>
#include <stdexcept>
#include <thread>

#include "renderer/half.h"
#include "renderer/image_io.h"
#include "renderer/scene_data.h"

namespace translucube {

double ExplorableBins::length(int bin) const {
  if (bin == 0) return 0;
  if (bin == 1) return shortest_length;
  return first * std::exp((bin - before_nodes) * step());
}

ExplorableBins explorable_bins(double densest, double sigma_s) {
  const ExplorableBins usual{};
  // Below the first node exp(-sigma l) is interpolated by a cubic: 1e-4 of it up to sigma l = 0.4.
  // It may miss more where hardly any light is that short: only scattering turns light back early,
  // a share of about sigma_s l.
  const double shortest = std::max(0.4 / densest, 1e-3 / sigma_s);
  // Light leaves a diffusing unit sphere by exp(-3.3 l / sigma_s) and (sigma_s l)^(-1/2), whichever
  // is faster: a thousandth is left beyond this.
  const double longest = std::min(3 * sigma_s, 1e7 / sigma_s);
  // Whole steps, and not without end: eight decades to either side hold any body that is told from
  // a black one.
  const double step = usual.step(), most = std::log(1e8) / step;
  const auto steps = [&](double ratio) {
    return std::isnan(ratio) ? 0.0 : std::ceil(std::clamp(std::log(ratio) / step, 0.0, most));
  };
  const double below = steps(usual.first / shortest), above = steps(longest / usual.last);
  return {usual.first * std::exp(-below * step), usual.last * std::exp(above * step),
          usual.nodes + static_cast<int>(below + above)};
}

namespace {

/// Lagrange's weights at x of the cubic through four nodes; they add up to 1.
std::array<float, 4> lagrange(const std::array<float, 4>& nodes, float x) {
  std::array<float, 4> weights;
  for (int i = 0; i < 4; ++i) {
    weights[i] = 1;
    for (int j = 0; j < 4; ++j)
      if (j != i) weights[i] *= (x - nodes[j]) / (nodes[i] - nodes[j]);
  }
  weights[1] = 1 - (weights[0] + weights[2] + weights[3]);
  return weights;
}

}  // namespace

BinSpread::BinSpread(const ExplorableBins& bins)
    : bins_(bins), log_first_(std::log(bins.first)), inverse_step_(1 / bins.step()) {
  for (int i = 0; i < 3; ++i) short_nodes_[i] = static_cast<float>(std::exp(i * bins.step()));
}

BinWeights BinSpread::operator()(double length) const {
  if (length == 0) return {};
  if (length < bins_.first)
    return {1, lagrange({0, short_nodes_[0], short_nodes_[1], short_nodes_[2]},
                        static_cast<float>(length / bins_.first))};
  const double position =
      std::min((std::log(length) - log_first_) * inverse_step_, double(bins_.nodes - 1));
  const int node = std::clamp(static_cast<int>(position) - 1, 0, bins_.nodes - 4);
  const auto t = static_cast<float>(position - node);
  // The same at 0, 1, 2, 3, where all divisors are known.
  const float a = t - 1, b = t - 2, c = t - 3;
  BinWeights spread{ExplorableBins::before_nodes + node,
                    {a * b * c * (-1.0f / 6), 0, t * a * c * -0.5f, t * a * b * (1.0f / 6)}};
  auto& w = spread.weights;
  w[1] = 1 - (w[0] + w[2] + w[3]);
  return spread;
}

// ---- developing

namespace {

using Operator = std::array<float, 9>;  ///< row-major

/// What a lane does to light of each bin, the bin's scale included.
std::vector<Operator> operators(const ExplorableFilm& film, const Lane& lane) {
  std::vector<Operator> all(static_cast<std::size_t>(film.bins.count()));
  for (int bin = 0; bin < film.bins.count(); ++bin)
    for (int c = 0; c < 3; ++c) {
      const Rgb unit{c == 0 ? 1.0f : 0.0f, c == 1 ? 1.0f : 0.0f, c == 2 ? 1.0f : 0.0f};
      const Rgb column =
          std::visit([&](const auto& l) { return l.apply(unit, film.bins.length(bin)); }, lane);
      all[bin][c] = column.r * film.scales[bin];
      all[bin][3 + c] = column.g * film.scales[bin];
      all[bin][6 + c] = column.b * film.scales[bin];
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
  const std::vector<Operator> all = operators(film, lane);
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

Image develop_explorable(const ExplorableFilm& film, const Scene& scene, int threads) {
  return develop_explorable(film, scene.lanes.front(), threads);
}

ExplorableFilm explorable_film(const Scene& scene, const Film& film) {
  ExplorableFilm result;
  result.width = film.width;
  result.height = film.height;
  result.bins = scene.spread.value().bins();
  result.unit_mm = scene.unit_mm;
  const std::size_t pixels = std::size_t(film.width) * film.height;
  const float to_mean = film.samples > 0 ? 1.0f / static_cast<float>(film.samples) : 0.0f;
  result.halves.resize(film.sum.size());
  for (int bin = 0; bin < film.lanes; ++bin) {
    const float* sum = film.sum.data() + 3 * pixels * bin;
    float largest = 0;
    bool finite = true;
    for (std::size_t i = 0; i < 3 * pixels; ++i) {
      largest = std::max(largest, std::fabs(sum[i] * to_mean));
      finite = finite && std::isfinite(sum[i]);
    }
    if (!finite) throw std::domain_error("an explorable film that is not finite");
    // The largest value comes to lie in [2^14, 2^15).
    const int exponent = largest > 0 ? std::clamp(std::ilogb(largest) - 14, -100, 100) : 0;
    result.scales.push_back(std::ldexp(1.0f, exponent));
    const float scale = std::ldexp(1.0f, -exponent);
    for (std::size_t i = 0; i < pixels; ++i)
      for (int c = 0; c < 3; ++c)
        result.halves[(std::size_t(3) * bin + c) * pixels + i] =
            float_to_half(sum[3 * i + c] * to_mean * scale);
  }
  return result;
}

// ---- storage

namespace {

constexpr const char* bins_attribute = "translucube:bins";  ///< "first last nodes"
constexpr const char* unit_attribute = "translucube:unit_mm";
constexpr const char* lengths_attribute = "translucube:lengths_mm";
constexpr const char* scales_attribute = "translucube:scales";
constexpr const char* request_attribute = "translucube:request";

/// Numbers as text, shortest form that reads back to the same value.
template <class... Numbers>
std::string numbers_text(const Numbers&... numbers) {
  std::string text;
  const auto add = [&](auto number) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
    text.append(text.empty() ? "" : " ").append(digits, end);
  };
  (add(numbers), ...);
  return text;
}

/// Layers are named so that their order is the alphabet's, which EXR files keep.
std::string channel_name(int bin, int channel) {
  const std::string digits = std::to_string(1000 + bin).substr(1);
  return "bin" + digits + '.' + "RGB"[channel];
}

std::string attribute(const HalfImage& image, const char* name, const std::filesystem::path& file) {
  const auto found = image.attributes.find(name);
  if (found == image.attributes.end())
    throw ImageError(file.string() + ": is not an explorable film (no " + name + ")");
  return found->second;
}

}  // namespace

void write_explorable(const std::filesystem::path& file, const ExplorableFilm& film,
                      const std::string& canonical_request) {
  HalfImage image;
  image.width = film.width;
  image.height = film.height;
  std::string lengths, scales;
  for (int bin = 0; bin < film.bins.count(); ++bin) {
    for (int c = 0; c < 3; ++c) image.channels.push_back(channel_name(bin, c));
    const double length = bin == 1 ? 0 : film.bins.length(bin) * film.unit_mm;
    lengths += (bin > 0 ? " " : "") + numbers_text(length);
    scales += (bin > 0 ? " " : "") + numbers_text(film.scales[bin]);
  }
  image.attributes = {
      {bins_attribute, numbers_text(film.bins.first, film.bins.last, film.bins.nodes)},
      {unit_attribute, numbers_text(film.unit_mm)},
      {lengths_attribute, lengths},
      {scales_attribute, scales},
      {request_attribute, canonical_request}};
  write_half_image(file, image, film.halves);
}

StoredExplorable read_explorable(const std::filesystem::path& file) {
  StoredExplorable stored;
  ExplorableFilm& film = stored.film;
  HalfImage image = read_half_image(file, film.halves);
  film.width = image.width;
  film.height = image.height;
  std::istringstream bins(attribute(image, bins_attribute, file)),
      unit(attribute(image, unit_attribute, file)),
      scales(attribute(image, scales_attribute, file));
  bins >> film.bins.first >> film.bins.last >> film.bins.nodes;
  unit >> film.unit_mm;
  for (float scale; scales >> scale;) film.scales.push_back(scale);
  stored.request = attribute(image, request_attribute, file);
  const bool sound = bins && unit && film.bins.first > 0 && film.bins.last > film.bins.first &&
                     film.bins.nodes >= 4 && film.bins.nodes < 900 && film.unit_mm > 0 &&
                     std::ssize(film.scales) == film.bins.count() &&
                     std::ssize(image.channels) == std::ptrdiff_t{3} * film.bins.count();
  bool named = sound;
  for (int i = 0; named && i < std::ssize(image.channels); ++i)
    named = image.channels[i] == channel_name(i / 3, i % 3);
  if (!named) throw ImageError(file.string() + ": is not a whole explorable film");
  return stored;
}

}  // namespace translucube

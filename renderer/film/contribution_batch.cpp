#include "renderer/film/contribution_batch.h"

#include <cmath>
#include <cstring>
#include <variant>

// This file is compiled once for each instruction set: the order matters.
// clang-format off
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "renderer/film/contribution_batch.cpp"
#include <hwy/foreach_target.h>
#include "renderer/base/simd.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace translucube::HWY_NAMESPACE {

/// The channels of one contribution or one pixel: as many in every instruction set, which Highway
/// has no vector for where there is none.
using Light [[gnu::vector_size(sizeof(float) * pixel_floats)]] = float;

HWY_INLINE Light load_light(const float* from) {
  Light light;
  std::memcpy(&light, from, sizeof light);
  return light;
}
HWY_INLINE void store(Light light, float* to) { std::memcpy(to, &light, sizeof light); }
HWY_INLINE bool is_finite(Light light) { return std::isfinite(light[0] + light[1] + light[2]); }

/// `attenuate(light, length, channel)` for each channel of all.
template <class Attenuate>
HWY_INLINE void for_channels(const ContributionBatch& batch, DevelopedBatch& developed,
                             Attenuate&& attenuate) {
  for (std::size_t i = 0; i < batch.size; i += at_once) {
    const Real length = load(batch.length, i);
    hn::StoreInterleaved4(attenuate(load(batch.r, i), length, 0).v,
                          attenuate(load(batch.g, i), length, 1).v,
                          attenuate(load(batch.b, i), length, 2).v, hn::Zero(D()), D(),
                          &developed.light[pixel_floats * i]);
  }
}

void develop_lane(const ClearLane&, const ContributionBatch& batch, DevelopedBatch& developed) {
  for_channels(batch, developed, [](Real light, Real, int) { return light; });
}

void develop_lane(const OpaqueLane&, const ContributionBatch& batch, DevelopedBatch& developed) {
  for_channels(batch, developed,
               [](Real light, Real length, int) { return select(length > 0, 0, light); });
}

void develop_lane(const RgbLane& lane, const ContributionBatch& batch, DevelopedBatch& developed) {
  for_channels(batch, developed, [&](Real light, Real length, int channel) {
    const Real depth = Real(lane.sigma_a[channel]) * length;
    // exp() takes what is not a number for far below 0.
    return light * select(is_nan(depth), depth, exp(-depth));
  });
}

void develop_lane(const SpectralLane& lane, const ContributionBatch& batch,
                  DevelopedBatch& developed) {
  using Table = ColorOperatorTable;
  const Table& table = lane.table();
  // Gathering the operators of as many contributions as a register holds takes longer than to
  // apply them one by one, each to the three channels at once.
  ContributionBatch::Integers segment;
  ContributionBatch::Floats within;
  for (std::size_t i = 0; i < batch.size; i += at_once) {
    const Real x = fma(static_cast<float>(lane.sigma_a_peak()), load(batch.length, i), 1);
    const Bits position = as_bits(x) - as_bits(1);
    const Bits last = static_cast<std::uint32_t>(table.segments() - 1);
    store(min(shift_right<Table::fraction_bits>(position), last), segment, i);
    const Real fraction = to_real(position & Bits(Table::fraction_mask));
    store(fraction * Real(1.0f / (1u << Table::fraction_bits)), within, i);
  }
  for (std::size_t i = 0; i < batch.size; ++i) {
    const Table::Node* nodes = table.nodes() + segment[i];
    const auto apply = [&](const Table::Node& m) {
      return load_light(m.column[0]) * batch.r[i] + load_light(m.column[1]) * batch.g[i] +
             load_light(m.column[2]) * batch.b[i];
    };
    const Light from = apply(nodes[0]), to = apply(nodes[1]);
    store(from + within[i] * (to - from), &developed.light[pixel_floats * i]);
  }
}

void Develop(const Lane& lane, const ContributionBatch& batch, DevelopedBatch& developed) {
  std::visit([&](const auto& which) { develop_lane(which, batch, developed); }, lane);
}

std::size_t Add(const ContributionBatch& batch, const DevelopedBatch& developed, float* pixels) {
  Light none{};
  for (std::size_t i = 0; i < batch.size; ++i) {
    float* pixel = pixels + pixel_floats * batch.pixel[i];
    const Light light = load_light(&developed.light[pixel_floats * i]);
    store(load_light(pixel) + light, pixel);
    none += light - light;
  }
  if (is_finite(none)) return 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < batch.size; ++i)
    count += !is_finite(load_light(&developed.light[pixel_floats * i]));
  return count;
}

/// BinSpread's bin and weights for each length.
struct SpreadBatch {
  ContributionBatch::Integers bin;
  std::array<ContributionBatch::Floats, 4> weights;
};

void find_bins(const BinSpread& spread, const ContributionBatch& batch, SpreadBatch& found) {
  const std::array<float, 3>& n = spread.short_nodes();
  const Real last(static_cast<float>(spread.bins().nodes - 1)),
      last_stencil(static_cast<float>(spread.bins().nodes - 4));
  const Real first_length(static_cast<float>(spread.bins().first)),
      to_first(static_cast<float>(1 / spread.bins().first));
  const Real log_first(static_cast<float>(spread.log_first())),
      inverse_step(static_cast<float>(spread.inverse_step()));
  // Lagrange's divisors at 0 and at the second and third node.
  const Real at_0(-1 / (n[0] * n[1] * n[2])), at_1(1 / (n[1] * (n[1] - n[0]) * (n[1] - n[2]))),
      at_2(1 / (n[2] * (n[2] - n[0]) * (n[2] - n[1])));
  for (std::size_t i = 0; i < batch.size; i += at_once) {
    const Real length = load(batch.length, i);
    const Real position = max(min((log(max(length, 1e-37f)) - log_first) * inverse_step, last), 0);
    const Real node = max(min(floor(position) - 1, last_stencil), 0);
    const Real t = position - node, a = t - 1, b = t - 2, c = t - 3;
    const Real x = length * to_first, p = x - n[0], q = x - n[1], s = x - n[2];
    const Mask outside = length == 0, brief = length < first_length;
    const auto choose = [&](Real of_none, Real of_short, Real of_long) {
      return select(outside, of_none, select(brief, of_short, of_long));
    };
    const Real w0 = choose(1, p * q * s * at_0, a * b * c * (-1.0f / 6)),
               w2 = choose(0, x * p * s * at_1, t * a * c * -0.5f),
               w3 = choose(0, x * p * q * at_2, t * a * b * (1.0f / 6));
    const Real bin = choose(0, 1, node + float(LengthBins::before_nodes));
    store(to_whole(bin), found.bin, i);
    store(w0, found.weights[0], i);
    store(Real(1) - (w0 + w2 + w3), found.weights[1], i);
    store(w2, found.weights[2], i);
    store(w3, found.weights[3], i);
  }
}

std::size_t AddSpread(const BinSpread& spread, const ContributionBatch& batch, float* pixels,
                      std::size_t stride) {
  SpreadBatch found;
  find_bins(spread, batch, found);
  std::size_t not_finite = 0;
  for (std::size_t i = 0; i < batch.size; ++i) {
    const Light light{batch.r[i], batch.g[i], batch.b[i], 0};
    if (!is_finite(light) || !std::isfinite(batch.length[i])) {
      ++not_finite;
      continue;
    }
    float* pixel = pixels + found.bin[i] * stride + pixel_floats * batch.pixel[i];
    for (const ContributionBatch::Floats& weights : found.weights) {
      store(load_light(pixel) + weights[i] * light, pixel);
      pixel += stride;
    }
  }
  return not_finite;
}

}  // namespace translucube::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace translucube {

HWY_EXPORT(Develop);
HWY_EXPORT(Add);
HWY_EXPORT(AddSpread);

void develop(const Lane& lane, const ContributionBatch& batch, DevelopedBatch& developed) {
  HWY_DYNAMIC_DISPATCH(Develop)(lane, batch, developed);
}

std::size_t add(const ContributionBatch& batch, const DevelopedBatch& developed, float* pixels) {
  return HWY_DYNAMIC_DISPATCH(Add)(batch, developed, pixels);
}

std::size_t add_spread(const BinSpread& spread, const ContributionBatch& batch, float* pixels,
                       std::size_t stride) {
  return HWY_DYNAMIC_DISPATCH(AddSpread)(spread, batch, pixels, stride);
}

}  // namespace translucube
#endif

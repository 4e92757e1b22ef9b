#include "api/request/sweep.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <nlohmann/json.hpp>

#include "api/request/canonical.h"

namespace translucube::api {
namespace {

using nlohmann::json;

/// SplitMix64's finalizer (Steele, Lea, Flood 2014).
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
  x = (x ^ x >> 27) * 0x94d049bb133111ebu;
  return x ^ x >> 31;
}

/// Every integer up to 2^53 is exact in every JSON reader.
std::uint64_t mixed_seed(std::uint64_t seed, double roughness, double scattering) {
  std::uint64_t state = mixed(seed + 0x9e3779b97f4a7c15u);
  state = mixed(state ^ std::bit_cast<std::uint64_t>(roughness));
  state = mixed((state + 0x9e3779b97f4a7c15u) ^ std::bit_cast<std::uint64_t>(scattering));
  return state >> 11;
}

std::uint64_t pixels_of(const RenderRequest& request) {
  return std::uint64_t(request.width) * std::uint64_t(request.height);
}

std::size_t point_at(const Sweep& sweep, const SweepPlace& place) {
  return ((place.absorber * sweep.scattering.size() + place.scattering) * sweep.roughness.size() +
          place.roughness) *
             sweep.absorption.size() +
         place.absorption;
}

}  // namespace

SweepPlace place_of(const Sweep& sweep, std::size_t point) {
  assert(point < sweep.point_count());
  SweepPlace place;
  const auto take = [&](std::size_t& index, std::size_t count) {
    index = point % count;
    point /= count;
  };
  take(place.absorption, sweep.absorption.size());
  take(place.roughness, sweep.roughness.size());
  take(place.scattering, sweep.scattering.size());
  take(place.absorber, sweep.absorbers.size());
  return place;
}

RenderRequest point_request(const Sweep& sweep, std::size_t point) {
  const SweepPlace place = place_of(sweep, point);
  const double roughness = sweep.roughness[place.roughness],
               scattering = sweep.scattering[place.scattering];
  RenderRequest request = sweep.base;
  request.material.point = CubePoint{sweep.absorption[place.absorption], roughness, scattering};
  request.material.absorber = sweep.absorbers[place.absorber];
  request.seed = mixed_seed(sweep.base.seed, roughness, scattering);
  return request;
}

std::uint64_t point_seed(const Sweep& sweep, std::size_t point) {
  const SweepPlace place = place_of(sweep, point);
  return mixed_seed(sweep.base.seed, sweep.roughness[place.roughness],
                    sweep.scattering[place.scattering]);
}

std::vector<std::vector<std::size_t>> traced_images(const Sweep& sweep, const Limits& limits) {
  const bool pigment = sweep.base.material.pigment_absorption_per_scattering.has_value();
  const std::size_t most =
      pigment ? 1 : std::max<std::uint64_t>(1, limits.pixels / pixels_of(sweep.base));
  std::vector<std::size_t> rising(sweep.absorption.size());
  for (std::size_t i = 0; i < rising.size(); ++i) rising[i] = i;
  std::ranges::stable_sort(rising, {}, [&](std::size_t i) { return sweep.absorption[i]; });

  std::vector<std::vector<std::size_t>> images;
  for (std::size_t scattering = 0; scattering < sweep.scattering.size(); ++scattering)
    for (std::size_t roughness = 0; roughness < sweep.roughness.size(); ++roughness) {
      images.emplace_back();
      for (const std::size_t absorption : rising)
        for (std::size_t absorber = 0; absorber < sweep.absorbers.size(); ++absorber) {
          if (images.back().size() == most) images.emplace_back();
          images.back().push_back(point_at(sweep, {absorption, roughness, scattering, absorber}));
        }
    }
  return images;
}

std::string canonical_json(const Sweep& sweep) {
  // An absorber's canonical form stands in that of a request with it.
  json absorbers = json::array();
  for (const AbsorberRequest& absorber : sweep.absorbers) {
    RenderRequest request = sweep.base;
    request.material.absorber = absorber;
    absorbers.push_back(json::parse(canonical_json(request))["material"]["absorber"]);
  }
  return json{{"base", json::parse(canonical_json(sweep.base))},
              {"axes",
               {{"absorption", sweep.absorption},
                {"roughness", sweep.roughness},
                {"scattering", sweep.scattering}}},
              {"absorbers", std::move(absorbers)}}
      .dump();
}

std::string counts_json(const Sweep& sweep, const Limits& limits) {
  const std::size_t images = traced_images(sweep, limits).size();
  const auto* target = std::get_if<SampleTarget>(&sweep.base.quality);
  const std::uint64_t pixels = pixels_of(sweep.base);
  return json{{"points", sweep.point_count()},
              {"traced_images", images},
              {"pixels", pixels},
              {"camera_samples",
               target ? json(double(pixels) * target->samples * double(images)) : json(nullptr)}}
      .dump();
}

}  // namespace translucube::api

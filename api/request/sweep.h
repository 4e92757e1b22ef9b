#pragma once

// A grid over the cube. Absorption is developed, not traced: the points that differ in it, or in
// the absorber, come from one traced image.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "api/base/result.h"
#include "api/request/catalog.h"
#include "api/request/request.h"

namespace translucube::api {

/// A base request and the values of each axis, at least one each: an axis that was left out has the
/// base's own.
struct Sweep {
  RenderRequest base;                                     ///< its material is a point of the cube
  std::vector<double> absorption, roughness, scattering;  ///< the cube's, [0, 1]
  std::vector<AbsorberRequest> absorbers;
  friend bool operator==(const Sweep&, const Sweep&) = default;

  std::size_t point_count() const {
    return absorption.size() * roughness.size() * scattering.size() * absorbers.size();
  }
};

/// Where a point lies on each axis. Points are numbered with the absorption changing fastest, then
/// roughness, scattering and the absorber.
struct SweepPlace {
  std::size_t absorption = 0, roughness = 0, scattering = 0, absorber = 0;
  friend bool operator==(const SweepPlace&, const SweepPlace&) = default;
};
SweepPlace place_of(const Sweep& sweep, std::size_t point);

/// The point as a request of its own, which gives the same bits. Its seed is told from the base's
/// seed, the roughness and the scattering: whatever else the sweep has, the point stays as it is.
RenderRequest point_request(const Sweep& sweep, std::size_t point);
std::uint64_t point_seed(const Sweep& sweep, std::size_t point);  ///< its seed alone

/// The points that are developed from one tracing, the least absorbing first (it decides where a
/// relative_error stops). At most so many that their film has no more pixels than the largest image
/// may have. A pigment's absorption is bound to its scattering: each is traced.
std::vector<std::vector<std::size_t>> traced_images(const Sweep& sweep, const Limits& limits);

/// {"base": {...}, "axes": {"absorption": [0, 0.5, 1] or {"from": 0, "to": 1, "count": 5}, ...},
///  "absorbers": ["red-glass", ...]}; every axis and `absorbers` may be left out. As strict as
/// parse_render_request, and refuses what `limits` does not allow.
Result<Sweep> parse_sweep_request(std::string_view text, const Catalog& catalog);

/// The canonical form, as that of a render (canonical.h): it parses back to the same sweep.
std::string canonical_json(const Sweep& sweep);

/// What a dry run answers: {"points", "traced_images", "pixels" (of each image), "camera_samples"
/// (of the whole sweep; null where the quality does not say)}.
std::string counts_json(const Sweep& sweep, const Limits& limits);

}  // namespace translucube::api

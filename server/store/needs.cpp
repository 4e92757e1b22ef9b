#include "server/store/needs.h"

#include <algorithm>
#include <cmath>

#include "api/base/overloaded.h"
#include "renderer/film/length_bins.h"

namespace translucube::server {
namespace {

constexpr std::uint64_t rgb_bytes = 3 * sizeof(float), half_rgb_bytes = 3 * 2;
// Tables, tiles and queues of a scene, whatever its size, and an environment of 2048 x 1024.
constexpr std::uint64_t scene_bytes = 96 << 20;
constexpr std::uint64_t header_bytes = 64 << 10;
// Of a mesh, whose size is not known before it is read; no body has twice as many.
constexpr std::uint64_t bins_of_a_mesh = 48;

std::uint64_t pixels(const api::RenderRequest& request) {
  return std::uint64_t(request.width) * std::uint64_t(request.height);
}

/// The radius of the bounding sphere [mm].
double radius_of(const api::ObjectRequest& object) {
  return std::visit(
      api::Overloaded{
          [](const api::MeshRequest&) { return 0.0; },
          [](const SphereObject& sphere) { return sphere.radius_mm; },
          [](const BowlObject& bowl) { return bowl.radius_mm; },
          [](const PlateObject& plate) {
            return std::hypot(plate.width_mm, plate.height_mm, plate.thickness_mm) / 2;
          },
          [](const BoxObject& box) {
            return std::hypot(box.width_mm, box.height_mm, box.depth_mm) / 2;
          },
          [](const WedgeObject& wedge) {
            return std::hypot(wedge.width_mm, wedge.height_mm, wedge.thick_mm) / 2;
          },
          [](const TorusObject& torus) { return torus.major_mm + torus.minor_mm; },
          [](const RoundedBoxObject& box) {
            return std::hypot(box.width_mm, box.height_mm, box.depth_mm) / 2;
          },
          [](const ReliefObject& relief) {
            return std::hypot(relief.width_mm, relief.height_mm, relief.depth_mm) / 2;
          },
          [](const BlobObject& blob) { return (1 + 0.45 * blob.bump) * blob.radius_mm; },
          [](const DragonObject& dragon) { return 0.7 * dragon.length_mm; }},
      object);
}

/// Of bodies that are made of half a million triangles, and while these are made.
std::uint64_t triangle_bytes(const api::ObjectRequest& object) {
  constexpr std::uint64_t bytes = 160 << 20;
  return std::visit(api::Overloaded{[](const TorusObject&) { return bytes; },
                                    [](const RoundedBoxObject&) { return bytes; },
                                    [](const BlobObject&) { return bytes; },
                                    [](const DragonObject&) { return bytes; },
                                    [](const auto&) { return std::uint64_t{0}; }},
                    object);
}

/// Of an explorable film, whose densest absorber is the blackest one short of black
/// (scene_spec.cpp), and whose scattering adds few.
std::uint64_t bins_of(const api::RenderRequest& request) {
  const double radius = radius_of(request.object);
  if (radius <= 0) return bins_of_a_mesh;
  const double nearly_black = -std::log(1 - std::nextafter(1.0, 0.0));
  const double densest = nearly_black / request.material.reference_thickness_mm * radius;
  const int usual = LengthBins{}.count();
  const int wide = length_bins(densest, densest).count();
  return static_cast<std::uint64_t>(std::max(usual, wide));
}

}  // namespace

std::uint64_t memory_of(const api::RenderRequest& request, std::uint64_t lanes) {
  const std::uint64_t all = request.explorable ? bins_of(request) : lanes;
  const std::uint64_t films = 3 * all * rgb_bytes + 2 * rgb_bytes;  // sums, the spread, a picture
  const std::uint64_t halves = request.explorable ? all * half_rgb_bytes : 0;
  return scene_bytes + triangle_bytes(request.object) + pixels(request) * (films + halves);
}

std::uint64_t picture_bytes(const api::RenderRequest& request, std::uint64_t lanes) {
  const std::uint64_t lengths = request.explorable ? bins_of(request) * half_rgb_bytes : 0;
  return lanes * header_bytes + pixels(request) * (lanes * rgb_bytes + lengths);
}

}  // namespace translucube::server

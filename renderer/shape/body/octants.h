#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include "renderer/shape/triangle_mesh.h"

namespace translucube {

/// A sphere cut along the planes of the coordinates, its eight parts moved apart with flat and
/// cylindrical ones between them: a rounded box, or the sphere itself. Outward directions are its
/// normals.
class Octants {
 public:
  /// `parts`: of a quarter of a great circle.
  explicit Octants(std::uint32_t parts) : parts_(parts) {}

  TriangleMesh sphere() const { return rounded_box({}, 1); }

  /// `inner`: half of the box without its rounding. Not yet closed: close_mesh() puts points
  /// together that lie upon each other.
  TriangleMesh rounded_box(Vec3 inner, double radius) const {
    TriangleMesh mesh;
    for (std::uint32_t octant = 0; octant < 8; ++octant)
      for (std::uint32_t i = 0; i <= parts_; ++i)
        for (std::uint32_t j = 0; i + j <= parts_; ++j) {
          const Vec3 sign = sign_of(octant), d = direction(i, j);
          const Vec3 normal{sign.x * d.x, sign.y * d.y, sign.z * d.z};
          mesh.normals.push_back(normal);
          mesh.vertices.push_back(Vec3{sign.x * inner.x, sign.y * inner.y, sign.z * inner.z} +
                                  radius * normal);
        }
    for (std::uint32_t octant = 0; octant < 8; ++octant) add_octant(octant, mesh);
    for (std::uint32_t axis = 0; axis < 3; ++axis)
      for (std::uint32_t octant = 0; octant < 8; ++octant) {
        if (octant >> axis & 1) continue;
        add_strip(octant, axis, mesh);
      }
    for (std::uint32_t axis = 0; axis < 3; ++axis) add_faces(axis, mesh);
    mesh.corner_normals = mesh.triangles;
    return mesh;
  }

 private:
  static Vec3 sign_of(std::uint32_t octant) {
    return {octant & 1 ? 1.0 : -1.0, octant & 2 ? 1.0 : -1.0, octant & 4 ? 1.0 : -1.0};
  }
  Vec3 direction(std::uint32_t i, std::uint32_t j) const {
    const auto part = [&](std::uint32_t of) {
      return std::sin(0.5 * std::numbers::pi * of / parts_);
    };
    return normalize({part(i), part(j), part(parts_ - i - j)});
  }
  /// The point with weights i at x, j at y, the rest at z.
  std::uint32_t at(std::uint32_t octant, std::uint32_t i, std::uint32_t j) const {
    const std::uint32_t all = (parts_ + 1) * (parts_ + 2) / 2;
    return octant * all + i * (2 * parts_ + 3 - i) / 2 + j;
  }

  /// Adds a triangle that looks outward where all signs are positive.
  static void add(std::uint32_t octant, Triangle t, TriangleMesh& mesh) {
    const bool mirrored = ((octant & 1) + (octant >> 1 & 1) + (octant >> 2 & 1)) % 2 == 0;
    if (mirrored) std::swap(t[1], t[2]);
    mesh.triangles.push_back(t);
  }

  void add_octant(std::uint32_t octant, TriangleMesh& mesh) const {
    for (std::uint32_t i = 0; i < parts_; ++i)
      for (std::uint32_t j = 0; i + j < parts_; ++j) {
        add(octant, {at(octant, i, j), at(octant, i + 1, j), at(octant, i, j + 1)}, mesh);
        if (i + j + 1 < parts_)
          add(octant, {at(octant, i + 1, j), at(octant, i + 1, j + 1), at(octant, i, j + 1)}, mesh);
      }
  }

  /// The k-th point of an octant's side where the axis' weight is 0.
  std::uint32_t on_side(std::uint32_t octant, std::uint32_t axis, std::uint32_t k) const {
    return axis == 0   ? at(octant, 0, k)
           : axis == 1 ? at(octant, parts_ - k, 0)
                       : at(octant, k, parts_ - k);
  }

  /// Between an octant on the negative side of an axis and its mirror image.
  void add_strip(std::uint32_t octant, std::uint32_t axis, TriangleMesh& mesh) const {
    const std::uint32_t other = octant | 1u << axis;
    for (std::uint32_t k = 0; k < parts_; ++k) {
      const std::uint32_t a = on_side(other, axis, k), b = on_side(other, axis, k + 1),
                          c = on_side(octant, axis, k), d = on_side(octant, axis, k + 1);
      add(other, {a, b, d}, mesh);
      add(other, {a, d, c}, mesh);
    }
  }

  /// The flat faces across an axis, between four octants each.
  void add_faces(std::uint32_t axis, TriangleMesh& mesh) const {
    const auto pole = [&](std::uint32_t octant) {
      return axis == 0   ? at(octant, parts_, 0)
             : axis == 1 ? at(octant, 0, parts_)
                         : at(octant, 0, 0);
    };
    const std::uint32_t u = 1u << (axis + 1) % 3, v = 1u << (axis + 2) % 3, side = 1u << axis;
    for (const std::uint32_t base : {0u, side}) {
      const std::uint32_t a = pole(base), b = pole(base | u), c = pole(base | u | v),
                          d = pole(base | v);
      // Counter-clockwise seen from the positive end of the axis.
      const std::uint32_t positive = 7, negative = 6;
      add(base != 0 ? positive : negative, {a, b, c}, mesh);
      add(base != 0 ? positive : negative, {a, c, d}, mesh);
    }
  }

  std::uint32_t parts_;
};

}  // namespace translucube

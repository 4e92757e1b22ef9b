#pragma once

#include "renderer/shape/smooth/division.h"
#include "renderer/shape/triangle_mesh.h"

namespace translucube {

/// The vertices along a side of a piece: those between its ends stand one after the other.
struct Run {
  std::uint32_t first;       ///< vertex of position 1
  std::uint32_t begin, end;  ///< positions of the ends, in either order

  std::uint32_t parts() const { return begin < end ? end - begin : begin - end; }
  std::uint32_t position(std::uint32_t i) const { return begin < end ? begin + i : begin - i; }
  std::uint32_t vertex(std::uint32_t i) const {
    return first + position(i) - 1;
  }  ///< 0 < i < parts
  Run head(std::uint32_t i) const { return {first, begin, position(i)}; }
  Run tail(std::uint32_t i) const { return {first, position(i), end}; }
  Run reversed() const { return {first, end, begin}; }
};

/// A part of a patch.
struct Piece {
  Three<std::uint32_t> corners;
  Three<Vec3> places;  ///< barycentric coordinates of the corners in the patch
  Three<Run> sides;    ///< from each corner to the next
  Three<Vec3> bends;
};

/// Writes the triangles of one patch after the other.
class Tessellator {
 public:
  Tessellator(TriangleMesh& out, double error) : out_(out), error_(error) {}

  void fill(const Patch& patch, const Piece& piece);

 private:
  std::uint32_t add(const Patch& patch, Vec3 place);
  void fill_strip(const Piece& piece, std::uint32_t whole);
  void cut(const Patch& patch, const Piece& piece, const Division& division);
  void fill_evenly(const Patch& patch, const Piece& piece, std::uint32_t parts);
  void sew(const Piece& piece, std::uint32_t side, const Lattice& lattice, std::uint32_t parts);

  TriangleMesh& out_;
  double error_;
};

}  // namespace translucube

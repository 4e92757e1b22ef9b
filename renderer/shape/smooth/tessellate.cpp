#include "renderer/shape/smooth/tessellate.h"

namespace translucube {
namespace {

/// The i-th point of a side.
std::uint32_t vertex(const Piece& piece, std::uint32_t side, std::uint32_t i) {
  if (i == 0) return piece.corners[side];
  const Run& run = piece.sides[side];
  return i == run.parts() ? piece.corners[next_corner(side)] : run.vertex(i);
}

}  // namespace

void Tessellator::fill(const Patch& patch, const Piece& piece) {
  const Division division{{piece.sides[0].parts(), piece.sides[1].parts(), piece.sides[2].parts()},
                          piece.bends};
  if (division.whole())
    out_.triangles.push_back(piece.corners);
  else if (const std::uint32_t whole = division.strip(); whole < 3)
    fill_strip(piece, whole);
  else if (division.even())
    fill_evenly(patch, piece, division.parts[division.longest()]);
  else
    cut(patch, piece, division);
}

std::uint32_t Tessellator::add(const Patch& patch, Vec3 place) {
  out_.vertices.push_back(patch.at(place.x, place.y, place.z));
  return static_cast<std::uint32_t>(out_.vertices.size() - 1);
}

/// Between the two sides beyond a whole one.
void Tessellator::fill_strip(const Piece& piece, std::uint32_t whole) {
  const std::uint32_t l = next_corner(whole), m = next_corner(l);
  // Both from the whole side's ends to the corner where they meet.
  const std::uint32_t lefts = piece.sides[m].parts(), rights = piece.sides[l].parts();
  const auto left = [&](std::uint32_t i) { return vertex(piece, m, lefts - i); };
  const auto right = [&](std::uint32_t i) { return vertex(piece, l, i); };
  for (std::uint32_t i = 0, j = 0; i + 1 < lefts || j + 1 < rights;) {
    const bool on_left =
        j + 1 == rights || (i + 1 < lefts && (i + 0.5) / lefts <= (j + 0.5) / rights);
    if (on_left) {
      out_.triangles.push_back({left(i), right(j), left(i + 1)});
      ++i;
    } else {
      out_.triangles.push_back({left(i), right(j), right(j + 1)});
      ++j;
    }
  }
  out_.triangles.push_back({left(lefts - 1), right(rights - 1), piece.corners[m]});
}

/// As Division::triangles() counts it.
void Tessellator::cut(const Patch& patch, const Piece& piece, const Division& division) {
  const std::uint32_t k = division.longest(), l = next_corner(k), m = next_corner(l);
  const std::uint32_t first = division.parts[k] / 2;
  const double share = double(first) / division.parts[k];
  const Vec3 middle = (1 - share) * piece.places[k] + share * piece.places[l];
  const Vec3 median = division.median(k), half = 0.25 * piece.bends[k];
  const std::uint32_t across = division.parts_across(k, error_);
  const Run run{static_cast<std::uint32_t>(out_.vertices.size()), 0, across};
  for (std::uint32_t i = 1; i < across; ++i) {
    const double t = double(i) / across;
    add(patch, (1 - t) * middle + t * piece.places[m]);
  }
  const std::uint32_t cut = piece.sides[k].vertex(first);
  fill(patch, {{piece.corners[k], cut, piece.corners[m]},
               {piece.places[k], middle, piece.places[m]},
               {piece.sides[k].head(first), run, piece.sides[m]},
               {half, median, piece.bends[m]}});
  fill(patch, {{cut, piece.corners[l], piece.corners[m]},
               {middle, piece.places[l], piece.places[m]},
               {piece.sides[k].tail(first), piece.sides[l], run.reversed()},
               {half, piece.bends[l], median}});
}

void Tessellator::fill_evenly(const Patch& patch, const Piece& piece, std::uint32_t parts) {
  const Lattice lattice(parts, static_cast<std::uint32_t>(out_.vertices.size()));
  const double step = 1.0 / parts;
  Lattice::for_each_point(parts, [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
    add(patch,
        i * step * piece.places[0] + j * step * piece.places[1] + k * step * piece.places[2]);
  });
  lattice.for_each_triangle([&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    out_.triangles.push_back({a, b, c});
  });
  for (std::uint32_t side = 0; side < 3; ++side) sew(piece, side, lattice, parts);
}

/// The strip between a side and the row of points beside it, which are not as many.
void Tessellator::sew(const Piece& piece, std::uint32_t side, const Lattice& lattice,
                      std::uint32_t parts) {
  const std::uint32_t outer_parts = piece.sides[side].parts(), inner_parts = parts - 3;
  const auto outer = [&](std::uint32_t i) { return vertex(piece, side, i); };
  for (std::uint32_t i = 0, j = 0; i < outer_parts || j < inner_parts;) {
    // Whichever chord's middle comes first along the side.
    const bool outside =
        j == inner_parts || (i < outer_parts && (i + 0.5) / outer_parts <= (j + 2.0) / parts);
    if (outside) {
      out_.triangles.push_back({outer(i), outer(i + 1), lattice.beside(side, j)});
      ++i;
    } else {
      out_.triangles.push_back({outer(i), lattice.beside(side, j + 1), lattice.beside(side, j)});
      ++j;
    }
  }
}

}  // namespace translucube

#pragma once

#include <array>
#include <cstdint>

namespace translucube {

/// One for each corner of a triangle, or for each side, which goes from its corner to the next.
template <class T>
using Three = std::array<T, 3>;

constexpr std::uint32_t next_corner(std::uint32_t i) { return i == 2 ? 0 : i + 1; }

/// The regular lattice of points in a triangle whose sides are divided by `parts`, but for the
/// points on its sides. Its points have weights i, j, k > 0 at the corners that sum up to `parts`.
class Lattice {
 public:
  Lattice(std::uint32_t parts, std::uint32_t first) : parts_(parts), first_(first) {}

  /// The vertex of a point, counted from `first`: in rows of falling i, each of rising j.
  std::uint32_t at(std::uint32_t i, std::uint32_t j) const {
    const std::uint32_t row = parts_ - 2 - i;
    return first_ + row * (row + 1) / 2 + (j - 1);
  }
  /// The c-th point of the row next to a side, from the side's first corner.
  std::uint32_t beside(std::uint32_t side, std::uint32_t c) const {
    std::array<std::uint32_t, 3> weight{};
    weight[side] = parts_ - 2 - c;
    weight[next_corner(side)] = 1 + c;
    return at(weight[0] == 0 ? 1 : weight[0], weight[1] == 0 ? 1 : weight[1]);
  }

  template <class Use>
  static void for_each_point(std::uint32_t parts, Use&& use) {
    for (std::uint32_t i = parts - 2; i > 0; --i)
      for (std::uint32_t j = 1; i + j < parts; ++j) use(i, j, parts - i - j);
  }
  /// Of its (parts - 3)^2 triangles.
  template <class Use>
  void for_each_triangle(Use&& use) const {
    for (std::uint32_t i = parts_ - 3; i > 0; --i)
      for (std::uint32_t j = 1; i + j + 1 < parts_; ++j) {
        use(at(i + 1, j), at(i, j + 1), at(i, j));
        if (j > 1) use(at(i + 1, j - 1), at(i + 1, j), at(i, j));
      }
  }

 private:
  std::uint32_t parts_, first_;
};

}  // namespace translucube

#pragma once

// The smallest files that a client can send.

#include <string>

#include "tests/support/tiny_map.h"

namespace translucube::server::test {

using translucube::test::tiny_map;

/// An OBJ.
inline const std::string tetrahedron =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

/// The same and other bytes for each number.
inline std::string tetrahedron_of(int number) {
  return tetrahedron + "# " + std::to_string(number) + "\n";
}

}  // namespace translucube::server::test

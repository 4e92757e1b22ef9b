#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace translucube::ply {

enum class Scalar { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

inline std::size_t size_of(Scalar type) {
  constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}
inline bool is_integer(Scalar type) { return type < Scalar::float32; }

struct Property {
  std::string name;
  Scalar type = Scalar::float32;
  std::optional<Scalar> count;  ///< of a list
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

enum class Encoding { ascii, little_endian, big_endian };

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::string_view body;  ///< the bytes behind it
};

/// Throws MeshError that names the line.
Header read_header(std::string_view bytes);

}  // namespace translucube::ply

#pragma once

#include <map>
#include <string>
#include <vector>

#include "renderer/base/vec.h"
#include "renderer/shape/file/gltf/container.h"
#include "renderer/shape/file/gltf/value.h"

namespace translucube::gltf {

/// Numbers of the document's buffers, which are in the file: another is never opened. All throw
/// MeshError with the JSON pointer of what is at fault.
class Accessors {
 public:
  explicit Accessors(const Container& container)
      : container_(container), document_(container.document) {}

  /// What an index that stands at `reference` names: corners of triangles.
  std::vector<std::uint32_t> indices(const Value& reference);
  /// Points, and what storing them may round off of the largest coordinate.
  struct Points {
    std::vector<Vec3> points;
    double rounding = 0;
  };
  Points points(const Value& reference);

 private:
  struct Layout;
  struct Elements;

  std::string_view buffer(const Value& reference);
  std::string_view view(const Value& reference, const Layout& layout, std::uint64_t& stride);
  Elements elements(const Value& accessor, const Layout& layout);
  void replace(const Value& sparse, const Layout& layout, Elements& elements);

  const Container& container_;
  const Value document_;
  std::map<const void*, std::string> decoded_;  ///< buffers of data: URIs
};

}  // namespace translucube::gltf

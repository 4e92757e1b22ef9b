#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

namespace translucube::gltf {

/// A file taken apart: the document, and what of it is binary.
struct Container {
  nlohmann::json document;
  std::optional<std::string_view> binary;  ///< the chunk of a GLB
  std::size_t file_bytes = 0;
};

/// A GLB, or the text of a document. Throws MeshError.
Container open_container(std::string_view bytes);

}  // namespace translucube::gltf

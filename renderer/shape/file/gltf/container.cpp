#include "renderer/shape/file/gltf/container.h"

#include <cstdint>
#include <string>

#include "renderer/shape/triangle_mesh.h"

namespace translucube::gltf {
namespace {

using nlohmann::json;

constexpr std::string_view magic = "glTF";
constexpr std::size_t header_bytes = 12, chunk_header_bytes = 8;
constexpr std::uint32_t json_chunk = 0x4E4F534A, binary_chunk = 0x004E4942;
// No document of glTF is deeper than ten or so; extras may be.
constexpr int deepest = 64;

std::uint32_t little_endian(std::string_view bytes) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
  return value;
}

json parse(std::string_view text) {
  const auto bounded = [](int depth, json::parse_event_t, json&) {
    if (depth > deepest) throw MeshError("the JSON is nested too deeply");
    return true;
  };
  try {
    return json::parse(text, bounded);
  } catch (const json::parse_error& error) {
    throw MeshError("the JSON is damaged at its byte " + std::to_string(error.byte));
  } catch (const json::exception&) {  // a number that is none
    throw MeshError("the JSON is damaged");
  }
}

struct Chunk {
  std::uint32_t type = 0;
  std::string_view data;
};

/// Takes a chunk off the rest of a file (specification 2.0, 4.4.3).
Chunk take_chunk(std::string_view file, std::size_t& at) {
  const auto refuse = [&](const std::string& why) {
    throw MeshError("the chunk at byte " + std::to_string(at) + " " + why);
  };
  if (file.size() - at < chunk_header_bytes) refuse("is cut off");
  const std::uint32_t length = little_endian(file.substr(at));
  const std::uint32_t type = little_endian(file.substr(at + 4));
  const std::size_t left = file.size() - at - chunk_header_bytes;
  if (length > left)
    refuse("announces " + std::to_string(length) + " bytes: there are " + std::to_string(left));
  if (length % 4 != 0) refuse("has a length that is no multiple of 4");
  const Chunk chunk{type, file.substr(at + chunk_header_bytes, length)};
  at += chunk_header_bytes + length;
  return chunk;
}

}  // namespace

Container open_container(std::string_view bytes) {
  if (!bytes.starts_with(magic)) return {parse(bytes), std::nullopt, bytes.size()};
  if (bytes.size() < header_bytes) throw MeshError("the GLB ends within its header");
  const std::uint32_t version = little_endian(bytes.substr(4)),
                      length = little_endian(bytes.substr(8));
  if (version != 2)
    throw MeshError("the GLB is of version " + std::to_string(version) + "; read is version 2");
  if (length != bytes.size())
    throw MeshError("the GLB announces " + std::to_string(length) + " bytes: there are " +
                    std::to_string(bytes.size()));
  std::size_t at = header_bytes;
  const Chunk first = take_chunk(bytes, at);
  if (first.type != json_chunk) throw MeshError("the first chunk of the GLB is no JSON");
  Container container{parse(first.data), std::nullopt, bytes.size()};
  for (bool second = true; at < bytes.size(); second = false) {
    const Chunk chunk = take_chunk(bytes, at);
    if (second && chunk.type == binary_chunk) container.binary = chunk.data;
  }
  return container;
}

}  // namespace translucube::gltf

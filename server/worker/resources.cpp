#include "server/worker/resources.h"

#include <algorithm>
#include <array>

#include "api/request/upload.h"
#include "server/base/file.h"

namespace translucube::server {

std::optional<Resource> resource_of(const api::RenderRequest& request, const api::Catalog& catalog,
                                    SceneError::Part part) {
  if (part == SceneError::Part::object) {
    const auto* mesh = std::get_if<api::MeshRequest>(&request.object);
    if (!mesh) return std::nullopt;
    return Resource{api::file_of(*mesh, catalog), Setback::Of::request};
  }
  if (part != SceneError::Part::environment) return std::nullopt;
  const auto& source = request.environment.source;
  if (const auto* own = std::get_if<api::FileEnvironment>(&source))
    return Resource{own->file, Setback::Of::request};
  if (const auto* uploaded = std::get_if<api::UploadedEnvironment>(&source))
    return Resource{api::file_of(*uploaded, catalog), Setback::Of::request};
  if (const auto* named = std::get_if<api::NamedEnvironment>(&source))
    if (const auto found = catalog.environments.find(named->image);
        found != catalog.environments.end())
      return Resource{found->second, Setback::Of::service};
  return std::nullopt;
}

bool can_be_read(const std::filesystem::path& file) {
  try {
    const auto opened = OpenFile::open(file);
    if (!opened) return false;
    std::array<char, 1 << 16> part{};
    for (std::uint64_t at = 0; at < opened->size(); at += part.size())
      opened->read(at, part.data(), std::min<std::uint64_t>(part.size(), opened->size() - at));
    return true;
  } catch (const FileError&) {
    return false;
  }
}

std::string without_path(std::string message, const std::filesystem::path& file) {
  for (const std::string& path : {file.string(), file.parent_path().string() + '/'})
    for (std::size_t at = 0; !path.empty() && (at = message.find(path, at)) != message.npos;)
      message.replace(at, path.size(), path == file.string() ? "the file" : "");
  return message;
}

bool is_of_resources(const api::Problem& problem) {
  constexpr std::array<std::string_view, 6> named{"/environment/image",  "/environment/file",
                                                  "/environment/upload", "/object/file",
                                                  "/object/upload",      "/absorber"};
  return !problem.faults.empty() && std::ranges::all_of(problem.faults, [&](const auto& fault) {
    return fault.pointer.starts_with("/absorbers/") ||
           std::ranges::any_of(named,
                               [&](std::string_view end) { return fault.pointer.ends_with(end); });
  });
}

}  // namespace translucube::server

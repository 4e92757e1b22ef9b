#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "api/base/problem.h"
#include "api/request/catalog.h"
#include "renderer/render.h"
#include "server/worker/setbacks.h"

namespace translucube::server {

/// A file that a request needs for a part of its scene.
struct Resource {
  std::filesystem::path file;
  Setback::Of of = Setback::Of::service;  ///< whose file it is
};
std::optional<Resource> resource_of(const api::RenderRequest& request, const api::Catalog& catalog,
                                    SceneError::Part part);

/// True if all its bytes can be read just now.
bool can_be_read(const std::filesystem::path& file);

/// A library's message for clients: a path of the service is not theirs.
std::string without_path(std::string message, const std::filesystem::path& file);

/// True if the problem of a request that was accepted is that what it names is away.
bool is_of_resources(const api::Problem& problem);

}  // namespace translucube::server

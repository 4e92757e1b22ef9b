#pragma once

// What a request may name, as the answers of the service.

#include <string>
#include <vector>

#include "api/request/catalog.h"
#include "picture/color.h"

namespace translucube::api {

/// GET /v1/absorbers: {"absorbers": [{"name", "description", "wavelengths_nm", "values"}]}.
std::string absorbers_json(const Catalog& catalog);

/// What is told of an upload: {"sha256", "bytes", "uploaded_at"}.
struct UploadReport {
  std::string sha256;
  std::uint64_t bytes = 0;
  std::string uploaded_at;  ///< RFC 3339
};
std::string to_json(const UploadReport& upload);

/// GET /v1/environments: {"environments": [{"name"}], "uploads": [upload...]}.
std::string environments_json(const Catalog& catalog, const std::vector<UploadReport>& uploads);

/// GET /v1/meshes: {"meshes": [upload...]}.
std::string meshes_json(const std::vector<UploadReport>& uploads);

/// GET /v1/objects: {"objects": [part...], "backdrop": part, "oil_film": part}, each part {"name",
/// "description", "parameters": [{"name", "type", "description", and what bounds it}]}: enough to
/// build a form of.
std::string objects_json(const Catalog& catalog);

/// GET /v1/displays: {"displays": [{"name", "views": [...]}]}, the defaults first.
std::string displays_json(const std::vector<Display>& displays);

}  // namespace translucube::api

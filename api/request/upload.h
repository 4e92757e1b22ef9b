#pragma once

// Meshes and environments that clients have sent, named by the SHA-256 of their bytes: what they
// are, where they lie, and whether one is what its kind has to be.

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "api/base/problem.h"
#include "api/request/catalog.h"

namespace translucube::api {

enum class UploadKind { mesh, environment };

/// "meshes", "environments": of paths of URLs and of folders.
const char* collection_of(UploadKind kind);

/// Where an upload lies in the folder of them all.
std::filesystem::path upload_file(const std::filesystem::path& folder, UploadKind kind,
                                  const std::string& sha256);

/// The file of a mesh, wherever it is, and that of an uploaded environment.
std::filesystem::path file_of(const MeshRequest& mesh, const Catalog& catalog);
std::filesystem::path file_of(const UploadedEnvironment& environment, const Catalog& catalog);

/// The files of the uploads that a request names.
std::vector<std::filesystem::path> uploads_of(const RenderRequest& request, const Catalog& catalog);

/// Why a file cannot be an upload of this kind; empty where it can. It is parsed in the sandbox.
std::optional<Problem> refusal_of(const std::filesystem::path& file, UploadKind kind);

}  // namespace translucube::api

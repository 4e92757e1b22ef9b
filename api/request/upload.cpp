#include "api/request/upload.h"

#include "api/base/faults.h"
#include "renderer/scene/spec.h"

namespace translucube::api {
namespace {

namespace fs = std::filesystem;

fs::path upload_file(const Catalog& catalog, UploadKind kind, const std::string& sha256) {
  return upload_file(catalog.uploads.value_or(fs::path()), kind, sha256);
}

}  // namespace

const char* collection_of(UploadKind kind) {
  return kind == UploadKind::mesh ? "meshes" : "environments";
}

fs::path upload_file(const fs::path& folder, UploadKind kind, const std::string& sha256) {
  return folder / collection_of(kind) / sha256;
}

fs::path file_of(const MeshRequest& mesh, const Catalog& catalog) {
  return mesh.upload.empty() ? fs::path(mesh.file)
                             : upload_file(catalog, UploadKind::mesh, mesh.upload);
}

fs::path file_of(const UploadedEnvironment& environment, const Catalog& catalog) {
  return upload_file(catalog, UploadKind::environment, environment.upload);
}

std::vector<fs::path> uploads_of(const RenderRequest& request, const Catalog& catalog) {
  std::vector<fs::path> files;
  if (const auto* mesh = std::get_if<MeshRequest>(&request.object); mesh && !mesh->upload.empty())
    files.push_back(file_of(*mesh, catalog));
  if (const auto* map = std::get_if<UploadedEnvironment>(&request.environment.source))
    files.push_back(file_of(*map, catalog));
  return files;
}

std::optional<Problem> refusal_of(const fs::path& file, UploadKind kind) {
  try {
    kind == UploadKind::mesh ? check_mesh({file, {}}) : check_environment(file);
  } catch (const SceneError& error) {
    if (error.unavailable)
      return Problem{ProblemCode::overloaded, "The file could not be read just now.", {}};
    Faults faults;
    faults.add("", error.what());
    return invalid_request(faults);
  }
  return std::nullopt;
}

}  // namespace translucube::api

#include "server/store/content.h"

#include <sys/stat.h>

#include "api/base/text.h"
#include "renderer/render.h"
#include "server/base/ids.h"
#include "server/base/sha256.h"

namespace translucube::server {
namespace {

/// What a key is the hash of. Each part is preceded by its length: no two lists of parts look the
/// same.
class Parts {
 public:
  void add(std::string_view part) {
    const std::uint64_t size = part.size();
    bytes_.append(reinterpret_cast<const char*>(&size), sizeof size);
    bytes_ += part;
  }
  void add(const std::vector<double>& values) {
    add({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(double)});
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

void add_file(Parts& parts, const std::filesystem::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0) return;  // whoever traces it will tell
  parts.add(std::to_string(info.st_size) + ' ' + std::to_string(info.st_mtim.tv_sec) + '.' +
            std::to_string(info.st_mtim.tv_nsec));
}

}  // namespace

std::string content_key(const api::RenderRequest& request, std::string_view canonical,
                        const api::Catalog& catalog, std::string_view traced_with) {
  Parts parts;
  parts.add(engine_version());
  parts.add(canonical);
  parts.add(traced_with);
  if (const auto* name = std::get_if<std::string>(&request.material.absorber)) {
    const auto found = catalog.absorbers.find(*name);
    if (found != catalog.absorbers.end()) {
      parts.add(found->second.spectrum.wavelengths_nm);
      parts.add(found->second.spectrum.values);
    }
  }
  const auto& source = request.environment.source;
  if (const auto* named = std::get_if<api::NamedEnvironment>(&source)) {
    const auto found = catalog.environments.find(named->image);
    if (found != catalog.environments.end()) add_file(parts, found->second);
  }
  if (const auto* own = std::get_if<api::FileEnvironment>(&source)) add_file(parts, own->file);
  // Uploads stand in the canonical request by their bytes.
  const auto* mesh = std::get_if<api::MeshRequest>(&request.object);
  if (mesh && !mesh->file.empty()) add_file(parts, mesh->file);
  return hex(sha256(parts.bytes()));
}

bool is_content_key(std::string_view text) { return api::is_sha256(text); }

}  // namespace translucube::server

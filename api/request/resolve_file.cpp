#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "api/base/text.h"
#include "api/request/read_request.h"
#include "renderer/scene/spec.h"

namespace translucube::api {
namespace {

namespace fs = std::filesystem;

bool inside(const fs::path& file, const fs::path& folder) {
  const auto [end, differs] = std::mismatch(folder.begin(), folder.end(), file.begin(), file.end());
  return end == folder.end() && differs != file.end();
}

/// The places that a request may mean: a relative path is relative to each allowed folder, or to
/// the working folder on the command line.
std::vector<fs::path> candidates(const fs::path& file, const Catalog& catalog) {
  std::vector<fs::path> places;
  std::error_code error;
  if (catalog.any_file || file.is_absolute()) {
    places.push_back(fs::weakly_canonical(fs::absolute(file, error), error));
    if (error) places.clear();
  } else {
    for (const fs::path& folder : catalog.file_folders) {
      fs::path place = fs::weakly_canonical(folder / file, error);
      if (!error) places.push_back(std::move(place));
    }
  }
  if (!catalog.any_file)
    std::erase_if(places, [&](const fs::path& place) {
      return std::none_of(catalog.file_folders.begin(), catalog.file_folders.end(),
                          [&](const fs::path& folder) { return inside(place, folder); });
    });
  return places;
}

/// Whether the path is UTF-8 without control characters: a symbolic link may lead to a name that no
/// JSON text can carry.
bool is_text(const std::string& path) {
  if (std::any_of(path.begin(), path.end(), [](unsigned char c) { return c < 32; })) return false;
  try {
    return !nlohmann::json(path).dump().empty();
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
}

}  // namespace

std::optional<std::string> resolve_file(const std::string& file, const std::string& pointer,
                                        const Catalog& catalog, Faults& faults) {
  if (file.empty() || !is_text(file)) {
    faults.add(pointer, "must be a path");
    return std::nullopt;
  }
  const std::vector<fs::path> places = candidates(file, catalog);
  if (places.empty()) {
    faults.add(pointer, catalog.any_file ? "is no path that can be resolved"
                                         : "lies outside the folders that requests may name");
    return std::nullopt;
  }
  std::error_code error;
  for (const fs::path& place : places)
    if (fs::is_regular_file(place, error) && is_text(place.string())) {
      if (std::ifstream(place).is_open()) return place.string();
      faults.add(pointer, "cannot be opened for reading");
      return std::nullopt;
    }
  const bool exists = std::any_of(places.begin(), places.end(),
                                  [&](const fs::path& place) { return fs::exists(place, error); });
  faults.add(pointer, exists ? "is not a regular file" : "there is no such file");
  return std::nullopt;
}

bool check_upload(UploadKind kind, const std::string& sha256, const std::string& pointer,
                  const Catalog& catalog, Faults& faults) {
  std::error_code error;
  if (!is_sha256(sha256))
    faults.add(pointer, "must be a SHA-256: 64 hexadecimal digits in lower case");
  else if (!catalog.uploads)
    faults.add(pointer, "only a service has uploads; name a file");
  else if (!fs::is_regular_file(upload_file(*catalog.uploads, kind, sha256), error))
    faults.add(pointer, std::string("there is no such upload; PUT it to /v1/") +
                            collection_of(kind) + "/ and this name first");
  else
    return true;
  return false;
}

bool check_file(const std::function<void(const std::string&)>& check, const std::string& file,
                const std::string& pointer, const Catalog& catalog, Faults& faults) {
  if (catalog.knows_files) return true;
  try {
    check(file);
  } catch (const SceneError& error) {
    // What the machine cannot do now is tried again by whoever renders.
    if (error.unavailable) return true;
    faults.add(pointer, error.what());
    return false;
  }
  return true;
}

}  // namespace translucube::api

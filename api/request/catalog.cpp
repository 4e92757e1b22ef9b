#include "api/request/catalog.h"

#include <algorithm>
#include <limits>
#include <system_error>
#include <utility>

#include "api/base/config_file.h"
#include "api/request/canonical.h"
#include "api/request/read_request.h"

namespace translucube::api {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

/// Names stand in requests, paths of URLs and terminals.
bool is_name(const std::string& name) {
  return !name.empty() && name.size() <= 64 &&
         name.find_first_not_of(
             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._-") ==
             std::string::npos;
}

/// The files of a folder with one of these extensions, by their stems.
std::map<std::string, fs::path> named_files(const fs::path& folder,
                                            const std::vector<std::string>& extensions) {
  std::map<std::string, fs::path> files;
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end;
       entry.increment(error)) {
    const fs::path& file = entry->path();
    if (std::find(extensions.begin(), extensions.end(), file.extension()) == extensions.end())
      continue;
    const std::string name = file.stem().string();
    if (!is_name(name))
      throw ConfigError(file.string() + ": a name has letters, digits and . _ - only, 64 at most");
    if (!files.emplace(name, file).second)
      throw ConfigError(file.string() + ": there is another file of this name");
  }
  if (error) throw ConfigError(folder.string() + " cannot be listed: " + error.message());
  return files;
}

NamedAbsorber read_absorber_file(const fs::path& path) {
  ConfigFile file(path);
  FieldReader& object = file.fields();
  NamedAbsorber absorber;
  absorber.description = object.string("description", Presence::required).value_or("");
  object.string("source", Presence::required);
  if (auto spectrum = read_spectrum(object)) absorber.spectrum = std::move(*spectrum);
  object.refuse_unknown_keys();
  file.refuse_faults();
  return absorber;
}

Limits read_limits(const json& value, const std::string& pointer, Faults& faults) {
  Limits limits;
  FieldReader object(value, pointer, faults);
  if (const auto bytes = object.integer("body_bytes", 1024, std::uint64_t{1} << 30))
    limits.body_bytes = *bytes;
  if (const auto bytes = object.integer("upload_bytes", 1024, std::uint64_t{1} << 31))
    limits.upload_bytes = *bytes;
  if (const auto pixels = object.integer("pixels", 1, std::uint64_t{1} << 32))
    limits.pixels = *pixels;
  if (const auto samples = object.integer("samples", 1, std::numeric_limits<std::uint32_t>::max()))
    limits.samples = static_cast<std::uint32_t>(*samples);
  if (const auto seconds = object.number("seconds", {0, 1e9, true, false}))
    limits.seconds = *seconds;
  if (const auto samples = object.number("camera_samples", {1, 1e18}))
    limits.camera_samples = *samples;
  if (const auto points = object.integer("points", 1, 1'000'000))
    limits.points = static_cast<std::uint32_t>(*points);
  object.refuse_unknown_keys();
  return limits;
}

std::vector<fs::path> read_folders(const json& value, const std::string& pointer,
                                   ConfigFile& file) {
  std::vector<fs::path> folders;
  if (!value.is_array()) file.faults().add(pointer, "must be an array of folders");
  for (std::size_t i = 0; value.is_array() && i < value.size(); ++i) {
    const std::string where = pointer + '/' + std::to_string(i);
    std::error_code error;
    if (!value[i].is_string()) {
      file.faults().add(where, "must be a folder");
      continue;
    }
    fs::path path = fs::canonical(file.folder() / value[i].get<std::string>(), error);
    if (error || !fs::is_directory(path, error))
      file.faults().add(where, "there is no such folder");
    else
      folders.push_back(std::move(path));
  }
  return folders;
}

/// Faults for the keys that the canonical form of the defaults has and the file has not: every
/// default stands in the file.
void require_all(const json& canonical, const json& given, const std::string& pointer,
                 Faults& faults) {
  for (const auto& [key, value] : canonical.items()) {
    const std::string where = pointer + '/' + pointer_token(key);
    if (!given.is_object() || !given.contains(key)) {
      faults.add(where, "is required: every default stands here");
    } else if (value.is_object()) {
      require_all(value, given[key], where, faults);
    }
  }
}

void read_defaults(const json& value, Catalog& catalog, Faults& faults) {
  const std::string pointer = "/request_defaults";
  const std::size_t faults_before = faults.count();
  catalog.defaults.environment.source = ConstantEnvironment{};
  read_request(value, pointer, catalog, MaterialPoint::refused, catalog.defaults, faults);
  if (faults.count() > faults_before) return;
  json canonical = json::parse(canonical_json(catalog.defaults));
  canonical["material"].erase("cube");
  require_all(canonical, value, pointer, faults);
}

}  // namespace

Catalog load_catalog(ConfigFile& file) {
  FieldReader& object = file.fields();
  const auto path = [&](const char* key) {
    const auto text = object.string(key, Presence::required);
    return text ? file.resolved(*text) : fs::path{};
  };
  Catalog catalog;
  if (const json* limits = object.find("limits"))
    catalog.limits = read_limits(*limits, "/limits", file.faults());
  object.find("server");  // for who serves: server/base/server_config.h
  catalog.display_config = path("display_config");
  const fs::path absorbers = path("absorbers");
  const fs::path environments = path("environments");
  if (const json* folders = object.find("file_folders"))
    catalog.file_folders = read_folders(*folders, "/file_folders", file);
  const json* defaults = object.find("request_defaults", Presence::required);
  object.refuse_unknown_keys();
  file.refuse_faults();

  for (const auto& [name, spectrum] : named_files(absorbers, {".json"}))
    catalog.absorbers.emplace(name, read_absorber_file(spectrum));
  catalog.environments = named_files(environments, {".exr", ".hdr"});
  read_defaults(*defaults, catalog, file.faults());
  file.refuse_faults();
  return catalog;
}

Catalog load_catalog(const fs::path& service_json) {
  ConfigFile file(service_json);
  return load_catalog(file);
}

Catalog without_limits(Catalog catalog) {
  constexpr double any = std::numeric_limits<double>::infinity();
  constexpr auto most = std::numeric_limits<std::uint32_t>::max();
  constexpr auto most_bytes = std::numeric_limits<std::uint64_t>::max();
  catalog.limits = {most_bytes, most_bytes, most, any, most_bytes, any, most};
  catalog.knows_files = true;
  return catalog;
}

}  // namespace translucube::api

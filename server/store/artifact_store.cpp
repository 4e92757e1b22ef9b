#include "server/store/artifact_store.h"

#include <map>

#include "api/base/text.h"
#include "renderer/film/film_bytes.h"

namespace translucube::server {
namespace {

namespace fs = std::filesystem;

std::string pass_name(std::uint32_t index) { return "pass-" + std::to_string(index) + ".film"; }
std::string film_name(std::uint32_t passes) { return "film-" + std::to_string(passes) + ".bin"; }

/// The number in "<prefix><number><suffix>".
std::optional<std::uint32_t> number_in(std::string_view name, std::string_view prefix,
                                       std::string_view suffix) {
  if (!name.starts_with(prefix) || !name.ends_with(suffix)) return std::nullopt;
  if (name.size() <= prefix.size() + suffix.size()) return std::nullopt;
  name.remove_prefix(prefix.size());
  name.remove_suffix(suffix.size());
  return api::number_of<std::uint32_t>(name);
}

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    paths.push_back(it->path());
  if (error && error != std::errc::no_such_file_or_directory)
    throw FileError("cannot read " + folder.string() + ": " + error.message());
  return paths;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError("cannot create " + folder.string() + ": " + error.message());
}

}  // namespace

ArtifactStore::ArtifactStore(fs::path root) : root_(std::move(root)) {
  make_folder(root_);
  for (const std::string& id : ids())
    for (const fs::path& file : entries(root_ / id))
      if (is_temporary_name(file.filename().string())) remove(id, file.filename().string());
}

fs::path ArtifactStore::path(const std::string& id, const std::string& name) const {
  return root_ / id / name;
}

void ArtifactStore::write(const std::string& id, const std::string& name, std::string_view bytes) {
  make_folder(root_ / id);
  write_atomically(path(id, name), bytes);
}

void ArtifactStore::write(const std::string& id, const std::string& name,
                          const std::function<void(const fs::path&)>& writer) {
  make_folder(root_ / id);
  write_atomically(path(id, name), writer);
}

std::shared_ptr<const OpenFile> ArtifactStore::open(const std::string& id,
                                                    const std::string& name) const {
  return OpenFile::open(path(id, name));
}

std::vector<std::string> ArtifactStore::names(const std::string& id) const {
  std::vector<std::string> names;
  for (const fs::path& file : entries(root_ / id)) names.push_back(file.filename().string());
  return names;
}

void ArtifactStore::remove(const std::string& id, const std::string& name) {
  std::error_code error;
  fs::remove(path(id, name), error);
  if (error) throw FileError("cannot remove " + path(id, name).string() + ": " + error.message());
}

void ArtifactStore::remove_all(const std::string& id) {
  std::error_code error;
  fs::remove_all(root_ / id, error);
  // Another thread may be removing the same files.
  if (error && error != std::errc::no_such_file_or_directory)
    throw FileError("cannot remove " + (root_ / id).string() + ": " + error.message());
}

void ArtifactStore::remove_if_empty(const std::string& id) {
  std::error_code not_empty;
  fs::remove(root_ / id, not_empty);
}

std::vector<std::string> ArtifactStore::ids() const {
  std::vector<std::string> ids;
  for (const fs::path& folder : entries(root_))
    if (fs::is_directory(folder)) ids.push_back(folder.filename().string());
  return ids;
}

std::uint64_t ArtifactStore::bytes(const std::string& id) const {
  std::uint64_t sum = 0;
  for (const fs::path& file : entries(root_ / id)) {
    std::error_code gone;
    const std::uint64_t size = fs::file_size(file, gone);
    if (!gone) sum += size;
  }
  return sum;
}

void ArtifactStore::check_writable() {
  const fs::path probe = root_ / "probe";
  write_atomically(probe, "writable");
  std::error_code ignored;
  fs::remove(probe, ignored);
}

void ArtifactStore::write_pass(const std::string& id, const PassFilm& film) {
  write(id, pass_name(film.pass.index), to_bytes(film));
}

void ArtifactStore::write_film(const std::string& id, const Film& film) {
  write(id, film_name(film.passes), to_bytes(film));
}

std::optional<PassFilm> ArtifactStore::read_pass(const std::string& id, const Pass& pass) const {
  const auto file = open(id, pass_name(pass.index));
  if (!file) return std::nullopt;
  try {
    PassFilm film = pass_film_from_bytes(file->read_all());
    if (film.pass == pass) return film;
  } catch (const FileError&) {
    throw;
  } catch (const std::runtime_error&) {
    // Not whole: as good as not there.
  }
  return std::nullopt;
}

Film ArtifactStore::read_film(const std::string& id, std::uint32_t pass_count) const {
  std::map<std::uint32_t, std::string> checkpoints, partial_films;
  for (const std::string& name : names(id)) {
    const auto passes = number_in(name, "film-", ".bin");
    if (passes && *passes <= pass_count) checkpoints.emplace(*passes, name);
    const auto index = number_in(name, "pass-", ".film");
    if (index && *index < pass_count) partial_films.emplace(*index, name);
  }

  Film film;
  for (auto it = checkpoints.rbegin(); it != checkpoints.rend() && film.passes == 0; ++it) {
    try {
      if (const auto file = open(id, it->second)) film = film_from_bytes(file->read_all());
    } catch (const FileError&) {
      throw;
    } catch (const std::runtime_error&) {
      film = {};  // not whole: an older one may be
    }
  }
  try {
    while (film.passes < pass_count) {
      const auto next = partial_films.find(film.passes);
      if (next == partial_films.end()) break;
      const auto file = open(id, next->second);
      if (!file) break;
      const PassFilm pass = pass_film_from_bytes(file->read_all());
      if (pass.pass.index != film.passes) break;
      merge(film, pass);
    }
  } catch (const FileError&) {
    throw;
  } catch (const std::runtime_error&) {
    // The passes from here on are traced again.
  }
  return film;
}

void ArtifactStore::remove_films_before(const std::string& id, std::uint32_t pass_count) {
  for (const std::string& name : names(id)) {
    const auto passes = number_in(name, "film-", ".bin");
    const auto index = number_in(name, "pass-", ".film");
    if ((passes && *passes < pass_count) || (index && *index < pass_count)) remove(id, name);
  }
}

void ArtifactStore::remove_films(const std::string& id) {
  for (const std::string& name : names(id))
    if (number_in(name, "film-", ".bin") || number_in(name, "pass-", ".film")) remove(id, name);
}

}  // namespace translucube::server

// The films of an artifact store: partial ones, and checkpoints of merged ones.

#include <map>

#include "api/base/text.h"
#include "renderer/film/film_bytes.h"
#include "server/store/artifact_store.h"

namespace translucube::server {
namespace {

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

}  // namespace

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

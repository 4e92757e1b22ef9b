#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/film/film.h"
#include "server/base/file.h"

namespace translucube::server {

/// Files in folders, <root>/<id>/<name>. A job's folder has its partial films ("pass-3.film") and
/// merged films ("film-4.bin": the passes 0 to 3); a result's, named by its content, the picture
/// and what is derived from it; a sweep's, its contact sheets. A name holds the whole of its file
/// or does not exist (write_atomically). Safe to share by threads. Every function throws FileError
/// where the disk refuses.
class ArtifactStore {
 public:
  /// Creates the folder; removes what a crash left half-written.
  explicit ArtifactStore(std::filesystem::path root);

  void write(const std::string& id, const std::string& name, std::string_view bytes);
  void write(const std::string& id, const std::string& name,
             const std::function<void(const std::filesystem::path&)>& writer);
  /// Empty if there is no such artifact.
  std::shared_ptr<const OpenFile> open(const std::string& id, const std::string& name) const;
  std::filesystem::path path(const std::string& id, const std::string& name) const;
  std::vector<std::string> names(const std::string& id) const;
  void remove(const std::string& id, const std::string& name);
  void remove_all(const std::string& id);
  void remove_if_empty(const std::string& id);
  std::vector<std::string> ids() const;
  std::uint64_t bytes(const std::string& id) const;  ///< of all files in the folder
  void check_writable();

  // Films.
  void write_pass(const std::string& id, const PassFilm& film);
  void write_film(const std::string& id, const Film& film);
  /// Empty where it is not there or not whole (a checkpoint that cannot be read is traced again).
  std::optional<PassFilm> read_pass(const std::string& id, const Pass& pass) const;
  /// The merged film of the passes before `pass_count`, from the newest checkpoint and the partial
  /// films behind it; fewer passes where a file is missing or broken.
  Film read_film(const std::string& id, std::uint32_t pass_count) const;
  /// Removes the checkpoints that a durable film of `pass_count` passes made superfluous.
  void remove_films_before(const std::string& id, std::uint32_t pass_count);
  void remove_films(const std::string& id);

 private:
  std::filesystem::path root_;
};

}  // namespace translucube::server

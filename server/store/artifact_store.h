#pragma once

#include <atomic>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "renderer/film/film.h"
#include "server/base/file.h"
#include "server/base/recent.h"

namespace translucube::server {

/// The hash in a name of `write_hashed`.
std::optional<std::string> hash_in(std::string_view name);

/// Files in folders, <root>/<id>/<name>. A job's folder has its partial films ("pass-3.film") and
/// merged films ("film-4.bin": the passes 0 to 3), which carry checksums of their own; a result's,
/// named by its content, the picture and what is derived from it; a sweep's, its contact sheets. A
/// name holds the whole of its file or does not exist (write_atomically). What is served has the
/// hash of its bytes in its name ("image-ID.HASH.exr"). Safe to share by threads. Every function
/// throws FileError where the disk refuses.
class ArtifactStore {
 public:
  /// Creates the folder, in one that is there; removes what a crash left half-written.
  explicit ArtifactStore(std::filesystem::path root);

  void write(const std::string& id, const std::string& name, std::string_view bytes);
  void write(const std::string& id, const std::string& name,
             const std::function<void(const std::filesystem::path&)>& writer);
  /// Writes "<stem>.<hash><extension>"; returns this name. The same bytes have the same name.
  std::string write_hashed(const std::string& id, const std::string& stem,
                           const std::string& extension,
                           const std::function<void(const std::filesystem::path&)>& writer);
  /// The name that write_hashed gave, if there is such a file.
  std::optional<std::string> hashed_name(const std::string& id, const std::string& stem,
                                         std::string_view extension) const;

  /// Empty if there is no such artifact.
  std::shared_ptr<const OpenFile> open(const std::string& id, const std::string& name) const;
  /// The same of a file whose bytes are those of its name, if that has a hash. One whose bytes are
  /// not is put aside in its folder, told in the log, and no longer there.
  std::shared_ptr<const OpenFile> open_whole(const std::string& id, const std::string& name);
  std::filesystem::path path(const std::string& id, const std::string& name) const;
  std::vector<std::string> names(const std::string& id) const;
  void remove(const std::string& id, const std::string& name);
  void remove_all(const std::string& id);
  void remove_if_empty(const std::string& id);
  std::vector<std::string> ids() const;
  std::uint64_t bytes(const std::string& id) const;  ///< of all files in the folder
  void check_writable();
  std::uint64_t free_bytes() const;  ///< of its file system, for who is not root

  /// Nobody knows whose this folder is: it stays as it is, and is not among `bytes`.
  void leave_alone(const std::string& id);
  struct Figures {
    std::uint64_t bytes = 0;                       ///< of all files, those left alone apart
    std::uint64_t unknown = 0, unknown_bytes = 0;  ///< folders left alone
    std::uint64_t damaged = 0;                     ///< files found damaged since the start
  };
  Figures figures() const;

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
  void in_folder(const std::string& id, const std::function<void()>& write);
  void count(const std::string& id);

  std::filesystem::path root_;
  Recent<std::string, std::string> checked_;  ///< versions of whole files, by "<id>/<name>"
  mutable std::mutex counting_;
  std::unordered_map<std::string, std::uint64_t> counted_;  ///< bytes, by folder
  std::uint64_t bytes_ = 0, unknown_ = 0, unknown_bytes_ = 0;
  std::atomic<std::uint64_t> damaged_ = 0;
};

}  // namespace translucube::server

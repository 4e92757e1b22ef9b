#include "server/store/artifact_store.h"

#include <spdlog/spdlog.h>
#include <sys/stat.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "server/base/ids.h"

namespace translucube::server {
namespace {

namespace fs = std::filesystem;

// A file whose bytes were found right is not read again for a while, unless it was changed.
constexpr std::chrono::seconds checked_for(10);
constexpr std::size_t most_checked = 4096;
// Of SHA-256's: 128 bits, so that names stay short.
constexpr std::size_t hash_digits = 32;
constexpr std::string_view damaged_prefix = "damaged-";

std::vector<fs::path> entries(const fs::path& folder) {
  std::vector<fs::path> paths;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    paths.push_back(it->path());
  if (error && error != std::errc::no_such_file_or_directory)
    throw FileError("cannot read " + folder.string() + ": " + error.message());
  return paths;
}

std::string hash_of(const OpenFile& file) { return hex(file.sha256()).substr(0, hash_digits); }

}  // namespace

std::optional<std::string> hash_in(std::string_view name) {
  const std::size_t end = name.rfind('.');
  if (end == name.npos || end < hash_digits + 1 || name[end - hash_digits - 1] != '.') return {};
  const std::string_view hash = name.substr(end - hash_digits, hash_digits);
  if (hash.find_first_not_of("0123456789abcdef") != hash.npos) return {};
  return std::string(hash);
}

ArtifactStore::ArtifactStore(fs::path root)
    : root_(std::move(root)), checked_(most_checked, checked_for) {
  make_folder(root_);
  for (const std::string& id : ids()) {
    for (const fs::path& file : entries(root_ / id))
      if (is_temporary_name(file.filename().string())) remove(id, file.filename().string());
    count(id);
  }
}

fs::path ArtifactStore::path(const std::string& id, const std::string& name) const {
  return root_ / id / name;
}

/// Runs `write` with the folder there. Another thread may remove it just then, as empty.
void ArtifactStore::in_folder(const std::string& id, const std::function<void()>& write) {
  constexpr int most_tries = 3;
  for (int tries = 1;; ++tries) try {
      make_folder(root_ / id);
      write();
      break;
    } catch (const FileError&) {
      std::error_code error;
      if (tries == most_tries || fs::exists(root_ / id, error) || !fs::exists(root_, error)) throw;
    }
  count(id);
}

void ArtifactStore::write(const std::string& id, const std::string& name, std::string_view bytes) {
  in_folder(id, [&] { write_atomically(path(id, name), bytes); });
}

void ArtifactStore::write(const std::string& id, const std::string& name,
                          const std::function<void(const fs::path&)>& writer) {
  in_folder(id, [&] { write_atomically(path(id, name), writer); });
}

std::string ArtifactStore::write_hashed(const std::string& id, const std::string& stem,
                                        const std::string& extension,
                                        const std::function<void(const fs::path&)>& writer) {
  fs::path written;
  in_folder(id, [&] {
    written = write_atomically_named(root_ / id, extension, writer, [&](const OpenFile& file) {
      return path(id, stem + '.' + hash_of(file) + extension);
    });
  });
  return written.filename().string();
}

std::shared_ptr<const OpenFile> ArtifactStore::open(const std::string& id,
                                                    const std::string& name) const {
  auto file = OpenFile::open(path(id, name));
  // What is asked of a disk that is not there is not lost.
  if (std::error_code error; !file && !fs::is_directory(root_, error))
    throw FileError("cannot open " + root_.string() + ": it is not there");
  return file;
}

std::shared_ptr<const OpenFile> ArtifactStore::open_whole(const std::string& id,
                                                          const std::string& name) {
  auto file = open(id, name);
  const auto hash = file ? hash_in(name) : std::nullopt;
  if (!hash) return file;
  const std::string key = id + '/' + name;
  if (checked_.find(key) == file->version()) return file;
  const auto now = checked_.now();
  if (hash_of(*file) == *hash) {
    checked_.keep(key, file->version(), now);
    return file;
  }
  ++damaged_;
  spdlog::error("{}: its bytes are not those that were written; kept as {}{}", key, damaged_prefix,
                name);
  if (::rename(path(id, name).c_str(), path(id, std::string(damaged_prefix) + name).c_str()) != 0 &&
      errno != ENOENT)
    throw FileError("cannot put aside " + path(id, name).string());
  return nullptr;
}

std::optional<std::string> ArtifactStore::hashed_name(const std::string& id,
                                                      const std::string& stem,
                                                      std::string_view extension) const {
  const std::size_t size = stem.size() + 1 + hash_digits + extension.size();
  for (std::string& name : names(id))
    if (name.size() == size && name.starts_with(stem + '.') && name.ends_with(extension) &&
        hash_in(name))
      return std::move(name);
  return std::nullopt;
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
  count(id);
}

void ArtifactStore::remove_all(const std::string& id) {
  std::error_code error;
  fs::remove_all(root_ / id, error);
  // Another thread may be removing the same files.
  if (error && error != std::errc::no_such_file_or_directory)
    throw FileError("cannot remove " + (root_ / id).string() + ": " + error.message());
  count(id);
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

void ArtifactStore::count(const std::string& id) {
  const std::lock_guard lock(counting_);
  const std::uint64_t now = bytes(id);
  std::uint64_t& before = counted_[id];
  bytes_ += now - before;
  before = now;
  if (now == 0) counted_.erase(id);
}

void ArtifactStore::leave_alone(const std::string& id) {
  const std::lock_guard lock(counting_);
  const auto counted = counted_.find(id);
  if (counted == counted_.end()) return;
  bytes_ -= counted->second;
  unknown_bytes_ += counted->second;
  ++unknown_;
  counted_.erase(counted);
}

ArtifactStore::Figures ArtifactStore::figures() const {
  const std::lock_guard lock(counting_);
  return {bytes_, unknown_, unknown_bytes_, damaged_};
}

std::uint64_t ArtifactStore::free_bytes() const {
  struct statvfs system {};
  if (::statvfs(root_.c_str(), &system) != 0)
    throw FileError("cannot look at " + root_.string() + ": " + std::strerror(errno));
  return std::uint64_t{system.f_bavail} * system.f_frsize;
}

void ArtifactStore::check_writable() {
  const fs::path probe = root_ / "probe";
  write_atomically(probe, "writable");
  std::error_code ignored;
  fs::remove(probe, ignored);
}

}  // namespace translucube::server

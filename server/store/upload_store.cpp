#include "server/store/upload_store.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/statvfs.h>

#include <algorithm>
#include <array>
#include <cerrno>

#include "api/base/text.h"

namespace translucube::server {
namespace {

namespace fs = std::filesystem;

// What a file takes of the quota at least, so that many small ones do not fill tables of the disk
// and answers.
constexpr std::uint64_t least_counted = 64 << 10;
// Left for what else the service writes.
constexpr std::uint64_t spare_bytes = 64 << 20;

constexpr std::array all_kinds{api::UploadKind::mesh, api::UploadKind::environment};

std::uint64_t counted(std::uint64_t bytes) { return std::max(bytes, least_counted); }

std::int64_t ms_of(const timespec& time) {
  return std::int64_t{time.tv_sec} * 1000 + time.tv_nsec / 1'000'000;
}

std::optional<Upload> look_at(const fs::path& file, api::UploadKind kind) {
  struct stat status {};
  if (::lstat(file.c_str(), &status) != 0) {
    if (errno == ENOENT) return std::nullopt;
    fail(file, "look at", errno);
  }
  if (!S_ISREG(status.st_mode)) return std::nullopt;
  return Upload{kind, file.filename().string(), static_cast<std::uint64_t>(status.st_size),
                ms_of(status.st_mtim), ms_of(status.st_atim)};
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error))
    files.push_back(it->path());
  if (error) throw FileError("cannot read " + folder.string() + ": " + error.message());
  return files;
}

std::uint64_t free_bytes(const fs::path& folder) {
  struct statvfs system {};
  if (::statvfs(folder.c_str(), &system) != 0) fail(folder, "look at", errno);
  return std::uint64_t{system.f_bavail} * system.f_frsize;
}

void set_times(const fs::path& file, bool uploaded) {
  const std::array<timespec, 2> times{timespec{0, UTIME_NOW},
                                      timespec{0, uploaded ? UTIME_NOW : UTIME_OMIT}};
  ::utimensat(AT_FDCWD, file.c_str(), times.data(), AT_SYMLINK_NOFOLLOW);
}

}  // namespace

UploadStore::UploadStore(fs::path root, std::uint64_t quota_bytes)
    : root_(std::move(root)), quota_bytes_(quota_bytes) {
  make_folder(root_);
  for (const api::UploadKind kind : all_kinds) make_folder(root_ / api::collection_of(kind));
  for (const fs::path& file : files_in(root_)) {
    std::error_code ignored;
    if (is_temporary_name(file.filename().string())) fs::remove(file, ignored);
  }
}

std::optional<Upload> UploadStore::find(api::UploadKind kind, const std::string& sha256) const {
  return look_at(api::upload_file(root_, kind, sha256), kind);
}

std::vector<Upload> UploadStore::list(api::UploadKind kind) const {
  std::vector<Upload> all;
  for (const fs::path& file : files_in(root_ / api::collection_of(kind)))
    if (api::is_sha256(file.filename().string()))
      if (auto upload = look_at(file, kind)) all.push_back(*std::move(upload));
  std::ranges::sort(all, std::greater(),
                    [](const Upload& u) { return std::pair(u.uploaded_ms, u.sha256); });
  return all;
}

std::uint64_t UploadStore::bytes() const {
  std::uint64_t sum = 0;
  for (const api::UploadKind kind : all_kinds)
    for (const Upload& upload : list(kind)) sum += counted(upload.bytes);
  return sum;
}

UploadStore::Room UploadStore::reserve(std::uint64_t bytes) {
  bytes = counted(bytes);
  const std::lock_guard lock(mutex_);
  if (this->bytes() + reserved_ + bytes > quota_bytes_) return nullptr;
  if (free_bytes(root_) < reserved_ + bytes + spare_bytes) return nullptr;
  reserved_ += bytes;
  return {this, [this, bytes](void*) {
            const std::lock_guard giving_back(mutex_);
            reserved_ -= bytes;
          }};
}

bool UploadStore::keep(ReceivedFile& file, api::UploadKind kind, const std::string& sha256) {
  file.sync();
  const std::lock_guard lock(mutex_);
  // One that was cut on the disk is replaced.
  if (const auto there = find(kind, sha256); there && there->bytes == file.size()) return false;
  const fs::path kept = api::upload_file(root_, kind, sha256);
  file.keep(kept);
  set_times(kept, true);
  return true;
}

void UploadStore::remove(const Upload& upload) {
  const std::lock_guard lock(mutex_);
  const fs::path file = api::upload_file(root_, upload.kind, upload.sha256);
  // It may have been used since it was looked at.
  const auto now = find(upload.kind, upload.sha256);
  if (now && now->used_ms == upload.used_ms && ::unlink(file.c_str()) != 0 && errno != ENOENT)
    fail(file, "remove", errno);
}

void touch_upload(const fs::path& file) { set_times(file, false); }

}  // namespace translucube::server

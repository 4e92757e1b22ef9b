#include "server/service/uploads.h"

#include <algorithm>

#include "server/base/ids.h"
#include "server/service/answers.h"

namespace translucube::server {
namespace {

using api::Problem;
using api::ProblemCode;
using api::Result;
using api::UploadKind;

api::UploadReport report_of(const Upload& upload) {
  return {upload.sha256, upload.bytes, rfc3339(upload.uploaded_ms)};
}

/// Whether one of those that have not ended stands in a list that `list` gives page by page.
template <typename List>
bool any_open(List list, const std::string& text) {
  for (const api::JobState state : {api::JobState::queued, api::JobState::running}) {
    JobFilter filter{state, std::nullopt, 200};
    for (auto page = list(filter); !page.empty(); page = list(filter)) {
      for (const auto& stored : page)
        if (stored.request.find(text) != stored.request.npos) return true;
      filter.before_id = page.back().id;
    }
  }
  return false;
}

}  // namespace

Uploads::Uploads(const ServerConfig& config, std::uint64_t most_bytes, JobStore& jobs,
                 UploadStore& uploads)
    : most_bytes_(most_bytes),
      keep_ms_(config.keep_days * day_ms),
      jobs_(jobs),
      uploads_(uploads),
      places_(config.uploads) {}

Result<std::shared_ptr<ReceivedFile>> Uploads::receive(std::optional<std::uint64_t> length) {
  if (length.value_or(0) > most_bytes_)
    return Problem{ProblemCode::payload_too_large,
                   "An upload may have " + std::to_string(most_bytes_) + " bytes.",
                   {}};
  Places::Place place = places_.take();
  if (!place) return Problem{ProblemCode::overloaded, "Too many uploads come at once.", {}};
  const std::uint64_t bytes = length.value_or(most_bytes_);
  return guarded([&]() -> Result<std::shared_ptr<ReceivedFile>> {
    UploadStore::Room room = uploads_.reserve(bytes);
    if (!room) {
      make_room(bytes);
      room = uploads_.reserve(bytes);
    }
    if (!room)
      return Problem{ProblemCode::storage_failure,
                     "There is no room for an upload of " + std::to_string(bytes) + " bytes.",
                     {}};
    struct Incoming {
      Places::Place place;
      UploadStore::Room room;
      ReceivedFile file;
    };
    const std::shared_ptr<Incoming> incoming(new Incoming{
        std::move(place), std::move(room), ReceivedFile(uploads_.folder(), most_bytes_)});
    return std::shared_ptr<ReceivedFile>(incoming, &incoming->file);
  });
}

Result<Uploads::Kept> Uploads::keep(UploadKind kind, const std::string& sha256,
                                    ReceivedFile& file) {
  const std::string actual = hex(file.sha256());
  if (actual != sha256)
    return Problem{ProblemCode::invalid_request,
                   "The upload is not what its path says.",
                   {{"", "the SHA-256 of the body is " + actual}}};
  return guarded([&]() -> Result<Kept> {
    if (const auto there = uploads_.find(kind, sha256); there && there->bytes == file.size()) {
      touch_upload(api::upload_file(uploads_.folder(), kind, sha256));
      return Kept{report_of(*there), false};
    }
    if (auto problem = api::refusal_of(file.path(), kind)) return *std::move(problem);
    const bool created = uploads_.keep(file, kind, sha256);
    const auto kept = uploads_.find(kind, sha256);
    if (!kept) throw FileError("an upload is gone as soon as it was kept");
    return Kept{report_of(*kept), created};
  });
}

Result<std::vector<api::UploadReport>> Uploads::list(UploadKind kind) const {
  return guarded([&]() -> Result<std::vector<api::UploadReport>> {
    std::vector<api::UploadReport> reports;
    for (const Upload& upload : uploads_.list(kind)) reports.push_back(report_of(upload));
    return reports;
  });
}

void Uploads::make_room(std::uint64_t bytes) {
  std::vector<Upload> unused;
  for (const UploadKind kind : {UploadKind::mesh, UploadKind::environment})
    for (Upload& upload : uploads_.list(kind))
      if (upload.used_ms < system_clock_ms() - keep_ms_) unused.push_back(std::move(upload));
  std::ranges::sort(unused, {}, &Upload::used_ms);
  for (const Upload& upload : unused) {
    if (uploads_.reserve(bytes)) return;  // given back at once
    if (is_needed(upload.sha256)) continue;
    spdlog::info("upload {} of {} removed to make room", upload.sha256,
                 api::collection_of(upload.kind));
    uploads_.remove(upload);
  }
}

bool Uploads::is_needed(const std::string& sha256) const {
  return any_open([&](const JobFilter& filter) { return jobs_.list(filter); }, sha256) ||
         any_open([&](const JobFilter& filter) { return jobs_.list_sweeps(filter); }, sha256);
}

}  // namespace translucube::server

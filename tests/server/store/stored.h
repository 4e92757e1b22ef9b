#pragma once

// What tests put into a job store.

#include <atomic>
#include <optional>
#include <string>
#include <vector>

#include "server/store/job_store.h"

namespace translucube::server::test {

/// A content that no other has.
inline std::string a_content() {
  static std::atomic<int> contents = 0;
  return "content-" + std::to_string(++contents);
}

inline NewJob a_job(const std::string& request = "{}", std::optional<std::string> key = {}) {
  return {request, "{}", std::move(key), 64, Pass{0, 0, 4}, a_content()};
}

inline std::string submit(JobStore& store, const NewJob& job = a_job()) {
  return store.submit(job)->stored.id;
}

/// A sweep whose images have these numbers of lanes.
inline NewSweep a_sweep(const std::vector<int>& lanes, std::optional<std::string> key = {}) {
  NewSweep sweep{"{}", std::move(key), 64, Pass{0, 0, 4}, {}};
  std::uint32_t point = 0;
  for (const int count : lanes) {
    auto& image = sweep.images.emplace_back();
    for (int i = 0; i < count; ++i) image.push_back({point++, a_content()});
  }
  return sweep;
}

inline Completion a_completion(double seconds = 1) {
  Completion completion{seconds, {}};
  completion.progress.passes = 1;
  completion.progress.samples = 4;
  completion.progress.relative_error = 0.5;
  completion.progress.seconds = seconds;
  completion.progress.eta_seconds = 3;
  return completion;
}

}  // namespace translucube::server::test

#pragma once

// An empty job store of each kind, for the tests of what every one must do.

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <ostream>
#include <string>

#include "server/store/job_store.h"
#include "tests/server/temp_folder.h"

namespace translucube::server::test {

struct StoreKind {
  std::string name;
  bool durable;  ///< opened again in the same folder, it has what it had
  std::unique_ptr<JobStore> (*open)(const TempFolder& folder, const StoreOptions& options);
};
inline void PrintTo(const StoreKind& kind, std::ostream* out) { *out << kind.name; }

/// An empty store whose clocks stand still until they are set.
class JobStoreTest : public testing::TestWithParam<StoreKind> {
 protected:
  std::unique_ptr<JobStore> open() {
    const auto clock = [this] { return now; };
    return GetParam().open(
        folder_, {.lease_ms = 1000, .clock = clock, .lease_clock = clock, .most_queued = 60});
  }

  std::int64_t now = 1'000'000;

 private:
  TempFolder folder_;
  std::unique_ptr<JobStore> own_ = open();

 protected:
  JobStore& store = *own_;
  void close() { own_.reset(); }
};

class DurableJobStoreTest : public JobStoreTest {};

inline constexpr const char* unknown_id = "01ARZ3NDEKTSV4RRFFQ69G5FAV";

}  // namespace translucube::server::test

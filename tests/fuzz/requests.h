#pragma once

// What the fuzzers of the parsers share.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <string>
#include <string_view>

#include "api/base/problem.h"
#include "api/request/catalog.h"
#include "tests/support/repository.h"

namespace translucube::fuzz {

/// The shipped configuration; a folder of files, so that paths of files are tried too.
inline const api::Catalog& catalog() {
  static const api::Catalog loaded = [] {
    api::Catalog shipped = api::load_catalog(in_repository("config/service.json"));
    shipped.file_folders.emplace_back(in_repository("tests/fuzz"));
    return shipped;
  }();
  return loaded;
}

/// Ends the process, which the fuzzer takes for a finding.
inline void require(bool holds, std::string_view what) {
  if (holds) return;
  std::cerr << "does not hold: " << what << '\n';
  std::abort();
}

/// A refusal names its faults, and its text is JSON whatever bytes the document had.
inline void check(const api::Problem& problem) {
  const int status = api::kind(problem.code).status;
  require(status == 400 || status == 413 || status == 422, "a bad document is the client's fault");
  require(!problem.detail.empty() || !problem.faults.empty(), "a refusal says why");
  require(!api::to_json(problem).empty(), "a refusal can be told");
}

}  // namespace translucube::fuzz

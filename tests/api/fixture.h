#pragma once

// What the tests of this folder share: the shipped catalog and ways to ask for faults.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "api/request/parse.h"
#include "tests/support/repository.h"

namespace translucube::api {

inline const std::filesystem::path& service_json() {
  static const std::filesystem::path file = in_repository("config/service.json");
  return file;
}

inline const Catalog& shipped_catalog() {
  static const Catalog catalog = load_catalog(service_json());
  return catalog;
}

inline const std::string some_cube = R"({"absorption":0.3,"roughness":0.3,"scattering":0.5})";

/// A request with these members beside a material.
inline std::string request_with(const std::string& members) {
  return R"({"material":{"cube":)" + some_cube + "}," + members + "}";
}
/// A request with these members of the material beside its cube.
inline std::string material_with(const std::string& members) {
  return R"({"material":{"cube":)" + some_cube + "," + members + "}}";
}

/// Where the faults are; none where it was accepted.
template <typename T>
std::vector<std::string> fault_pointers(const Result<T>& result) {
  std::vector<std::string> all;
  if (!result)
    for (const Fault& fault : result.problem().faults) all.push_back(fault.pointer);
  return all;
}

inline std::vector<std::string> pointers(const std::string& text,
                                         const Catalog& catalog = shipped_catalog()) {
  return fault_pointers(parse_render_request(text, catalog));
}

/// What was read of the text; a test fails where there are faults.
template <typename T>
T accepted(Result<T> result, const std::string& text) {
  if (result) return *std::move(result);
  ADD_FAILURE() << text << '\n' << to_text(result.problem());
  return {};
}
inline RenderRequest accepted(const std::string& text, const Catalog& catalog = shipped_catalog()) {
  return accepted(parse_render_request(text, catalog), text);
}

/// The only fault's detail.
inline std::string fault_at(const std::string& pointer, const std::string& text,
                            const Catalog& catalog = shipped_catalog()) {
  const auto result = parse_render_request(text, catalog);
  const Problem problem = result ? Problem{} : result.problem();
  if (problem.faults.size() != 1 || problem.faults[0].pointer != pointer) {
    ADD_FAILURE() << "wants one fault at " << pointer << ": " << text << '\n'
                  << (result ? "(accepted)" : to_text(problem));
    return {};
  }
  return problem.faults[0].detail;
}

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "translucube-XXXXXX").string();
    path_ = std::filesystem::canonical(mkdtemp(name.data()));
  }
  ~TemporaryFolder() { std::filesystem::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path write(const std::string& name, std::string_view text) const {
    const std::filesystem::path file = path_ / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }

 private:
  std::filesystem::path path_;
};

}  // namespace translucube::api

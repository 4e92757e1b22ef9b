#pragma once

// A file of the configuration: JSON, read once, each section by the part of the program that it is
// for, and all faults told at once.

#include <filesystem>
#include <stdexcept>
#include <string>

#include "api/base/field_reader.h"
#include "api/base/json_reader.h"

namespace translucube::api {

struct ConfigError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class ConfigFile {
 public:
  /// Throws ConfigError where the file cannot be read or is no JSON.
  explicit ConfigFile(std::filesystem::path file);
  ConfigFile(const ConfigFile&) = delete;
  ConfigFile& operator=(const ConfigFile&) = delete;

  FieldReader& fields() { return fields_; }
  Faults& faults() { return document_.faults; }
  std::filesystem::path folder() const;  ///< absolute
  /// A path that the file names, which is relative to its folder.
  std::filesystem::path resolved(const std::string& path) const;
  /// Throws ConfigError, which says the file, and the pointer and the reason of each fault.
  void refuse_faults() const;

 private:
  const std::filesystem::path file_;
  JsonDocument document_;
  FieldReader fields_;
};

}  // namespace translucube::api

#include "api/base/config_file.h"

#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace translucube::api {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t largest_config_bytes = 1 << 22;

JsonDocument read_document(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  std::error_code error;
  if (!stream || fs::is_directory(file, error))
    throw ConfigError(file.string() + " cannot be opened for reading");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  if (stream.bad()) throw ConfigError(file.string() + " cannot be read");
  auto read = read_json(text, largest_config_bytes);
  if (!read) throw ConfigError(file.string() + ": " + to_text(read.problem()));
  return *std::move(read);
}

}  // namespace

ConfigFile::ConfigFile(fs::path file)
    : file_(std::move(file)),
      document_(read_document(file_)),
      fields_(document_.value, "", document_.faults) {}

fs::path ConfigFile::folder() const { return fs::absolute(file_).parent_path(); }

fs::path ConfigFile::resolved(const std::string& path) const {
  return (folder() / path).lexically_normal();
}

void ConfigFile::refuse_faults() const {
  if (document_.faults.empty()) return;
  std::string message = file_.string() + " is not a valid configuration";
  for (const Fault& fault : document_.faults.list())
    message +=
        "\n  " + (fault.pointer.empty() ? "(document)" : fault.pointer) + ": " + fault.detail;
  throw ConfigError(message);
}

}  // namespace translucube::api

#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace translucube {

/// A file that is written at any place and remembers its first error until finish() tells it. Image
/// libraries are told of success whatever happens: OpenEXR writes its last bytes in a destructor,
/// which tells nobody, and libjpeg answers a failed write with exit().
class OutputFile {
 public:
  /// Makes the file anew.
  explicit OutputFile(const std::filesystem::path& file);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  bool is_open() const { return descriptor_ >= 0; }
  void write(const void* bytes, std::size_t count, std::int64_t position);
  /// How many bytes could be read of what was written; 0 after an error.
  std::size_t read(void* bytes, std::size_t count, std::int64_t position) const;
  /// Closes the file. 0 if every byte was handed to the system, else the errno of the first
  /// failure.
  int finish();

 private:
  int descriptor_;
  int error_number_ = 0;
};

}  // namespace translucube

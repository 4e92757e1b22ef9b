#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace translucube {

/// A file to write to that remembers its first error: the libraries lose some (OpenEXR writes its
/// last bytes in a destructor, libjpeg answers a failed write with exit()). finish() tells the
/// truth.
class FileSink {
 public:
  explicit FileSink(const std::filesystem::path& file);
  ~FileSink() { finish(); }
  FileSink(const FileSink&) = delete;
  FileSink& operator=(const FileSink&) = delete;

  bool is_open() const { return descriptor_ >= 0; }
  void write(std::uint64_t position, const void* bytes, std::size_t count);
  /// Reads back what was written; the bytes that it got.
  std::size_t read(std::uint64_t position, void* bytes, std::size_t count) const;
  /// Closes the file. 0 if every byte was handed to the system, else the errno of the first
  /// failure.
  int finish();

 private:
  int descriptor_;
  int error_number_ = 0;
};

}  // namespace translucube

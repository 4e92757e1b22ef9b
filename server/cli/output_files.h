#pragma once

// The files that a verb of the command line writes, and those that it reads.

#include <sys/types.h>

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace translucube::server {

/// All that can be wrong with a place is told before the work begins; a file that cannot be written
/// after all costs no other one. A finished file takes the place of what is there: through links
/// that lead to it, with the mode that it has.
class OutputFiles {
 public:
  /// A file that is read, "-" for none; add all of them before the outputs.
  void reads(const std::filesystem::path& file);

  /// Throws Refusal: for a device, a pipe or a folder, where there is no folder for it or none that
  /// can be written to, and where it is a file that the verb reads or writes already.
  void writes(const std::filesystem::path& file);

  /// Has `writer` fill a temporary file beside `file`, which then takes its place. A failure is
  /// told on standard error, by the file's name.
  void write(const std::filesystem::path& file,
             const std::function<void(const std::filesystem::path&)>& writer);
  void write(const std::filesystem::path& file, std::string_view bytes);

  /// The exit status: 0 where all was written.
  int status() const { return status_; }

 private:
  struct Known {
    std::filesystem::path name;    ///< as it was given
    std::filesystem::path target;  ///< behind all links
    dev_t device = 0;              ///< of the file that is there
    ino_t inode = 0;
    bool exists = false;
  };
  static Known known(const std::filesystem::path& file);
  static bool same(const Known& a, const Known& b);

  std::vector<Known> files_;
  int status_ = 0;
};

/// Prints an answer. Throws Refusal where standard output does not take all of it.
void print(std::string_view text);

}  // namespace translucube::server

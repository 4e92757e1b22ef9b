#include "server/cli/output_files.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <iostream>
#include <optional>
#include <stdexcept>

#include "picture/output_file.h"
#include "server/base/file.h"
#include "server/base/ids.h"
#include "server/cli/command.h"

namespace translucube::server {
namespace {

namespace fs = std::filesystem;

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

/// What a chain of links leads to, whether it is there or not.
fs::path behind_links(fs::path file) {
  constexpr int longest_chain = 40;
  std::error_code error;
  for (int i = 0; i < longest_chain && fs::is_symlink(file, error); ++i) {
    const fs::path to = fs::read_symlink(file, error);
    if (error) break;
    file = to.is_absolute() ? to : folder_of(file) / to;
  }
  const fs::path folder = fs::canonical(folder_of(file), error);
  return error ? file : folder / file.filename();
}

/// Whether a file can be made in the folder; the reason why not.
std::optional<std::string> cannot_write_to(const fs::path& folder) {
  const fs::path probe = folder / (".translucube-" + random_hex(8));
  const int file = ::open(probe.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0600);
  if (file < 0) return std::strerror(errno);
  ::close(file);
  ::unlink(probe.c_str());
  return {};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != text.npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

}  // namespace

OutputFiles::Known OutputFiles::known(const fs::path& file) {
  Known result{file, behind_links(file), 0, 0, false};
  struct stat status {};
  if (::stat(result.target.c_str(), &status) == 0) {
    result.device = status.st_dev;
    result.inode = status.st_ino;
    result.exists = true;
  }
  return result;
}

bool OutputFiles::same(const Known& a, const Known& b) {
  if (a.target == b.target) return true;
  return a.exists && b.exists && a.device == b.device && a.inode == b.inode;
}

void OutputFiles::reads(const fs::path& file) {
  if (file != "-") files_.push_back(known(file));
}

void OutputFiles::writes(const fs::path& file) {
  const fs::path folder = folder_of(file);
  if (!fs::is_directory(folder))
    throw Refusal{exit_failure, folder.string() + ": there is no such folder\n"};
  const Known place = known(file);
  std::error_code error;
  if (place.exists && !fs::is_regular_file(place.target, error))
    throw Refusal{exit_failure, file.string() + ": is not an ordinary file\n"};
  for (const Known& other : files_)
    if (same(other, place))
      throw Refusal{exit_bad_request, file.string() + ": is the same file as " +
                                          other.name.string() +
                                          ", which this command reads or writes as well\n"};
  if (place.exists && ::access(place.target.c_str(), W_OK) != 0)
    throw Refusal{exit_failure, file.string() + ": " + std::strerror(errno) + '\n'};
  if (const auto why = cannot_write_to(folder_of(place.target)))
    throw Refusal{exit_failure, file.string() + ": cannot be written (" + *why + ")\n"};
  files_.push_back(place);
}

void OutputFiles::write(const fs::path& file, const std::function<void(const fs::path&)>& writer) {
  const Known place = known(file);
  std::string temporary_name;
  try {
    write_atomically(place.target, [&](const fs::path& temporary) {
      temporary_name = temporary.string();
      writer(temporary);
      struct stat status {};
      if (place.exists && ::stat(place.target.c_str(), &status) == 0 &&
          ::chmod(temporary.c_str(), status.st_mode & 0777) != 0)
        throw FileError(file.string() + ": " + std::strerror(errno));
    });
  } catch (const std::runtime_error& failure) {
    std::string why = failure.what();
    if (!temporary_name.empty()) why = replaced(why, temporary_name, file.string());
    std::cerr << why << '\n';
    status_ = exit_failure;
  }
}

void OutputFiles::write(const fs::path& file, std::string_view bytes) {
  write(file, [&](const fs::path& temporary) {
    OutputFile out(temporary);
    if (out.is_open()) out.write(bytes.data(), bytes.size(), 0);
    if (const int error = out.finish())
      throw FileError(file.string() + ": " + std::strerror(error));
  });
}

void print(std::string_view text) {
  std::cout << text << std::flush;
  if (!std::cout) throw Refusal{exit_failure, "standard output cannot be written\n"};
}

}  // namespace translucube::server

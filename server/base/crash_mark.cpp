#include "server/base/crash_mark.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <climits>
#include <cstring>

namespace translucube::server {
namespace {

constexpr std::array faults{SIGSEGV, SIGBUS, SIGILL, SIGFPE, SIGABRT};
std::array<char, PATH_MAX> marked{};
pid_t marking = 0;  // a child that inherits the handler is not the service
std::array<struct sigaction, faults.size()> handlers_before{};

/// Calls nothing that is not async-signal-safe (signal-safety(7)).
void leave_mark(int signal) {
  const int file =
      ::getpid() == marking ? ::open(marked.data(), O_WRONLY | O_CREAT | O_CLOEXEC, 0600) : -1;
  if (file >= 0) ::close(file);
  for (std::size_t i = 0; i < faults.size(); ++i)
    if (faults[i] == signal) ::sigaction(signal, &handlers_before[i], nullptr);
  // What was at fault runs again, into the handler before; a signal that was sent does not.
  ::raise(signal);
}

}  // namespace

void mark_crashes(const std::filesystem::path& file) {
  const std::string path = file.string();
  if (path.size() >= marked.size()) return;
  std::ranges::copy(path, marked.begin());
  marked[path.size()] = '\0';
  marking = ::getpid();
  struct sigaction action {};
  action.sa_handler = leave_mark;
  sigemptyset(&action.sa_mask);
  for (std::size_t i = 0; i < faults.size(); ++i)
    ::sigaction(faults[i], &action, &handlers_before[i]);
}

bool take_crash_mark(const std::filesystem::path& file) {
  std::error_code error;
  return std::filesystem::remove(file, error);
}

}  // namespace translucube::server

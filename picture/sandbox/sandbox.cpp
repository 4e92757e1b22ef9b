#include "picture/sandbox/sandbox.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <optional>
#include <utility>

#include "picture/companion.h"
#include "picture/sandbox/answer.h"
#include "picture/sandbox/confine.h"

namespace translucube {
namespace {

namespace fs = std::filesystem;

/// A descriptor that is closed at the end of its scope.
class Descriptor {
 public:
  explicit Descriptor(int number) : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number() const { return number_; }
  int release() { return std::exchange(number_, -1); }
  bool open() const { return number_ >= 0; }

 private:
  int number_;
};

std::string reason_of(int error) { return std::strerror(error); }

/// What tells nothing of the file but of the moment.
bool passes(int error) {
  return error == EMFILE || error == ENFILE || error == ENOMEM || error == EIO || error == ESTALE ||
         error == ENOENT || error == EINTR || error == EAGAIN || error == ENOTCONN ||
         error == EHOSTDOWN || error == ETIMEDOUT || error == ENODEV || error == ENXIO;
}

/// Opens a regular file, and waits for nobody who might write to a pipe of that name.
int open_file(const fs::path& file, const SandboxLimits& limits) {
  const int number = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
  if (number < 0) {
    const int error = errno;
    if (passes(error)) throw FileUnavailable(reason_of(error));
    throw FileRefused(reason_of(error));
  }
  struct stat status {};
  const bool known = ::fstat(number, &status) == 0;
  const bool regular = known && S_ISREG(status.st_mode);
  if (!regular || static_cast<std::uint64_t>(status.st_size) > limits.file_bytes) {
    ::close(number);
    if (!known) throw FileUnavailable("its size cannot be told");
    if (!regular) throw FileRefused("not a regular file");
    throw FileRefused("larger than " + std::to_string(limits.file_bytes >> 20) + " MiB");
  }
  return number;
}

/// Ends and forgets a process whatever happens.
class Child {
 public:
  Child(const std::string& kind, int file, int answer) {
    std::string name = companion("translucube_reader").string(), argument = kind;
    std::array<char*, 3> arguments{name.data(), argument.data(), nullptr};
    std::array<char*, 1> environment{nullptr};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    for (const int standard : {0, 1, 2})
      posix_spawn_file_actions_addopen(&actions, standard, "/dev/null", O_RDWR, 0);
    posix_spawn_file_actions_adddup2(&actions, file, sandbox_file);
    posix_spawn_file_actions_adddup2(&actions, answer, sandbox_answer);
    posix_spawn_file_actions_addclosefrom_np(&actions, sandbox_answer + 1);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    sigset_t none, all;
    sigemptyset(&none);
    sigfillset(&all);
    posix_spawnattr_setsigmask(&attributes, &none);
    posix_spawnattr_setsigdefault(&attributes, &all);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
    const int error = ::posix_spawn(&id_, name.c_str(), &actions, &attributes, arguments.data(),
                                    environment.data());
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    if (error != 0) throw FileUnavailable("no reader can be started: " + reason_of(error));
  }
  ~Child() {
    if (ended_) return;
    ::kill(id_, SIGKILL);
    wait_for_end();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Its status as waitpid() tells it.
  int wait_for_end() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    ended_ = true;
    return status;
  }

 private:
  pid_t id_ = 0;
  bool ended_ = false;
};

/// Above what the child's own descriptors are called.
Descriptor moved_up(int number) {
  const Descriptor old(number);
  return Descriptor(::fcntl(number, F_DUPFD_CLOEXEC, 16));
}

std::string too_long(unsigned seconds) {
  return "takes longer than " + std::to_string(seconds) + " s to read";
}

/// What comes through a pipe until its other end is closed. A file would be simpler, but is bounded
/// by the parent's own limit on files. Throws FileRefused.
std::vector<std::byte> read_pipe(int pipe, const SandboxLimits& limits) {
  using Clock = std::chrono::steady_clock;
  constexpr std::size_t piece = 1 << 20;
  const auto deadline = Clock::now() + std::chrono::seconds(limits.wall_seconds);
  std::vector<std::byte> bytes;
  while (true) {
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
    if (left.count() <= 0) throw FileRefused(too_long(limits.wall_seconds));
    pollfd poller{pipe, POLLIN, 0};
    if (::poll(&poller, 1, static_cast<int>(left.count())) <= 0) continue;
    const std::size_t before = bytes.size();
    if (before > limits.answer_bytes) throw FileRefused("larger than what can be kept of it");
    bytes.resize(before + piece);
    const ssize_t got = ::read(pipe, bytes.data() + before, piece);
    bytes.resize(before + static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
    if (got == 0) return bytes;
    if (got < 0 && errno != EINTR) throw FileUnavailable(reason_of(errno));
  }
}

}  // namespace

SandboxAnswer read_in_sandbox(const std::string& kind, const fs::path& file,
                              const SandboxLimits& limits) {
  const Descriptor input = moved_up(open_file(file, limits));
  std::array<int, 2> ends{-1, -1};
  if (!input.open() || ::pipe2(ends.data(), O_CLOEXEC) != 0)
    throw FileUnavailable(reason_of(errno));
  const Descriptor answer = moved_up(ends[0]);
  std::optional<Descriptor> to_answer(std::in_place, moved_up(ends[1]).release());
  if (!answer.open() || !to_answer->open()) throw FileUnavailable(reason_of(errno));
  Child child(kind, input.number(), to_answer->number());
  to_answer.reset();
  SandboxAnswer result(read_pipe(answer.number(), limits));
  const int status = child.wait_for_end();
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    throw FileRefused(too_long(limits.cpu_seconds));
  if (WIFSIGNALED(status))
    throw FileRefused("damaged: its reader ended on signal " + std::to_string(WTERMSIG(status)));
  if (WEXITSTATUS(status) == sandbox_not_confined)
    throw FileUnavailable("this system does not let the reader give up its rights");
  if (WEXITSTATUS(status) == sandbox_no_answer)
    throw FileUnavailable("the reader could not read the file's bytes or write its answer");
  if (WEXITSTATUS(status) != 0 || result.bytes().size() < sizeof(AnswerHead))
    throw FileRefused("damaged: its reader gave no answer");
  open_answer(result.bytes());
  return result;
}

}  // namespace translucube

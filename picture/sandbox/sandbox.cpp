#include "picture/sandbox/sandbox.h"

#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <utility>

extern "C" {  // which glibc 2.36's header forgets
#include <sys/pidfd.h>
}

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

/// The reader lies beside the program where it was built, and in ../lib/translucube where it is
/// installed.
fs::path reader_program() {
  std::error_code error;
  const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
  constexpr const char* name = "translucube_reader";
  const fs::path installed = folder / "../lib/translucube" / name;
  return fs::exists(installed, error) ? installed : folder / name;
}

/// Ends and forgets a process whatever happens.
class Child {
 public:
  Child(const std::string& kind, int file, int answer) {
    const fs::path program = reader_program();
    std::string name = program.string(), argument = kind;
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

  /// Its status as waitpid() tells it; false where it took too long.
  bool end_within(std::chrono::seconds longest, int& status) {
    const Descriptor end(::pidfd_open(id_, 0));
    if (!end.open()) throw FileUnavailable("no reader can be waited for: " + reason_of(errno));
    const auto deadline = std::chrono::steady_clock::now() + longest;
    while (true) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
          deadline - std::chrono::steady_clock::now());
      if (left.count() <= 0) return false;
      pollfd poller{end.number(), POLLIN, 0};
      if (::poll(&poller, 1, static_cast<int>(left.count())) > 0) break;
    }
    status = wait_for_end();
    return true;
  }

 private:
  int wait_for_end() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    ended_ = true;
    return status;
  }

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

}  // namespace

SandboxAnswer::~SandboxAnswer() {
  if (bytes_ != nullptr) ::munmap(const_cast<std::byte*>(bytes_), size_);
}

SandboxAnswer::SandboxAnswer(SandboxAnswer&& other) noexcept
    : bytes_(std::exchange(other.bytes_, nullptr)), size_(other.size_) {}

SandboxAnswer read_in_sandbox(const std::string& kind, const fs::path& file,
                              const SandboxLimits& limits) {
  const Descriptor input = moved_up(open_file(file, limits));
  const Descriptor answer = moved_up(::memfd_create("translucube answer", MFD_CLOEXEC));
  if (!input.open() || !answer.open()) throw FileUnavailable(reason_of(errno));
  int status = 0;
  {
    Child child(kind, input.number(), answer.number());
    if (!child.end_within(std::chrono::seconds(limits.wall_seconds), status))
      throw FileRefused(too_long(limits.wall_seconds));
  }
  if (WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU)
    throw FileRefused(too_long(limits.cpu_seconds));
  if (WIFSIGNALED(status))
    throw FileRefused("damaged: its reader ended on signal " + std::to_string(WTERMSIG(status)));
  if (WEXITSTATUS(status) == sandbox_not_confined)
    throw FileUnavailable("this system does not let the reader give up its rights");
  if (WEXITSTATUS(status) == sandbox_no_answer)
    throw FileUnavailable("the reader could not read the file's bytes or write its answer");
  struct stat size {};
  if (::fstat(answer.number(), &size) != 0) throw FileUnavailable(reason_of(errno));
  const auto bytes = static_cast<std::size_t>(size.st_size);
  if (WEXITSTATUS(status) != 0 || bytes < sizeof(AnswerHead))
    throw FileRefused("damaged: its reader gave no answer");
  void* const mapped = ::mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, answer.number(), 0);
  if (mapped == MAP_FAILED) throw FileUnavailable(reason_of(errno));
  SandboxAnswer result(static_cast<const std::byte*>(mapped), bytes);
  open_answer(result.bytes());
  return result;
}

}  // namespace translucube

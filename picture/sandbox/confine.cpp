#include "picture/sandbox/confine.h"

#include <fcntl.h>
#include <seccomp.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <new>

#include "picture/sandbox/answer.h"
#include "picture/sandbox/sandbox.h"

namespace translucube {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool sanitized = true;  // its shadow memory and its reports need more than we leave
#else
constexpr bool sanitized = false;
#endif

/// Lowers a limit, or leaves it where it is lower.
bool limit(__rlimit_resource what, rlim_t soft, rlim_t hard) {
  rlimit now{};
  if (::getrlimit(what, &now) != 0) return false;
  hard = std::min(hard, now.rlim_max);
  const rlimit next{std::min(soft, hard), hard};
  return ::setrlimit(what, &next) == 0;
}
bool limit(__rlimit_resource what, rlim_t most) { return limit(what, most, most); }

bool limit_resources(const SandboxLimits& limits) {
  // SIGXCPU at the soft limit tells the parent why.
  return limit(RLIMIT_CPU, limits.cpu_seconds, limits.cpu_seconds + 1) && limit(RLIMIT_CORE, 0) &&
         limit(RLIMIT_FSIZE, 0) && (sanitized || limit(RLIMIT_AS, limits.memory_bytes));
}

/// Where memory runs out on the machine, this process is the one to end.
void be_the_first_to_end() {
  const int file = ::open("/proc/self/oom_score_adj", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  [[maybe_unused]] const auto written = ::write(file, "1000", 4);
  ::close(file);
}

/// Leaves the calls that memory, locks and clocks need, and writing the answer; all others fail.
bool forbid_calls() {
  if (sanitized) return true;
  scmp_filter_ctx filter = ::seccomp_init(SCMP_ACT_ERRNO(EPERM));
  if (filter == nullptr) return false;
  bool done = true;
  for (const int call :
       {SCMP_SYS(brk), SCMP_SYS(munmap), SCMP_SYS(mremap), SCMP_SYS(madvise), SCMP_SYS(futex),
        SCMP_SYS(clock_gettime), SCMP_SYS(gettimeofday), SCMP_SYS(getrandom), SCMP_SYS(sched_yield),
        SCMP_SYS(rt_sigprocmask), SCMP_SYS(rt_sigreturn), SCMP_SYS(getpid), SCMP_SYS(gettid),
        SCMP_SYS(exit), SCMP_SYS(exit_group)})
    done = done && ::seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 0) == 0;
  constexpr scmp_datum_t executable = 4;  // PROT_EXEC
  for (const int call : {SCMP_SYS(mmap), SCMP_SYS(mprotect)})
    done = done && ::seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 1,
                                      SCMP_A2(SCMP_CMP_MASKED_EQ, executable, 0)) == 0;
  for (const int call : {SCMP_SYS(write), SCMP_SYS(pwrite64)})
    done = done && ::seccomp_rule_add(filter, SCMP_ACT_ALLOW, call, 1,
                                      SCMP_A0(SCMP_CMP_EQ, sandbox_answer)) == 0;
  // To itself alone: how abort() ends.
  done = done && ::seccomp_rule_add(filter, SCMP_ACT_ALLOW, SCMP_SYS(tgkill), 1,
                                    SCMP_A0(SCMP_CMP_EQ, scmp_datum_t(::getpid()))) == 0;
  done = done && ::seccomp_load(filter) == 0;  // sets no_new_privs as well
  ::seccomp_release(filter);
  return done;
}

bool read_file(std::vector<char>& bytes) {
  struct stat status {};
  if (::fstat(sandbox_file, &status) != 0) return false;
  bytes.resize(static_cast<std::size_t>(status.st_size));
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t got = ::read(sandbox_file, bytes.data() + done, bytes.size() - done);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return false;
    if (got == 0) break;
    done += static_cast<std::size_t>(got);
  }
  bytes.resize(done);
  ::close(sandbox_file);
  return true;
}

bool write_all(std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const ssize_t done = ::write(sandbox_answer, bytes.data(), bytes.size());
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) return false;
    bytes = bytes.subspan(static_cast<std::size_t>(done));
  }
  return true;
}

bool write_answer(AnswerHead::Kind kind, const AnswerPieces& pieces) {
  AnswerHead head;
  head.kind = kind;
  for (const auto& piece : pieces) head.bytes += piece.size();
  if (!write_all(std::as_bytes(std::span(&head, 1)))) return false;
  return std::ranges::all_of(pieces, write_all);
}

}  // namespace

int run_confined(
    const std::function<void(std::span<const char>)>& prepare,
    const std::function<void(std::span<const char>,
                             const std::function<void(const AnswerPieces&)>& answer)>& parse) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  ::prctl(PR_SET_DUMPABLE, 0);
  be_the_first_to_end();
  if (!limit_resources(sandbox_limits)) return sandbox_not_confined;
  bool written = true;
  std::string reason;
  try {
    std::vector<char> bytes;
    if (!read_file(bytes)) return sandbox_no_answer;
    prepare(bytes);
    if (!forbid_calls()) return sandbox_not_confined;
    parse(bytes, [&](const AnswerPieces& pieces) {
      written = write_answer(AnswerHead::Kind::read, pieces);
    });
    return written ? 0 : sandbox_no_answer;
  } catch (const std::bad_alloc&) {
    reason = "takes more than " + std::to_string(sandbox_limits.memory_bytes >> 20) +
             " MiB of memory to read";
  } catch (const std::exception& error) {
    reason = error.what();
  }
  reason.resize(std::min(reason.size(), longest_reason));
  return write_answer(AnswerHead::Kind::refused, {std::as_bytes(std::span(reason))})
             ? 0
             : sandbox_no_answer;
}

}  // namespace translucube

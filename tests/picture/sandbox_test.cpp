// What a process in the sandbox can do, and what becomes of one that does too much.

#include "picture/sandbox/sandbox.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <new>
#include <string>
#include <vector>

#include "picture/sandbox/answer.h"
#include "picture/sandbox/confine.h"
#include "tests/support/sanitized.h"

namespace translucube::test {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

struct Ended {
  int status;
  std::string answer;  ///< or the reason of a refusal
};

/// Runs `parse` as the reader would be run.
Ended confined(const std::function<std::string()>& parse) {
  const int file = ::memfd_create("file", 0);
  int answer[2];
  EXPECT_EQ(::pipe(answer), 0);  // which holds what tests answer
  const pid_t child = ::fork();
  if (child == 0) {
    ::dup2(::fcntl(file, F_DUPFD, 20), sandbox_file);
    ::dup2(::fcntl(answer[1], F_DUPFD, 20), sandbox_answer);
    ::_exit(run_confined([](auto) {},
                         [&](auto, const std::function<void(const AnswerPieces&)>& write) {
                           const std::string text = parse();
                           write({std::as_bytes(std::span(text))});
                         }));
  }
  Ended ended{};
  ::waitpid(child, &ended.status, 0);
  ::close(answer[1]);
  std::vector<std::byte> bytes(1 << 16);
  bytes.resize(static_cast<std::size_t>(::read(answer[0], bytes.data(), bytes.size())));
  ::close(file);
  ::close(answer[0]);
  if (bytes.empty()) return ended;
  try {
    const auto text = open_answer(bytes);
    ended.answer.assign(reinterpret_cast<const char*>(text.data()), text.size());
  } catch (const FileRefused& error) {
    ended.answer = std::string("refused: ") + error.what();
  }
  return ended;
}

std::string able(bool done) { return done ? "able" : std::strerror(errno); }

TEST(Sandbox, AnswersAndRefuses) {
  EXPECT_EQ(confined([] { return std::string("read"); }).answer, "read");
  EXPECT_EQ(confined([]() -> std::string { throw std::runtime_error("why\n\x01"); }).answer,
            "refused: why??");
  EXPECT_THAT(confined([]() -> std::string { throw std::bad_alloc(); }).answer,
              HasSubstr("of memory"));
}

TEST(Sandbox, LeavesNoRights) {
  if (sanitized) GTEST_SKIP() << "sanitizers need rights";
  const std::string no = std::strerror(EPERM);
  EXPECT_EQ(confined([] { return able(::open("/etc/passwd", O_RDONLY) >= 0); }).answer, no);
  EXPECT_EQ(confined([] { return able(::open("/tmp/x", O_RDWR | O_CREAT, 0600) >= 0); }).answer,
            no);
  EXPECT_EQ(confined([] { return able(::socket(AF_INET, SOCK_STREAM, 0) >= 0); }).answer, no);
  EXPECT_EQ(confined([] { return able(::socket(AF_UNIX, SOCK_STREAM, 0) >= 0); }).answer, no);
  EXPECT_EQ(confined([] { return able(::fork() >= 0); }).answer, no);
  EXPECT_EQ(confined([] { return able(::kill(::getppid(), 0) == 0); }).answer, no);
  EXPECT_EQ(confined([] { return able(::execl("/bin/true", "true", nullptr) == 0); }).answer, no);
  EXPECT_EQ(confined([] { return able(::unlink("/tmp/x") == 0); }).answer, no);
  EXPECT_EQ(confined([] { return able(::write(2, "x", 1) == 1); }).answer, no);
  EXPECT_EQ(confined([] {
              return able(::mmap(nullptr, 4096, PROT_READ | PROT_WRITE | PROT_EXEC,
                                 MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) != MAP_FAILED);
            }).answer,
            no);
}

TEST(Sandbox, BoundsMemory) {
  if (sanitized) GTEST_SKIP() << "sanitizers need memory";
  EXPECT_THAT(confined([] {
                std::vector<std::unique_ptr<char[]>> all;  // never touched
                while (true) all.emplace_back(new char[std::size_t{1} << 28]);
                return std::string();
              }).answer,
              HasSubstr("of memory"));
}

TEST(Sandbox, EndsWithWhoeverCrashes) {
  const Ended aborted = confined([]() -> std::string { std::abort(); });
  EXPECT_TRUE(WIFSIGNALED(aborted.status));
  EXPECT_EQ(aborted.answer, "");
}

/// Files to have read by the real program.
class SandboxFile : public testing::Test {
 protected:
  SandboxFile() { fs::create_directories(folder_); }
  ~SandboxFile() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  const fs::path folder_ =
      fs::temp_directory_path() / ("translucube_sandbox_" + std::to_string(::getpid()));
};

TEST_F(SandboxFile, ThatIsNoFileIsNeverWaitedFor) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THROW(read_in_sandbox("mesh", folder_ / "pipe"), FileRefused);
  EXPECT_THROW(read_in_sandbox("mesh", folder_), FileRefused);
  EXPECT_THROW(read_in_sandbox("mesh", "/dev/zero"), FileRefused);
  EXPECT_THROW(read_in_sandbox("mesh", folder_ / "absent"), FileUnavailable);
}

TEST_F(SandboxFile, IsReadWithinTheLimits) {
  const fs::path mesh = write("tetrahedron.obj",
                              "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
                              "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  EXPECT_GT(open_answer(read_in_sandbox("mesh", mesh).bytes()).size(), 4 * 24u);
  SandboxLimits limits;
  limits.file_bytes = 10;
  EXPECT_THROW(read_in_sandbox("mesh", mesh, limits), FileRefused);
  limits = {};
  limits.wall_seconds = 0;
  EXPECT_THROW(read_in_sandbox("mesh", mesh, limits), FileRefused);
  EXPECT_THROW(read_in_sandbox("no such kind", mesh), FileUnavailable);
}

TEST_F(SandboxFile, OfAnyBytesEndsInAnAnswerOrARefusal) {
  unsigned seed = 1;
  for (const char* kind : {"mesh", "light"})
    for (const char* start : {"", "ply\nformat ascii 1.0\nelement vertex 9\n", "v 1 2 3\nf ",
                              "\x76\x2f\x31\x01\x02", "#?RADIANCE\n", "\x89PNG\r\n\x1a\n",
                              "\xff\xd8\xff\xe0", "II*", "solid a\nfacet normal 0 0 1\n"}) {
      std::string bytes(start);
      for (int i = 0; i < 300; ++i)
        bytes += static_cast<char>((seed = seed * 1103515245 + 12345) >> 16);
      EXPECT_THROW(read_in_sandbox(kind, write("bytes", bytes)), FileRefused) << kind << start;
    }
}

TEST(Answer, IsBelievedInNothing) {
  AnswerHead head;
  head.bytes = 3;
  std::vector<std::byte> good(sizeof head + 3);
  std::memcpy(good.data(), &head, sizeof head);
  EXPECT_EQ(open_answer(good).size(), 3u);
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_THROW(open_answer(std::span(good).first(size)), AnswerError);
  for (std::size_t i = 0; i < sizeof head; ++i) {
    auto bad = good;
    bad[i] ^= std::byte{0x40};
    const bool reserved = i >= 12 && i < 16;
    if (!reserved) {
      EXPECT_THROW(open_answer(bad), AnswerError) << i;
    }
  }
}

}  // namespace
}  // namespace translucube::test

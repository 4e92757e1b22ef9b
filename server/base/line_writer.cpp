#include "server/base/line_writer.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <climits>
#include <utility>

namespace translucube::server {
namespace {

constexpr int look_again_ms = 100;
constexpr std::chrono::seconds longest_flush(1);

}  // namespace

LineWriter::LineWriter(int fd, std::size_t most_bytes)
    : fd_(fd), most_bytes_(most_bytes), thread_([this](std::stop_token ended) { run(ended); }) {}

LineWriter::~LineWriter() {
  flush();
  thread_.request_stop();
}

void LineWriter::add(std::string_view line) {
  {
    const std::lock_guard lock(mutex_);
    if (waiting_.size() + line.size() > most_bytes_) {
      ++dropped_;
      ++untold_;
      return;
    }
    if (untold_ > 0 && drops_line_ != nullptr) waiting_ += drops_line_(std::exchange(untold_, 0));
    waiting_ += line;
  }
  more_.notify_one();
}

void LineWriter::flush() {
  std::unique_lock lock(mutex_);
  written_.wait_for(lock, longest_flush, [this] { return waiting_.empty() && !writing_; });
}

std::uint64_t LineWriter::dropped() const {
  const std::lock_guard lock(mutex_);
  return dropped_;
}

void LineWriter::tell_drops(std::string (*line)(std::uint64_t dropped)) {
  const std::lock_guard lock(mutex_);
  drops_line_ = line;
}

void LineWriter::run(std::stop_token ended) {
  std::unique_lock lock(mutex_);
  while (more_.wait(lock, ended, [this] { return !waiting_.empty(); })) {
    const std::string text = std::exchange(waiting_, {});
    writing_ = true;
    lock.unlock();
    const bool whole = write_all(text, ended);
    lock.lock();
    writing_ = false;
    written_.notify_all();
    if (!whole) return;
  }
}

/// False where nobody reads until the end.
bool LineWriter::write_all(std::string_view text, const std::stop_token& ended) const {
  while (!text.empty()) {
    pollfd ready{fd_, POLLOUT, 0};
    if (::poll(&ready, 1, look_again_ms) <= 0) {
      if (ended.stop_requested()) return false;
      continue;
    }
    // So many bytes fit a pipe that can be written to (POSIX: poll, PIPE_BUF): this does not wait.
    const ssize_t written = ::write(fd_, text.data(), std::min<std::size_t>(text.size(), PIPE_BUF));
    if (written > 0)
      text.remove_prefix(static_cast<std::size_t>(written));
    else if (written < 0 && errno != EINTR && errno != EAGAIN)
      return true;  // closed, or a full disk: these lines are lost
  }
  return true;
}

}  // namespace translucube::server

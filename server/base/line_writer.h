#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <string>
#include <string_view>
#include <thread>

namespace translucube::server {

/// Writes lines to a file descriptor on a thread of its own, so that nobody waits where nobody
/// reads them: past `most_bytes` lines are dropped and counted, which is told once there is room.
/// Safe to share by threads.
class LineWriter {
 public:
  explicit LineWriter(int fd, std::size_t most_bytes = 4 << 20);
  ~LineWriter();  ///< flushes

  void add(std::string_view line);  ///< with its line break
  /// Waits until all is written, for a second at most.
  void flush();
  std::uint64_t dropped() const;  ///< lines, since the start

  /// `line` makes the line that tells how many were dropped.
  void tell_drops(std::string (*line)(std::uint64_t dropped));

 private:
  void run(std::stop_token ended);
  bool write_all(std::string_view text, const std::stop_token& ended) const;

  const int fd_;
  const std::size_t most_bytes_;
  mutable std::mutex mutex_;
  std::condition_variable_any more_, written_;
  std::string waiting_;  ///< lines to write
  bool writing_ = false;
  std::uint64_t dropped_ = 0, untold_ = 0;
  std::string (*drops_line_)(std::uint64_t) = nullptr;
  std::jthread thread_;
};

}  // namespace translucube::server

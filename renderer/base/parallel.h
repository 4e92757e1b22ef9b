#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace translucube {

/// Threads where `asked` are asked for: 0 asks for one on each core.
inline int thread_count(int asked) {
  return asked > 0 ? asked : std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

/// The numbers below `count`, each handed out once, to whichever thread comes first.
class Turns {
 public:
  explicit Turns(int count) : count_(count) {}

  std::optional<int> take() {
    const int turn = next_++;
    return turn < count_ ? std::optional(turn) : std::nullopt;
  }
  void end() { next_ = count_; }  ///< nobody gets another

 private:
  std::atomic<int> next_ = 0;
  int count_;
};

/// Calls worker(turns) on `threads` threads (0: all cores), this one among them, for workers that
/// keep something from one turn to the next. Where the machine has no more threads, fewer do it.
/// What a worker throws ends the turns and is thrown here.
template <class Worker>
void share_turns(int threads, int count, Worker&& worker) {
  Turns turns(count);
  std::mutex mutex;
  std::exception_ptr thrown;
  const auto work = [&]() noexcept {
    try {
      worker(turns);
    } catch (...) {
      turns.end();
      const std::lock_guard lock(mutex);
      if (!thrown) thrown = std::current_exception();
    }
  };
  {
    std::vector<std::jthread> helpers;
    try {
      for (int t = 1; t < std::min(thread_count(threads), count); ++t) helpers.emplace_back(work);
    } catch (const std::exception&) {  // std::system_error, std::bad_alloc
    }
    work();
  }
  if (thrown) std::rethrow_exception(thrown);
}

/// Calls work(i) for every i < count, on `threads` threads (0: all cores).
template <class Work>
void parallel_for(int threads, int count, Work&& work) {
  share_turns(threads, count, [&](Turns& turns) {
    while (const std::optional<int> i = turns.take()) work(*i);
  });
}

}  // namespace translucube

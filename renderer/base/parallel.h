#pragma once

#include <algorithm>
#include <atomic>
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

 private:
  std::atomic<int> next_ = 0;
  int count_;
};

/// Calls worker(turns) on `threads` threads (0: all cores), this one among them, for workers that
/// keep something from one turn to the next.
template <class Worker>
void share_turns(int threads, int count, Worker&& worker) {
  Turns turns(count);
  const auto work = [&] { worker(turns); };
  std::vector<std::jthread> helpers;
  for (int t = 1; t < std::min(thread_count(threads), count); ++t) helpers.emplace_back(work);
  work();
}

/// Calls work(i) for every i < count, on `threads` threads (0: all cores).
template <class Work>
void parallel_for(int threads, int count, Work&& work) {
  share_turns(threads, count, [&](Turns& turns) {
    while (const std::optional<int> i = turns.take()) work(*i);
  });
}

}  // namespace translucube

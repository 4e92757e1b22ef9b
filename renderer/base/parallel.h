#pragma once

#include <algorithm>
#include <atomic>
#include <thread>
#include <vector>

namespace translucube {

/// Calls work(i) for every i < count, on `threads` threads (0: all cores).
template <class Work>
void in_parallel(int threads, int count, Work&& work) {
  if (threads == 0) threads = static_cast<int>(std::thread::hardware_concurrency());
  std::atomic<int> next = 0;
  const auto run = [&] {
    for (int i = next++; i < count; i = next++) work(i);
  };
  std::vector<std::jthread> helpers;
  for (int t = 1; t < std::min(threads, count); ++t) helpers.emplace_back(run);
  run();
}

}  // namespace translucube

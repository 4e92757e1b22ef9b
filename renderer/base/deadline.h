#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <stop_token>
#include <thread>

namespace translucube {

/// Asks a stop_source to stop after a time, unless destroyed before.
class Deadline {
 public:
  Deadline(std::stop_source source, double seconds)
      : thread_([this, source = std::move(source), seconds](std::stop_token ended) mutable {
          std::unique_lock lock(mutex_);
          const auto end =
              std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
          if (!wake_.wait_until(lock, ended, end, [&] { return ended.stop_requested(); }))
            source.request_stop();
        }) {}

 private:
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::jthread thread_;
};

}  // namespace translucube

#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "server/connection.h"

namespace translucube::server {

/// Threads that serve connections, each as long as `serve` takes. They are made as they are needed,
/// `most` at most, and stay.
class ThreadPool {
 public:
  ThreadPool(int most, std::function<void(std::unique_ptr<Connection>)> serve);
  ~ThreadPool();

  void add(std::unique_ptr<Connection> connection);
  /// Serves what was added before, then ends the threads; what is added later is dropped.
  void close();

 private:
  void run();

  const std::size_t most_;
  const std::function<void(std::unique_ptr<Connection>)> serve_;
  std::mutex mutex_;
  std::condition_variable added_;
  std::deque<std::unique_ptr<Connection>> queue_;
  std::size_t idle_ = 0;
  bool closed_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace translucube::server

#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "server/http/connection.h"

namespace translucube::server {

/// Threads that wait for connections and serve them, each as long as `serve` takes. They are made
/// as they are needed, so that one waits while others serve, `most` at most, and stay.
/// `serve` is told whether its thread is the last: then nobody waits until it is done.
class ThreadPool {
 public:
  using Next = std::function<std::unique_ptr<Connection>()>;  ///< null: there will be no more
  using Serve = std::function<void(std::unique_ptr<Connection>, bool last)>;

  ThreadPool(int most, Next next, Serve serve);
  ~ThreadPool();

  /// Waits for all threads to see that there will be no more.
  void close();

 private:
  void add_thread();
  void run();
  bool leave();
  void come_back();

  /// While a thread serves.
  struct Absence {
    explicit Absence(ThreadPool& its_pool) : pool(its_pool), last(its_pool.leave()) {}
    ~Absence() { pool.come_back(); }
    Absence(const Absence&) = delete;
    Absence& operator=(const Absence&) = delete;
    ThreadPool& pool;
    const bool last;
  };

  const std::size_t most_;
  const Next next_;
  const Serve serve_;
  std::mutex mutex_;
  std::size_t waiting_ = 0;
  bool closed_ = false;
  std::vector<std::jthread> threads_;
};

}  // namespace translucube::server

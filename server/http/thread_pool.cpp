#include "server/http/thread_pool.h"

#include <system_error>
#include <utility>

namespace translucube::server {

ThreadPool::ThreadPool(int most, Next next, Serve serve)
    : most_(static_cast<std::size_t>(most)), next_(std::move(next)), serve_(std::move(serve)) {
  const std::lock_guard lock(mutex_);
  add_thread();
}

ThreadPool::~ThreadPool() { close(); }

void ThreadPool::add_thread() {
  threads_.emplace_back([this] { run(); });
  ++waiting_;
}

void ThreadPool::close() {
  std::vector<std::jthread> threads;
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    threads.swap(threads_);
  }
}

void ThreadPool::run() {
  while (std::unique_ptr<Connection> connection = next_()) {
    {
      const std::lock_guard lock(mutex_);
      if (--waiting_ == 0 && threads_.size() < most_ && !closed_) try {
          add_thread();
        } catch (const std::system_error&) {
          // The machine has no more threads: those that are there go on.
        }
    }
    serve_(std::move(connection));
    const std::lock_guard lock(mutex_);
    ++waiting_;
  }
}

}  // namespace translucube::server

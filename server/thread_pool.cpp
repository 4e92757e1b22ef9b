#include "server/thread_pool.h"

#include <system_error>

namespace translucube::server {

ThreadPool::ThreadPool(int most, std::function<void(std::unique_ptr<Connection>)> serve)
    : most_(static_cast<std::size_t>(most)), serve_(std::move(serve)) {}

ThreadPool::~ThreadPool() { close(); }

void ThreadPool::add(std::unique_ptr<Connection> connection) {
  {
    const std::lock_guard lock(mutex_);
    if (closed_) return;
    queue_.push_back(std::move(connection));
    if (queue_.size() > idle_ && threads_.size() < most_) try {
        threads_.emplace_back([this] { run(); });
      } catch (const std::system_error&) {
        // The machine has no more threads: those that are there take it, unless there is none.
        if (threads_.empty()) throw;
      }
  }
  added_.notify_one();
}

void ThreadPool::close() {
  {
    const std::lock_guard lock(mutex_);
    closed_ = true;
  }
  added_.notify_all();
  threads_.clear();
}

void ThreadPool::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    ++idle_;
    added_.wait(lock, [this] { return closed_ || !queue_.empty(); });
    --idle_;
    if (queue_.empty()) return;
    auto connection = std::move(queue_.front());
    queue_.pop_front();
    lock.unlock();
    serve_(std::move(connection));
    lock.lock();
  }
}

}  // namespace translucube::server

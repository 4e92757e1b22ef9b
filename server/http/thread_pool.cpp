#include "server/http/thread_pool.h"

#include <spdlog/spdlog.h>

#include <exception>
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

/// A thread no longer waits. True if none waits now, and none can be added.
bool ThreadPool::leave() {
  const std::lock_guard lock(mutex_);
  if (--waiting_ > 0) return false;
  if (threads_.size() >= most_ || closed_) return true;
  try {
    add_thread();
  } catch (const std::exception&) {
    return true;  // the machine has no more threads or memory: those that are there go on
  }
  return false;
}

void ThreadPool::come_back() {
  const std::lock_guard lock(mutex_);
  ++waiting_;
}

void ThreadPool::run() {
  for (bool more = true; more;) try {
      std::unique_ptr<Connection> connection = next_();
      more = connection != nullptr;
      if (!more) continue;
      const Absence absence(*this);
      serve_(std::move(connection), absence.last);
    } catch (const std::exception& error) {
      spdlog::error("a connection failed: {}", error.what());
    }
}

}  // namespace translucube::server

#pragma once

#include <functional>
#include <thread>

namespace translucube::server {

/// Takes SIGINT, SIGTERM and SIGHUP (unless that is ignored) as ordinary calls: `on_signal` runs on
/// a thread of its own, free of the rules of signal handlers. Make it before any other thread, so
/// that all inherit the mask. A second signal ends the process at once, for what does not come to
/// its end.
class SignalWatch {
 public:
  explicit SignalWatch(std::function<void(int signal)> on_signal);
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

 private:
  std::jthread thread_;
};

}  // namespace translucube::server

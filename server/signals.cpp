#include "server/signals.h"

#include <pthread.h>
#include <signal.h>

#include <cstdlib>
#include <ctime>

namespace translucube::server {

SignalWatch::SignalWatch(std::function<void(int signal)> on_signal) {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  thread_ = std::jthread([set, on_signal = std::move(on_signal)](std::stop_token ended) {
    const timespec poll{0, 100'000'000};
    for (int seen = 0; !ended.stop_requested();) {
      const int signal = sigtimedwait(&set, nullptr, &poll);
      if (signal <= 0) continue;
      if (++seen > 1) std::_Exit(128 + signal);
      on_signal(signal);
    }
  });
}

}  // namespace translucube::server

#include "server/base/signals.h"

#include <pthread.h>
#include <signal.h>

#include <cstdlib>

namespace translucube::server {

SignalWatch::SignalWatch(std::function<void(int signal)> on_signal) {
  sigset_t set;
  sigemptyset(&set);
  sigaddset(&set, SIGINT);
  sigaddset(&set, SIGTERM);
  struct sigaction hang_up {};  // a terminal that was closed; nohup(1) ignores it
  if (sigaction(SIGHUP, nullptr, &hang_up) != 0 || hang_up.sa_handler != SIG_IGN)
    sigaddset(&set, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &set, nullptr);
  thread_ = std::jthread([set, on_signal = std::move(on_signal)](std::stop_token ended) {
    for (int seen = 0;;) {
      int signal = 0;
      sigwait(&set, &signal);
      if (ended.stop_requested()) return;
      if (++seen > 1) std::_Exit(128 + signal);
      on_signal(signal);
    }
  });
}

SignalWatch::~SignalWatch() {
  thread_.request_stop();
  // To that thread alone, which waits for nothing else.
  pthread_kill(thread_.native_handle(), SIGTERM);
}

}  // namespace translucube::server

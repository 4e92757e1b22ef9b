#pragma once

#include <chrono>
#include <stop_token>
#include <utility>

namespace translucube {

/// How long a pass may take, whatever its paths do.
struct Patience {
  using Clock = std::chrono::steady_clock;

  std::stop_token stop;  ///< then there is no film
  /// Then the paths under way are given up, and their weight counts as truncated energy.
  Clock::time_point deadline = Clock::time_point::max();

  Patience() = default;
  Patience(std::stop_token stop_, Clock::time_point deadline_ = Clock::time_point::max())
      : stop(std::move(stop_)), deadline(deadline_) {}

  bool has_deadline() const { return deadline != Clock::time_point::max(); }
  bool over() const {
    return stop.stop_requested() || (has_deadline() && Clock::now() >= deadline);
  }
};

}  // namespace translucube

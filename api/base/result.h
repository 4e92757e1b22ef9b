#pragma once

// What a function gives that may be refused: its value, or the problem why there is none.
//
//   const Result<Sweep> sweep = parse_sweep_request(text, catalog);
//   if (!sweep) return sweep.problem();
//   use(*sweep);

#include <concepts>
#include <utility>
#include <variant>

#include "api/base/problem.h"

namespace translucube::api {

template <class T>
class [[nodiscard]] Result {
 public:
  template <std::convertible_to<T> U = T>
  Result(U&& value) : held_(std::in_place_index<0>, std::forward<U>(value)) {}
  Result(Problem problem) : held_(std::in_place_index<1>, std::move(problem)) {}

  explicit operator bool() const { return held_.index() == 0; }

  // Asked for the one where it holds the other, it throws std::bad_variant_access.
  T& operator*() & { return std::get<0>(held_); }
  const T& operator*() const& { return std::get<0>(held_); }
  T&& operator*() && { return std::get<0>(std::move(held_)); }
  T* operator->() { return &**this; }
  const T* operator->() const { return &**this; }
  const Problem& problem() const { return std::get<1>(held_); }

 private:
  std::variant<T, Problem> held_;
};

}  // namespace translucube::api

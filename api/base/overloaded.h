#pragma once

namespace translucube::api {

/// A visitor of a variant, made of a lambda for each alternative.
template <typename... Visitors>
struct Overloaded : Visitors... {
  using Visitors::operator()...;
};
template <typename... Visitors>
Overloaded(Visitors...) -> Overloaded<Visitors...>;  // clang 14 does not guess it

}  // namespace translucube::api

#pragma once

// What clients of the service ask for in the tests that put it under load: small renders of several
// materials and qualities, and sweeps.

#include <array>
#include <random>
#include <string>

namespace translucube::server::test {

using Random = std::mt19937;

inline int pick(Random& random, int low, int high) {
  return std::uniform_int_distribution(low, high)(random);
}
template <typename List>
const auto& one_of(const List& list, Random& random) {
  return list[static_cast<std::size_t>(pick(random, 0, static_cast<int>(std::size(list)) - 1))];
}

/// A request to post.
struct Order {
  std::string path, body;
  bool exact = true;  ///< its quality says how many samples: its bits are known beforehand
  bool explorable = false;
};

inline std::string image_part(int size, const std::string& quality, int seed) {
  const std::string pixels = std::to_string(size);
  return R"("image":{"width":)" + pixels + R"(,"height":)" + pixels + R"(},"quality":{)" + quality +
         R"(},"seed":)" + std::to_string(seed);
}

inline Order render_order(Random& random, int seeds) {
  static const std::array<std::string, 5> materials{
      R"({"cube":{"absorption":0.3,"roughness":0.3,"scattering":0.5}})",
      R"({"cube":{"absorption":0.1,"roughness":0,"scattering":0}})",
      R"({"cube":{"absorption":0.6,"roughness":0.8,"scattering":0.2},"absorber":"red-glass"})",
      R"({"cube":{"absorption":0,"roughness":0,"scattering":1}})",
      R"({"cube":{"absorption":0.5,"roughness":0.5,"scattering":0.7},"pigment":{"absorption_per_scattering":0.1}})"};
  static const std::array<std::string, 5> qualities{R"("samples":20)", R"("samples":64)",
                                                    R"("samples":200)", R"("relative_error":0.2)",
                                                    R"("seconds":0.2)"};
  const std::string quality = one_of(qualities, random);
  Order order{"/v1/renders", {}, quality.find("samples") != quality.npos};
  const std::string material = one_of(materials, random);
  order.explorable =
      order.exact && material.find("pigment") == material.npos && pick(random, 0, 4) == 0;
  order.body = R"({"material":)" + material + (order.explorable ? R"(,"explorable":true,)" : ",") +
               image_part(pick(random, 1, 3) * 16, quality, pick(random, 1, seeds)) + "}";
  return order;
}

/// Nine points that come from three traced images.
inline Order sweep_order(Random& random, int seeds) {
  return {"/v1/sweeps",
          R"({"base":{"material":{"cube":{"absorption":0.3,"roughness":0.3,"scattering":0.5}},)" +
              image_part(16, R"("samples":)" + std::to_string(pick(random, 1, 3) * 20),
                         pick(random, 1, seeds)) +
              R"(},"axes":{"absorption":[0,0.5,1],"scattering":{"from":0,"to":0.8,"count":3}}})"};
}

}  // namespace translucube::server::test

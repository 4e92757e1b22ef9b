// Speed is guarded without a clock: neither the variance nor the counted work of a camera sample
// may rise above what is written down. `speed --write-guard tests/transport/efficiency.json` writes
// it again, after a change that is meant.

#include "tests/support/efficiency.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/support/repository.h"

namespace translucube::test {
namespace {

TEST(Efficiency, OfThePeersMaterialsIsNoLessThanWrittenDown) {
  std::ifstream file(in_repository("tests/transport/efficiency.json"));
  const nlohmann::json written = nlohmann::json::parse(file);
  for (const PeerMaterial& material : peer_materials)
    for (const Measure& measure : efficiency(material, 0)) {
      const double ceiling = written.at(material.name).at(measure.name).at("ceiling");
      EXPECT_LE(measure.value, ceiling) << material.name << ", " << measure.name << " a sample";
    }
}

}  // namespace
}  // namespace translucube::test

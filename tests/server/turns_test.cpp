#include "server/base/turns.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace translucube::server::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;

TEST(TurnsTest, SoManyAtOnceAndNoneInLineGetsNone) {
  Turns turns(2, 0, std::chrono::hours(1));
  Places::Place first = turns.take();
  const Places::Place second = turns.take();
  EXPECT_TRUE(first && second);
  EXPECT_FALSE(turns.take());
  first.reset();
  EXPECT_TRUE(turns.take());
}

TEST(TurnsTest, WhoStandsInLineGetsTheTurnThatIsGivenBack) {
  Turns turns(1, 3, std::chrono::hours(1));
  Places::Place first = turns.take();
  std::atomic<int> served = 0;
  {
    std::vector<std::jthread> line;
    for (int i = 0; i < 3; ++i)
      line.emplace_back([&] {
        if (turns.take()) ++served;
      });
    first.reset();
  }
  EXPECT_EQ(served, 3);
  EXPECT_TRUE(turns.take());
}

TEST(TurnsTest, NobodyStandsInLineForLongerThanSaid) {
  Turns turns(1, 1, milliseconds(50));
  const Places::Place only = turns.take();
  const auto start = steady_clock::now();
  EXPECT_FALSE(turns.take());
  EXPECT_GE(steady_clock::now() - start, milliseconds(50));
  EXPECT_FALSE(turns.take());  // the place in line was given back
}

}  // namespace
}  // namespace translucube::server::test

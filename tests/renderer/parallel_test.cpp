#include "renderer/base/parallel.h"

#include <gtest/gtest.h>

#include <new>
#include <stdexcept>

namespace translucube {
namespace {

TEST(Parallel, WhatAnyThreadThrowsIsThrownToTheCaller) {
  for (int thrower = 0; thrower < 64; ++thrower)
    EXPECT_THROW(parallel_for(4, 64,
                              [&](int i) {
                                if (i == thrower) throw std::bad_alloc();
                              }),
                 std::bad_alloc);
}

TEST(Parallel, AfterAThrowNoFurtherTurnIsHandedOut) {
  std::atomic<int> done = 0;
  EXPECT_THROW(parallel_for(1, 1000,
                            [&](int i) {
                              ++done;
                              if (i == 3) throw std::runtime_error("no");
                            }),
               std::runtime_error);
  EXPECT_EQ(done, 4);
}

}  // namespace
}  // namespace translucube

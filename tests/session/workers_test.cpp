#include "session/workers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace gaitpad::test {
namespace {

TEST(Workers, DoEachPieceOnce) {
  for (const int threads : {1, 2, 4, 64}) {
    Workers workers(threads);
    std::vector<std::atomic<int>> done(1000);
    for (int round = 0; round < 20; ++round) workers.for_each(1000, [&](int i) { ++done[i]; });
    for (const std::atomic<int>& times : done) EXPECT_EQ(times, 20);
  }
}

TEST(Workers, AreAtLeastTheCaller) {
  EXPECT_EQ(Workers(0).threads(), 1);
  EXPECT_EQ(Workers(-3).threads(), 1);
  EXPECT_GE(machine_threads(), 1);
}

}  // namespace
}  // namespace gaitpad::test

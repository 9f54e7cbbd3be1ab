#include "bench/measured.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

Work work(const char* name, double most_ratio = 0.0) {
  Work work;
  work.name = name;
  work.most_ratio = most_ratio;
  if (most_ratio > 0.0) work.over = "playback";
  return work;
}

TEST(BenchRow, QuantilesLieBetweenTheRounds) {
  const BenchRow row{nullptr, {40.0, 10.0, 30.0, 20.0, 50.0}};
  EXPECT_DOUBLE_EQ(row.median(), 30.0);
  EXPECT_DOUBLE_EQ(row.quantile(0.25), 20.0);
  EXPECT_DOUBLE_EQ(row.quantile(0.0), 10.0);
  EXPECT_DOUBLE_EQ(row.quantile(1.0), 50.0);
  EXPECT_DOUBLE_EQ(row.quantile(0.125), 15.0);
}

TEST(BenchList, ARowTellsItsRatioToItsPeerAndWhetherItsBoundIsMet) {
  const Work peer = work("playback"), met = work("fast", 2.0), missed = work("slow", 2.0);
  const std::vector<BenchRow> rows = {{&peer, {100.0}}, {&met, {200.0}}, {&missed, {201.0}}};
  EXPECT_FALSE(json_of(rows[0], rows).contains("met"));
  EXPECT_DOUBLE_EQ(json_of(rows[1], rows)["ratio"], 2.0);
  EXPECT_TRUE(json_of(rows[1], rows)["met"].get<bool>());
  EXPECT_FALSE(json_of(rows[2], rows)["met"].get<bool>());
}

// Each work runs in each round, except those with a larger `every`.
TEST(Measured, WorksTakeTurns) {
  std::vector<Work> works = {work("each"), work("every third")};
  int passes = 0;
  works[0].pass = [&passes] { ++passes; };
  works[1].pass = [] {};
  works[1].every = 3;
  std::vector<double> shares;
  const auto rows =
      measured(works, 4, Cores(), [&shares](double share) { shares.push_back(share); });
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].ns.size(), 4u);
  EXPECT_EQ(rows[1].ns.size(), 2u);
  EXPECT_GE(passes, 5);
  EXPECT_EQ(shares, (std::vector<double>{0.0, 0.25, 0.5, 0.75}));
}

}  // namespace
}  // namespace gaitpad

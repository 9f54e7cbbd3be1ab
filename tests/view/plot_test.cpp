#include "view/plot.h"

#include <gtest/gtest.h>

#include <cmath>

namespace gaitpad {
namespace {

TEST(ThinOut, ThinnedOutALineStaysWithinTheTolerance) {
  std::vector<ImVec2> line;
  for (int i = 0; i < 500; ++i) {
    line.push_back({static_cast<float>(i) * 0.5f, 40.0f * std::sin(static_cast<float>(i) * 0.03f)});
  }
  std::vector<ImVec2> thin = line;
  thin_out(thin, 0.15f);
  EXPECT_LT(thin.size(), line.size() / 4);
  EXPECT_EQ(thin.front().x, line.front().x);
  EXPECT_EQ(thin.back().x, line.back().x);
  std::size_t k = 0;
  for (const ImVec2& p : line) {
    while (thin[k + 1].x < p.x) ++k;
    const float share = (p.x - thin[k].x) / (thin[k + 1].x - thin[k].x);
    const float y = thin[k].y + share * (thin[k + 1].y - thin[k].y);
    ASSERT_LE(std::abs(y - p.y), 0.16f) << p.x;
  }
}

TEST(ThinOut, UprightStretchesOfALineStay) {
  std::vector<ImVec2> line = {{0, 0}, {1, 0}, {1, 9}, {1, -9}, {1, 5}, {2, 0}, {3, 0}, {4, 0}};
  thin_out(line, 0.1f);
  EXPECT_EQ(line.size(), 7u);  // all points except {3, 0}
  EXPECT_EQ(line[2].y, 9.0f);
  EXPECT_EQ(line[3].y, -9.0f);
}

}  // namespace
}  // namespace gaitpad

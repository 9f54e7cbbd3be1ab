// Lines are where the camera projects them: of the grid, trails, single ones.
#include <gtest/gtest.h>

#include <cmath>

#include "view/scene_fixture.h"

namespace gaitpad {
namespace {

TEST_F(SceneTest, GridLinesLieAtWholeMetresOfTheWorld) {
  look_down();
  for (const double x_m : {0.0, 0.3, 150.6}) {
    camera_.target_m.x = content_.focus_m.x = x_m;
    content_.has_grid = false;
    const Pixels without = drawn(content_);
    content_.has_grid = true;
    const Pixels with = drawn(content_);
    const auto line_at = [&](double x, double z) {
      double most = 0.0;  // a line is a pixel or two wide
      for (const int off : {-1, 0, 1})
        most = std::max(most, brighter(with, without, {x, 0.0, z}, off));
      return most;
    };
    const double metre = std::round(x_m);
    EXPECT_GT(line_at(metre, 0.5), 20.0) << x_m;
    EXPECT_GT(line_at(metre + 1.0, 0.5), 20.0) << x_m;
    const double twenty = line_at(metre + 0.4, 0.5);
    EXPECT_GT(twenty, 3.0) << x_m;
    EXPECT_LT(twenty, 0.7 * line_at(metre, 0.5)) << x_m;
    EXPECT_LT(line_at(metre + 0.5, 0.5), 1.5) << x_m;
  }
}

TEST_F(SceneTest, ATrailFadesTowardsItsOldEnd) {
  look_down();
  content_.has_grid = false;
  const Pixels without = drawn(content_);
  Trail trail;
  for (int i = 0; i <= 40; ++i) trail.points_m.push_back({-1.0 + i * 0.05, 0.01, 0.0});
  trail.colour = rgb(0xffffff);
  content_.trails = {trail};
  const Pixels with = drawn(content_);
  const auto strength = [&](double x_m) { return brighter(with, without, {x_m, 0.01, 0.0}); };
  EXPECT_GT(strength(0.95), 100.0);
  EXPECT_GT(strength(0.95), strength(0.3) + 20.0);
  EXPECT_GT(strength(0.3), strength(-0.4) + 20.0);
  EXPECT_LT(strength(-0.95), 5.0);
}

TEST_F(SceneTest, ALineIsAsWideAsItsPixelsTimesTheScale) {
  camera_.yaw_rad = camera_.pitch_rad = 0.0;
  const vec3 a = camera_.target_m - kUp * 0.5, b = camera_.target_m + kUp * 0.5;
  for (const double scale : {1.0, 2.0}) {
    scale_ = scale;
    content_.lines.clear();
    const Pixels without = drawn(content_);
    content_.lines = {{a, b, rgb(0xffffff), 4.0}};
    const Pixels with = drawn(content_);
    double covered = 0.0;  // pixels of one row
    const int row = kHeight / 2;
    for (int x = 0; x < kWidth; ++x) covered += differs(with, without, x, row);
    EXPECT_NEAR(covered, 4.0 * scale, 1.1);
  }
}

TEST_F(SceneTest, ALineThatPassesTheEyeIsCutThere) {
  const vec3 behind = camera_.eye_m() + (camera_.eye_m() - camera_.target_m) * 0.5 + kUp * 0.1;
  const Pixels without = drawn(content_);
  content_.lines = {{camera_.target_m, behind, rgb(0xffffff), 3.0}};
  const Extent seen = difference(without, drawn(content_));
  EXPECT_GT(seen.pixels, 20);
  EXPECT_NEAR(seen.bottom, kHeight / 2.0, 12.0);  // it rises from the middle, to above the eye
}

TEST_F(SceneTest, BodiesHideLinesBehindThem) {
  camera_.yaw_rad = 0.0;
  const vec3 at = camera_.target_m;
  content_.bodies = {bone(at, at, 0.3)};
  const Pixels without = drawn(content_);
  content_.lines = {{at - vec3(1.0, 0.0, 1.0), at + vec3(1.0, 0.0, -1.0), rgb(0xffffff), 4.0}};
  const Pixels with = drawn(content_);
  EXPECT_FALSE(differs(with, without, kWidth / 2, kHeight / 2));
  const vec3 beside = place(at + vec3(0.8, 0.0, -1.0));
  EXPECT_TRUE(differs(with, without, static_cast<int>(beside.x), static_cast<int>(beside.y)));
}

}  // namespace
}  // namespace gaitpad

// Weights of legs show and leave nothing behind; planted points stay with every shipped style;
// walks of several styles side by side have the bits of one alone.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/walk/made_block.h"

namespace gaitpad {
namespace {

constexpr double kPlanted_m = 1e-5;

// How far a planted end of a sole moves in a tick, at most, in so many ticks.
double most_slid_m(Alone& walk, const GaitParams& params, int ticks) {
  double slid_m = 0.0;
  Planted was_planted;
  vec3 was;
  for (int tick = 0; tick < ticks; ++tick) {
    const Planted planted = planted_of(walk.block);
    walk.step(params);
    const vec3 place = end_of(walk.pose, planted.side, planted.toe);
    if (tick > 0 && planted == was_planted) slid_m = std::max(slid_m, glm::distance(place, was));
    was = place, was_planted = planted;
  }
  return slid_m;
}

class Weights : public testing::TestWithParam<std::pair<const char*, double>> {};

TEST_P(Weights, ShowInTheLegsAndNotInTheFootprints) {
  const auto [key, weight] = GetParam();
  for (const double stick : {0.3, 0.8, 1.0}) {
    StyleValues style;
    ASSERT_TRUE(set_value(style, key, weight));
    Alone walk, even;
    const GaitParams params = params_of(0.0, stick, style);
    EXPECT_LE(most_slid_m(walk, params, 6 * kRate), kPlanted_m);
    even.walk(params_of(0.0, stick), 6 * kRate);
    EXPECT_LE(std::abs(walk.block.origin[0].z_m - even.block.origin[0].z_m), 1e-4);
    double shows_deg = 0.0;
    for (int tick = 0; tick < kRate; ++tick) {
      walk.step(params);
      for (const Side side : {kLeftSide, kRightSide})
        for (int j = 0; j < kLegAngles; ++j)
          shows_deg = std::max(
              shows_deg,
              std::abs(static_cast<double>(walk.block.weighted.shift_rad[side][j])) / kDegree);
    }
    EXPECT_GT(shows_deg, 2.0) << "the weights do nothing";
  }
}
INSTANTIATE_TEST_SUITE_P(OfJoints, Weights,
                         testing::Values(std::pair{"legs.weight.hip", 0.2},
                                         std::pair{"legs.weight.knee", 0.2},
                                         std::pair{"legs.weight.ankle", 0.2},
                                         std::pair{"left_leg.weight.hip", 0.1},
                                         std::pair{"legs.weight.hip_y", 0.2}));

TEST(WeightsOfAStyle, BeginAndEndWithoutAJump) {
  StyleValues stiff;
  ASSERT_TRUE(set_value(stiff, "legs.weight.hip", 0.2));
  for (const double stick : {0.3, 0.8}) {
    Alone walk;
    walk.walk(params_of(0.0, stick), 4 * kRate + 70);
    Jerks jerks;
    for (int tick = 0; tick < 6 * kRate; ++tick) {
      walk.step(params_of(0.0, stick, tick < 3 * kRate ? stiff : StyleValues{}));
      jerks.add(walk.pose);
    }
    EXPECT_LE(jerks.most_deg, 1.0);
    EXPECT_EQ(walk.block.weighted.acts, 0.0f) << "nothing is left of them";
  }
}

// A leg whose goal is far out of reach points there, stretched; when the goal is back, so is the
// foot.
TEST(WeightsOfAStyle, StretchALegThatIsOutOfReachAndFindBackToItsFoot) {
  const GaitParams go = params_of(0.0, 1.0, shipped("stiff_knee")),
                   stop = params_of(0.0, 0.0, shipped("stiff_knee"));
  Alone walk;
  walk.walk(go, 4 * kRate);
  walk.walk(stop, kRate / 5);
  walk.block.change.pelvis_z_m.x += 0.6f;  // the hips jump ahead of their feet
  double most_m = 0.0;
  for (int tick = 0; tick < kRate; ++tick) {
    walk.step(stop);
    for (const Side side : {kLeftSide, kRightSide})
      most_m = std::max(most_m, glm::distance(end_of(walk.pose, side, true), walk.pose.root_m));
  }
  EXPECT_LT(most_m, 1.3) << "a leg is longer than its bones";
  walk.walk(stop, 2 * kRate);
  ASSERT_TRUE(walk.stands());
  EXPECT_LE(most_slid_m(walk, stop, kRate), kPlanted_m);
  for (const Side side : {kLeftSide, kRightSide})
    EXPECT_NEAR(end_of(walk.pose, side, false).y, 0.0, 0.001);
}

class Shipped : public testing::TestWithParam<const char*> {};

TEST_P(Shipped, StyleKeepsPlantedFeetInTheirPlaces) {
  for (const double stick : {0.3, 0.8, 1.0}) {
    Alone walk;
    EXPECT_LE(most_slid_m(walk, params_of(0.0, stick, shipped(GetParam())), 6 * kRate), kPlanted_m);
  }
}
INSTANTIATE_TEST_SUITE_P(Of, Shipped,
                         testing::Values("carry", "even", "heavy_slack", "limp_left",
                                         "limp_left_hip", "limp_left_knee", "look_down", "muscular",
                                         "rail_left", "stiff_arms", "stiff_hip", "stiff_knee",
                                         "tired", "tiring"),
                         [](const auto& info) { return std::string(info.param); });

// Walks of several styles and phases; one gets weights, then all have none.
TEST(Styles, WalksSideBySideHaveTheBitsOfOneAlone) {
  const std::array<StyleValues, 4> styles = {StyleValues{}, shipped("limp_left_hip"),
                                             shipped("heavy_slack"), shipped("tired")};
  for_each_width([&](auto width) {
    std::vector<std::unique_ptr<Alone>> walks;
    for (const StyleValues& style : styles) {
      walks.push_back(std::make_unique<Alone>());
      walks.back()->walk(params_of(0.0, 0.8, style), 4 * kRate);
    }
    std::vector<Block<1>> alone;
    for (int w = 0; w < width; ++w) {
      Alone& of_style = *walks[w % 4];
      for (int tick = 0; tick < 31 * w + 3; ++tick) of_style.step();
      alone.push_back(of_style.block);
      if (w % 4 == 0) alone.back().state.asked.length_m[1] *= 0.6f;
    }
    expect_bits_of_one<width>(walks[0]->tables, alone, 600, [&](int tick, int w, Block<1>& block) {
      if (tick != 300 && tick != 450) return false;
      ask(params_of(0.0, 0.8,
                    tick == 450 ? StyleValues{} : shipped(w == 0 ? "stiff_hip" : "stiff_knee")),
          block);
      return true;
    });
  });
}

}  // namespace
}  // namespace gaitpad

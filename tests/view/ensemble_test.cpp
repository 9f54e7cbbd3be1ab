#include "view/ensemble.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <memory>

#include "tests/walking_fixture.h"

namespace gaitpad {
namespace {

class Walking : public WalkingTest {
 protected:
  void SetUp() override { begin({"even", "limp_left"}); }
  void begin(const std::vector<std::string>& styles, int crowd = 0,
             const std::string& terrain = "") {
    start(styles, crowd, terrain);
    ensemble_ = std::make_unique<Ensemble>(cast);
  }
  void run(int ticks) { step(ticks, {"gait speed_m_s 1.2"}); }
  void fill(double share = 1.0) {
    ensemble_->fill(*frame, history, share, cast, state_, theme_of(ThemeName::dark), content_);
  }
  double length_m(const Trail& trail) const {
    double sum_m = 0.0;
    for (std::size_t i = 1; i < trail.points_m.size(); ++i)
      sum_m += glm::length(trail.points_m[i] - trail.points_m[i - 1]);
    return sum_m;
  }

  std::unique_ptr<Ensemble> ensemble_;
  UiState state_;
  SceneContent content_;
};

TEST_F(Walking, TrailsOfBothFeetGrowUpToWhatIsRemembered) {
  run(240);
  fill();
  ASSERT_EQ(content_.trails.size(), 4u);
  const double after_one_s = length_m(content_.trails[0]);
  run(240);
  fill();
  EXPECT_GT(length_m(content_.trails[0]), after_one_s + 0.5);  // the walk has 1.2 m/s
  run(1200);
  fill();
  const double after_seven_s = length_m(content_.trails[0]);
  run(240);
  fill();
  EXPECT_NEAR(length_m(content_.trails[0]), after_seven_s, 0.7);
  // The length of a trail of three seconds, of a foot that also rises.
  EXPECT_LT(after_seven_s, 1.2 * 3.0 * 1.6);
}

TEST_F(Walking, PointsOfATrailStayWhereTheyAre) {
  run(243);
  fill();
  const std::vector<vec3> before = content_.trails[0].points_m;
  run(1);
  fill();
  for (std::size_t i = 0; i + 2 < before.size(); ++i)
    EXPECT_EQ(content_.trails[0].points_m[i], before[i]) << i;
}

TEST_F(Walking, WhatIsSwitchedOffIsNotThere) {
  run(240);
  state_.has_trails = state_.has_source = state_.has_names = false;
  fill();
  EXPECT_TRUE(content_.trails.empty());
  EXPECT_TRUE(content_.lines.empty());
  EXPECT_FALSE(content_.capsules.empty());
  EXPECT_TRUE(content_.crowd.empty());  // there is no crowd
  EXPECT_TRUE(content_.crowd_shades.empty());
  EXPECT_EQ(content_.reach_m, 0.0);
  const Viewport viewport{0, 0, 800, 600};
  EXPECT_TRUE(ensemble_->labels(*frame, cast, Camera(), viewport, state_, theme_of(ThemeName::dark))
                  .empty());
}

TEST_F(Walking, AMomentBetweenTwoTicksIsDrawnBetweenTheirPoses) {
  run(300);
  const auto z_at = [this](double share) {
    fill(share);
    return ensemble_->focus_m(0).z;
  };
  const double from = z_at(0.0), to = z_at(1.0);
  EXPECT_EQ(from, frame->walkers[0].before.root_m.z);
  EXPECT_EQ(to, frame->walkers[0].pose.root_m.z);
  EXPECT_NEAR(z_at(0.25), from + 0.25 * (to - from), 1e-12);
  EXPECT_GT(to - from, 0.001);
}

// Compares every end of every drawn bone and line.
TEST_F(Walking, TwoThatAreOverlaidStandInOnePlaceHalfTransparent) {
  begin({"even", "limp_left", "stiff_knee"});
  run(600);
  step(400, {"gait 3 turn_rate_rad_s 0.5"});
  fill();
  const std::vector<Capsule> apart = content_.capsules;
  const std::size_t bones = apart.size() / 3;
  const auto middle_m = [&](std::size_t walker) {
    vec3 sum(0.0);
    for (std::size_t i = walker * bones; i < (walker + 1) * bones; ++i)
      sum += 0.5 * (content_.capsules[i].a_m + content_.capsules[i].b_m) / double(bones);
    return sum;
  };
  EXPECT_GT(glm::distance(middle_m(0), middle_m(2)), 1.0);
  state_.overlaid = {2, 0};  // the first of both marked characters keeps its place
  fill();
  ASSERT_EQ(content_.capsules.size(), apart.size());
  EXPECT_LT(glm::distance(middle_m(0), middle_m(2)), 0.15);
  for (std::size_t i = 0; i < apart.size(); ++i) {
    EXPECT_EQ(content_.capsules[i].layer, i < bones ? 2 : i < 2 * bones ? 0 : 1);
    if (i >= bones) EXPECT_EQ(content_.capsules[i].a_m, apart[i].a_m);
  }
  EXPECT_EQ(content_.trails.size(), 4u);  // trails of the characters on their paths
  // The first bone is the pelvis, from hip to hip. Both face the same way.
  const auto turned_rad = [](const Capsule& pelvis) {
    return std::atan2(pelvis.b_m.z - pelvis.a_m.z, pelvis.b_m.x - pelvis.a_m.x);
  };
  const double there_rad = turned_rad(apart[2 * bones]);
  EXPECT_GT(std::abs(std::remainder(turned_rad(apart[0]) - there_rad, 2.0 * kPi)), 0.5);
  EXPECT_LT(std::abs(std::remainder(turned_rad(content_.capsules[0]) - there_rad, 2.0 * kPi)), 0.3);
  state_.overlaid = {0, 7};  // character 7 does not exist
  fill();
  EXPECT_EQ(content_.capsules[0].layer, 0);
}

TEST_F(Walking, InItsFramingTheCameraSeesEverybodyWithTheirNames) {
  struct Size {
    Viewport viewport;
    double scale;
  };
  for (const char* terrain : {"flat", "slope_down", "stairs"}) {
    begin({"even", "stiff_hip", "stiff_knee", "limp_left"}, 0, terrain);
    run(600);
    fill();
    for (const Size& size : {Size{{232, 44, 744, 612}, 1.0}, Size{{0, 0, 1280, 600}, 1.0},
                             Size{{0, 44, 640, 330}, 1.0}, Size{{464, 88, 2768, 1960}, 2.0},
                             Size{{0, 0, 300, 700}, 1.0}}) {
      const Viewport& viewport = size.viewport;
      for (const double yaw : {Camera().yaw_rad, 1.1, kPi / 2.0, -kPi / 2.0, 2.05}) {
        SCOPED_TRACE(std::string(terrain) + ", yaw " + std::to_string(yaw) + ", width " +
                     std::to_string(viewport.width));
        Camera camera{.yaw_rad = yaw};
        show(camera, ensemble_->framing(camera, viewport, state_, size.scale),
             ensemble_->focus_m(-1));
        const auto expect_seen = [&](const vec3& place_m) {
          const vec3 place = projected(camera, place_m, viewport.width, viewport.height);
          EXPECT_GT(place.z, 0.0);
          EXPECT_GT(place.x, 0.0);
          EXPECT_LT(place.x, viewport.width);
          EXPECT_GT(place.y, 0.0);
          EXPECT_LT(place.y, viewport.height);
        };
        for (const Capsule& bone : content_.capsules) {
          expect_seen(bone.a_m);
          expect_seen(bone.b_m);
        }
        for (const SceneLine& line : content_.lines) {
          expect_seen(line.a_m);
          expect_seen(line.b_m);
        }
        const auto labels =
            ensemble_->labels(*frame, cast, camera, viewport, state_, theme_of(ThemeName::dark));
        ASSERT_EQ(labels.size(), 5u);
        EXPECT_EQ(labels[0].text, "even");
        EXPECT_EQ(labels[3].text, "limp left");
        EXPECT_EQ(labels[4].text, "source");
      }
    }
  }
}

// The crowd's members stand behind the walkers, on the floor, as wide and high as persons.
TEST_F(Walking, ACrowdStandsBehindTheWalkers) {
  begin({"even"}, 30);
  run(300);
  fill();
  ASSERT_EQ(cast.crowd.size(), 30u);
  ASSERT_EQ(content_.crowd_shades.size(), 90u);  // shades of two feet and a body for each member
  EXPECT_GT(content_.crowd.size(), 30u * 14);
  const vec3 first = simulation->walkers().front().pose.root_m;
  double lowest_m = 1.0, highest_m = 0.0;
  for (const FlatCapsule& c : content_.crowd) {
    const vec3 a = vec3(c.a_radius) + content_.crowd_origin_m;
    EXPECT_LT(a.z, first.z + 0.1);
    EXPECT_LT(glm::distance(a, first), content_.reach_m);
    lowest_m = std::min(lowest_m, a.y - c.a_radius.w);
    highest_m = std::max(highest_m, a.y + c.a_radius.w);
  }
  EXPECT_NEAR(lowest_m, 0.0, 0.03);
  EXPECT_GT(highest_m, 1.5);
  EXPECT_LT(highest_m, 2.2);
}

TEST_F(Walking, AMemberNearTheEyeHasMoreBones) {
  begin({"even"}, 30);
  ensemble_->look_from(vec3(0.0, 1.6, 50.0));
  fill();
  const std::size_t from_afar = content_.crowd.size();
  ensemble_->look_from(vec3(0.0, 1.6, -4.0));
  fill();
  EXPECT_GT(content_.crowd.size(), from_afar * 3 / 2);
}

TEST_F(Walking, ACrowdMovesBetweenTwoTicksByTheirShare) {
  begin({"even"}, 10);
  run(500);
  std::array<double, 3> z{};
  for (std::size_t i = 0; i < 3; ++i) {
    fill(0.5 * static_cast<double>(i));
    z[i] = content_.crowd.front().a_radius.z;
  }
  EXPECT_GT(z[2], z[0] + 0.001);
  EXPECT_NEAR(z[1], 0.5 * (z[0] + z[2]), 1e-4);
}

// The source walks as on level ground; only its stick figure has lines.
TEST_F(Walking, OnStairsTheSourceIsNeverInTheGround) {
  begin({"even"}, 0, "stairs");
  double highest_m = 0.0, most_above_m = 0.0;
  for (int i = 0; i < 120; ++i) {
    run(12);
    fill();
    double lowest_m = 1.0;
    for (const SceneLine& line : content_.lines) {
      for (const vec3& end : {line.a_m, line.b_m}) {
        const double ground_m = ground_at(*cast.terrain, end.x, end.z).height_m;
        lowest_m = std::min(lowest_m, end.y - ground_m);
        highest_m = std::max(highest_m, ground_m);
      }
    }
    EXPECT_GE(lowest_m, -1e-9) << "tick " << frame->tick;
    most_above_m = std::max(most_above_m, lowest_m);
  }
  EXPECT_GT(highest_m, 0.9) << "it was on the stairs";
  EXPECT_LT(most_above_m, 0.25) << "nor does it fly";
}

// Distance from a place to the nearest end of a drawn bone.
double nearest_end_m(const SceneContent& content, const vec3& place_m) {
  double nearest_m = 1e9;
  for (const Capsule& bone : content.capsules)
    nearest_m =
        std::min({nearest_m, glm::distance(bone.a_m, place_m), glm::distance(bone.b_m, place_m)});
  return nearest_m;
}

// Heel and toe of `frames.csv` are as near to an end of a drawn bone as in a standing foot: drawing
// moves no foot by more than 2 cm, above level 0 and below it.
TEST_F(Walking, OnEveryTerrainTheFeetAreDrawnWhereTheyAreExported) {
  constexpr double kMoved_m = 0.02;
  struct Heights {
    double lowest, highest;
  };
  const std::pair<const char*, Heights> kTerrains[] = {
      {"flat", {0.0, 0.0}},   {"slope_up", {0.0, 1.5}}, {"slope_down", {-1.5, 0.0}},
      {"stairs", {0.0, 0.9}}, {"rough", {-0.02, 0.02}}, {"zones", {0.0, 0.5}},
      {"course", {0.0, 0.8}}};
  for (const auto& [terrain, was_m] : kTerrains) {
    SCOPED_TRACE(terrain);
    begin({"even"}, 0, terrain);
    fill();
    const auto reach_m = [this](Side side) {
      const WalkFrame& walk = frame->walkers[0].walk;
      return std::array{nearest_end_m(content_, walk.heel_m[side]),
                        nearest_end_m(content_, walk.toe_m[side])};
    };
    const std::array standing = {reach_m(kLeftSide), reach_m(kRightSide)};
    double lowest_m = 0.0, highest_m = 0.0, most_m = 0.0;
    for (int i = 0; i < 460; ++i) {  // 27 m, the whole length of each terrain except the course
      run(12);
      fill();
      for (const Side side : {kLeftSide, kRightSide}) {
        const auto now = reach_m(side);
        for (const std::size_t point : {0, 1})
          most_m = std::max(most_m, std::abs(now[point] - standing[side][point]));
        const double heel_m = frame->walkers[0].walk.heel_m[side].y;
        lowest_m = std::min(lowest_m, heel_m);
        highest_m = std::max(highest_m, heel_m);
      }
    }
    EXPECT_LT(most_m, kMoved_m);
    EXPECT_LE(lowest_m, was_m.lowest) << "it went down";
    EXPECT_GE(highest_m, was_m.highest) << "it went up";
  }
}

TEST_F(Walking, TheGroundAheadIsHigherOnTheWayUpAndLowerOnTheWayDown) {
  EXPECT_EQ(ensemble_->rise_ahead_m(-1), 0.0);
  begin({"even"}, 0, "stairs");
  fill();
  bool was_up = false, was_down = false;
  for (int i = 0; i < 80; ++i) {
    run(24);
    fill();
    was_up = was_up || ensemble_->rise_ahead_m(-1) > 0.3;
    was_down = was_down || (was_up && ensemble_->rise_ahead_m(-1) < -0.3);
  }
  EXPECT_TRUE(was_up && was_down);
}

}  // namespace
}  // namespace gaitpad

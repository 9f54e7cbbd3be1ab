// The walk over uneven ground where it is not steady: it stops at any moment, goes on,
// turns round, walks backward, is styled, aimed and pushed.
#include <gtest/gtest.h>

#include "gaitpad/config_files.h"
#include "tests/folders.h"
#include "tests/walk/grounds.h"

namespace gaitpad {
namespace {

// Heels and balls below the ground, beside risers by 2 mm; planted points, in a tick.
constexpr double kDeepest_m = 0.006;

struct Ground {
  const char* name;
  std::vector<SectionShape> sections;
  double wave_m = 0.0;
};
void PrintTo(const Ground& ground, std::ostream* out) { *out << ground.name; }
const Hills kHills{0.05, 0.08, 0.12};
WalkModel model_of(const Ground& ground) {
  return model_on(ground.wave_m != 0.0 ? asked_of(kHills) : ground_of(ground.sections));
}

// A hiker, and what has been seen of it.
struct Seen {
  double deep_m = 0.0, slid_m = 0.0, bend_deg = 0.0;
};
class Watched {
 public:
  Watched(const WalkModel& model, double z_m) : hiker(model, {0.0, z_m, 0.0}), model_(model) {}
  void step(const GaitParams& params) {
    const Planted planted = planted_of(hiker.block);
    const bool begins = hiker.block.state.tick == 0.0f;
    const vec3 was = end_of(hiker.pose, planted.side, planted.toe);
    hiker.step(params);
    const vec3 is = end_of(hiker.pose, planted.side, planted.toe);
    if (!begins && ticks_ > 0) seen.slid_m = std::max(seen.slid_m, glm::distance(is, was));
    seen.deep_m = std::max(seen.deep_m, deepest_m(model_, hiker.pose));
    const Pose &last = pose_[(ticks_ + 2) % 3], &before = pose_[(ticks_ + 1) % 3];
    if (ticks_ >= 2)
      seen.bend_deg = std::max(seen.bend_deg, second_difference_deg(before, last, hiker.pose));
    pose_[ticks_ % 3] = hiker.pose;
    ++ticks_;
  }
  void walk(const GaitParams& params, double seconds) {
    for (int tick = 0; tick < seconds * kRate; ++tick) step(params);
  }
  bool stands() const { return hiker.block.change.stands != 0.0f; }
  // Asks for the landing nearest to that heel.
  bool step_near(const Placement& heel) {
    return ask([&](WalkState& state) {
      const auto near = nearest_step(model_, heel, state);
      return near && step_to(model_, *near, state);
    });
  }
  bool push(const vec3& velocity_m_s) {
    return ask([&](WalkState& state) { return push_walk(velocity_m_s, state); });
  }
  Alone hiker;
  Seen seen;

 private:
  template <class Work>
  bool ask(const Work& work) {
    WalkState state;
    state.walk = hiker.block;
    const bool is_taken = work(state);
    hiker.block = state.walk;
    return is_taken;
  }
  const WalkModel& model_;
  std::array<Pose, 3> pose_;
  int ticks_ = 0;
};

class ChangesOverGround : public testing::TestWithParam<Ground> {};

TEST_P(ChangesOverGround, StopsAtAnyMoment) {
  constexpr double kStands_s = 2.0, kWay_m = 1.0, kUpright_m = 0.03;
  const WalkModel model = model_of(GetParam());
  double longest_s = 0.0, farthest_m = 0.0;
  Seen most;
  for (const double y : {0.3, 0.8, 1.0}) {
    for (int moment = 0; moment < 12; ++moment) {
      Watched walk(model, 0.3);
      walk.walk(params_of(0.0, y), 3.0 + 0.09 * moment);
      walk.seen.bend_deg = 0.0;
      const double from_m = walk.hiker.pose.root_m.z;
      int ticks = 0;
      for (; ticks < 4 * kRate && !walk.stands(); ++ticks) walk.step(GaitParams{});
      ASSERT_TRUE(walk.stands()) << y << " " << moment;
      longest_s = std::max(longest_s, ticks * kDt);
      farthest_m = std::max(farthest_m, walk.hiker.pose.root_m.z - from_m);
      walk.walk(GaitParams{}, 0.2);
      // Upright over the lower one of its feet.
      const double low_m = std::min(end_of(walk.hiker.pose, kLeftSide, false).y,
                                    end_of(walk.hiker.pose, kRightSide, false).y);
      EXPECT_NEAR(walk.hiker.pose.root_m.y - low_m, walk.hiker.tables.stand_m, kUpright_m)
          << y << " " << moment;
      most.deep_m = std::max(most.deep_m, walk.seen.deep_m);
      most.slid_m = std::max(most.slid_m, walk.seen.slid_m);
      most.bend_deg = std::max(most.bend_deg, walk.seen.bend_deg);
    }
  }
  std::printf("%s: stands after %.2f s, %.2f m; %.1f mm deep, %.5f mm slid, %.2f deg\n",
              GetParam().name, longest_s, farthest_m, most.deep_m * 1e3, most.slid_m * 1e3,
              most.bend_deg);
  EXPECT_LE(longest_s, kStands_s);
  EXPECT_LE(farthest_m, kWay_m);
  EXPECT_LE(most.deep_m, kDeepest_m);
  EXPECT_LE(most.slid_m, kPlanted_m);
}

TEST_P(ChangesOverGround, GoesOnWhereTheStickComesBack) {
  const WalkModel model = model_of(GetParam());
  Seen most;
  double slowest_m = 10.0;
  for (const double rest_s : {0.1, 0.3, 0.5}) {
    for (int moment = 0; moment < 8; ++moment) {
      Watched walk(model, 0.3);
      walk.walk(params_of(0.0, 0.8), 3.0 + 0.13 * moment);
      walk.seen.bend_deg = 0.0;
      walk.walk(GaitParams{}, rest_s);
      const double from_m = walk.hiker.pose.root_m.z;
      walk.walk(params_of(0.0, 0.8), 2.5);
      slowest_m = std::min(slowest_m, walk.hiker.pose.root_m.z - from_m);
      most.deep_m = std::max(most.deep_m, walk.seen.deep_m);
      most.slid_m = std::max(most.slid_m, walk.seen.slid_m);
      most.bend_deg = std::max(most.bend_deg, walk.seen.bend_deg);
    }
  }
  std::printf("%s: %.2f m in 2.5 s; %.1f mm deep, %.5f mm slid, %.2f deg\n", GetParam().name,
              slowest_m, most.deep_m * 1e3, most.slid_m * 1e3, most.bend_deg);
  EXPECT_GT(slowest_m, 0.4);
  EXPECT_LE(most.deep_m, kDeepest_m);
  EXPECT_LE(most.slid_m, kPlanted_m);
}

TEST_P(ChangesOverGround, TurnsRoundAndWalksBackward) {
  const WalkModel model = model_of(GetParam());
  Seen most;
  double latest_s = 0.0;
  for (int moment = 0; moment < 6; ++moment) {
    Watched walk(model, 0.3);
    walk.walk(params_of(0.0, 0.7), 4.0 + 0.17 * moment);
    int ticks = 0;
    double last_m = walk.hiker.pose.root_m.z;
    for (; ticks < 4 * kRate; ++ticks) {
      walk.step(params_of(0.0, -0.7));
      const double moved_m = walk.hiker.pose.root_m.z - last_m;
      last_m = walk.hiker.pose.root_m.z;
      if (moved_m < -0.1 * kDt) break;
    }
    latest_s = std::max(latest_s, ticks * kDt);
    const double from_m = walk.hiker.pose.root_m.z;
    walk.walk(params_of(0.0, -0.7), 3.0);
    EXPECT_LT(walk.hiker.pose.root_m.z, from_m - 0.4);
    walk.walk(GaitParams{}, 2.5);
    EXPECT_TRUE(walk.stands());
    most.deep_m = std::max(most.deep_m, walk.seen.deep_m);
    most.slid_m = std::max(most.slid_m, walk.seen.slid_m);
    most.bend_deg = std::max(most.bend_deg, walk.seen.bend_deg);
  }
  std::printf("%s: goes back after %.2f s; %.1f mm deep, %.5f mm slid, %.2f deg\n", GetParam().name,
              latest_s, most.deep_m * 1e3, most.slid_m * 1e3, most.bend_deg);
  EXPECT_LE(latest_s, 2.0);
  EXPECT_LE(most.deep_m, kDeepest_m);
  EXPECT_LE(most.slid_m, kPlanted_m);
}

// Aimed at places that its step would nearly reach, and pushed, while it walks either way.
TEST_P(ChangesOverGround, MeetsAimsAndPushesOverGround) {
  const WalkModel model = model_of(GetParam());
  Seen most;
  int taken = 0, pushed = 0;
  for (const double y : {0.6, -0.5}) {
    Watched walk(model, y > 0.0 ? 0.3 : 4.0);
    walk.walk(params_of(0.0, y), 2.0);
    for (int n = 0; n < 8; ++n) {
      walk.walk(params_of(0.0, y), 0.4);
      const Origin& origin = walk.hiker.block.origin[0];
      const double outwards = walk.hiker.block.state.right_swings != 0.0f ? -1.0 : 1.0;
      taken += walk.step_near(
          {vec3(origin.x_m + 0.2 * outwards, 0.0, origin.z_m + (y > 0.0 ? 0.35 : -0.3)), 0.0});
      walk.walk(params_of(0.0, y), 0.6);
      const double side = n % 2 == 0 ? 0.3 : -0.3;
      pushed += walk.push(vec3(side, 0.0, 0.1));
    }
    // Aimed in a step that is to end.
    walk.walk(params_of(0.0, y), 0.2);
    const Origin& origin = walk.hiker.block.origin[0];
    walk.step_near({vec3(origin.x_m, 0.0, origin.z_m + (y > 0.0 ? 0.3 : -0.3)), 0.0});
    walk.walk(GaitParams{}, 3.0);
    EXPECT_TRUE(walk.stands());
    most.deep_m = std::max(most.deep_m, walk.seen.deep_m);
    most.slid_m = std::max(most.slid_m, walk.seen.slid_m);
    most.bend_deg = std::max(most.bend_deg, walk.seen.bend_deg);
  }
  std::printf("%s: %d aims, %d pushes; %.1f mm deep, %.5f mm slid, %.2f deg\n", GetParam().name,
              taken, pushed, most.deep_m * 1e3, most.slid_m * 1e3, most.bend_deg);
  EXPECT_GE(taken, 4);
  EXPECT_GE(pushed, 6);
  EXPECT_LE(most.deep_m, kDeepest_m);
  EXPECT_LE(most.slid_m, kPlanted_m);
}

// The legs of every style that ships: they walk, stop, and walk backward.
TEST_P(ChangesOverGround, CarriesEveryStyle) {
  const WalkModel model = model_of(GetParam());
  for (const char* const name :
       {"heavy_slack", "limp_left", "limp_left_hip", "limp_left_knee", "stiff_hip", "stiff_knee",
        "tired", "tiring", "muscular", "carry", "rail_left", "stiff_arms", "look_down"}) {
    const auto style = load_style(kSourceFolder + "/config/styles/" + name + ".toml");
    ASSERT_TRUE(style) << name;
    const auto params = [&](double y) {
      Stick stick;
      stick.left = vec2(0.0, y);
      return gait_params(stick, *style, gait_limits(adult()));
    };
    Watched walk(model, 0.3);
    const auto steer = [&](double y, double seconds) { walk.walk(params(y), seconds); };
    steer(0.8, 5.0), steer(0.0, 2.0);
    EXPECT_TRUE(walk.stands()) << name;
    steer(-0.5, 3.0), steer(0.0, 2.5);
    EXPECT_TRUE(walk.stands()) << name;
    ASSERT_TRUE(std::isfinite(walk.hiker.pose.root_m.y));
    std::printf("%s %s: %.1f mm deep, %.5f mm slid, %.2f deg\n", GetParam().name, name,
                walk.seen.deep_m * 1e3, walk.seen.slid_m * 1e3, walk.seen.bend_deg);
    EXPECT_LE(walk.seen.deep_m, kDeepest_m) << name;
    EXPECT_LE(walk.seen.slid_m, kPlanted_m) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(
    OverGround, ChangesOverGround,
    testing::Values(Ground{"slope_up", {SlopeSection{40.0, 0.15, 0.5}}},
                    Ground{"slope_down", {SlopeSection{40.0, -0.15, 0.5}}},
                    Ground{"stairs_up", {FlatSection{1.0}, StairsSection{0.17, 0.28, 40}}},
                    Ground{"stairs_down", {FlatSection{1.0}, StairsSection{-0.17, 0.28, 40}}},
                    Ground{"waves", {}, 0.12}),
    [](const auto& info) { return std::string(info.param.name); });

}  // namespace
}  // namespace gaitpad

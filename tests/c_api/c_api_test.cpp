// Uses gaitpad.h as a program in C does, linked with libgaitpad.so; the core in C++ computes the
// same walks for comparison.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "gaitpad.h"

namespace {

constexpr double kStart_m[3] = {1.0, 0.0, 2.0};
constexpr double kTick_s = 1.0 / 60.0, kNan = std::numeric_limits<double>::quiet_NaN();

gaitpad_model_options defaults() {
  gaitpad_model_options options;
  gaitpad_model_defaults(&options);
  return options;
}

std::string refusal(const gaitpad_model_options& options) {
  std::array<char, 256> error = {};
  gaitpad_model* model = gaitpad_model_create(&options, error.data(), error.size());
  EXPECT_EQ(model, nullptr);
  gaitpad_model_destroy(model);
  return error.data();
}

std::string refused_start(const gaitpad_model* model, const double* place_m, double heading_rad) {
  std::array<char, 256> error = {};
  gaitpad_walk* walk = gaitpad_walk_create(model, place_m, heading_rad, error.data(), error.size());
  EXPECT_EQ(walk, nullptr);
  gaitpad_walk_destroy(walk);
  return error.data();
}

class CApi : public testing::Test {
 protected:
  CApi() { make(defaults()); }
  ~CApi() override { destroy(); }
  void make(const gaitpad_model_options& options) {
    model_ = gaitpad_model_create(&options, error_.data(), error_.size());
    walk_ =
        model_ ? gaitpad_walk_create(model_, kStart_m, 0.5, error_.data(), error_.size()) : nullptr;
    ASSERT_NE(walk_, nullptr) << error_.data();
  }
  void destroy() {
    gaitpad_walk_destroy(walk_);
    gaitpad_model_destroy(model_);
  }
  gaitpad_frame frame() const {
    gaitpad_frame f = {};
    f.size = sizeof f;
    EXPECT_TRUE(gaitpad_walk_frame(walk_, &f));
    return f;
  }
  std::vector<float> matrices() const {
    std::vector<float> m(16 * static_cast<std::size_t>(gaitpad_joint_count(model_)));
    EXPECT_EQ(gaitpad_pose_world(walk_, m.data(), gaitpad_joint_count(model_)),
              gaitpad_joint_count(model_));
    return m;
  }
  void step(double right, double forward, int ticks = 1) {
    for (int i = 0; i < ticks; ++i) gaitpad_walk_step(walk_, right, forward, kTick_s);
  }
  std::array<char, 256> error_ = {};
  gaitpad_model* model_ = nullptr;
  gaitpad_walk* walk_ = nullptr;
};

TEST_F(CApi, AWalkBeginsWhereItIsPutAndGoesAheadByTheStick) {
  gaitpad_frame f = frame();
  EXPECT_NEAR(f.root_m[0], kStart_m[0], 1e-9);
  EXPECT_NEAR(f.root_m[2], kStart_m[2], 1e-9);
  EXPECT_NEAR(f.heading_rad, 0.5, 1e-9);
  EXPECT_EQ(f.stage, GAITPAD_STANDS);
  step(0.0, 0.8, 300);
  f = frame();
  const double x = f.root_m[0] - kStart_m[0], z = f.root_m[2] - kStart_m[2];
  EXPECT_GT(std::hypot(x, z), 3.0);
  EXPECT_NEAR(std::atan2(x, z), 0.5, 0.02) << "the way that it faces";
}

TEST_F(CApi, StrikesAndRootMotionOfAllTicksAddUp) {
  gaitpad_frame f = frame();
  int strikes = 0, offs = 0;
  double x = f.root_m[0], z = f.root_m[2], heading = f.heading_rad;
  for (int tick = 0; tick < 600; ++tick) {
    step(0.4, 0.7);
    f = frame();
    strikes += f.heel_struck[0] + f.heel_struck[1];
    offs += f.toe_off[0] + f.toe_off[1];
    x += std::cos(heading) * f.root_moved_m[0] + std::sin(heading) * f.root_moved_m[2];
    z += -std::sin(heading) * f.root_moved_m[0] + std::cos(heading) * f.root_moved_m[2];
    heading += f.root_turned_rad;
  }
  EXPECT_GT(strikes, 15);
  EXPECT_EQ(strikes, f.landings[0] + f.landings[1]);
  EXPECT_LE(std::abs(strikes - offs), 1) << "each foot that lands has left the ground";
  EXPECT_NEAR(x, f.root_m[0], 1e-6);
  EXPECT_NEAR(z, f.root_m[2], 1e-6);
  EXPECT_NEAR(heading, f.heading_rad, 1e-9);
}

TEST_F(CApi, TheToeLeavesTheGroundInTheTickInWhichAFlightBegins) {
  for (const double tick_s : {1.0 / 240.0, kTick_s, 0.1}) {
    gaitpad_frame before = frame();
    for (double time_s = 0.0; time_s < 20.0; time_s += tick_s) {
      const bool goes = std::fmod(time_s, 5.0) < 3.0;
      gaitpad_walk_step(walk_, 0.0, goes ? 0.9 : 0.0, tick_s);
      const gaitpad_frame now = frame();
      for (int side = 0; side < 2; ++side) {
        const bool flies = now.stage == GAITPAD_FLIGHT && now.swing == side;
        const bool flew = before.stage == GAITPAD_FLIGHT && before.swing == side;
        EXPECT_EQ(now.toe_off[side], flies && !flew) << tick_s << " at " << time_s;
        EXPECT_EQ(now.heel_struck[side], now.landings[side] - before.landings[side]);
      }
      before = now;
    }
  }
}

TEST_F(CApi, MatricesAreTheLocalRotationsFromTheRootOn) {
  step(0.0, 0.8, 100);
  const int joints = gaitpad_joint_count(model_);
  std::vector<float> local(4 * static_cast<std::size_t>(joints));
  std::array<float, 3> root_m;
  ASSERT_EQ(gaitpad_pose_local(walk_, local.data(), joints, root_m.data()), joints);
  const std::vector<float> world = matrices();
  for (int i = 0; i < 3; ++i)
    EXPECT_EQ(world[12 + static_cast<std::size_t>(i)], root_m[static_cast<std::size_t>(i)]);
  for (int j = 0; j < joints; ++j) {
    const int parent = gaitpad_joint_parent(model_, j);
    const float* q = &local[4 * static_cast<std::size_t>(j)];
    // The x axis, turned by q, in the parent's frame.
    const float axis[] = {1 - 2 * (q[1] * q[1] + q[2] * q[2]), 2 * (q[0] * q[1] + q[3] * q[2]),
                          2 * (q[0] * q[2] - q[3] * q[1])};
    for (int row = 0; row < 3; ++row) {
      float expected = axis[row];
      if (parent >= 0) {
        const float* m = &world[16 * static_cast<std::size_t>(parent)];
        expected = m[row] * axis[0] + m[4 + row] * axis[1] + m[8 + row] * axis[2];
      }
      EXPECT_NEAR(world[16 * static_cast<std::size_t>(j) + static_cast<std::size_t>(row)], expected,
                  1e-5)
          << j;
    }
  }
}

TEST_F(CApi, ATeleportMovesTheWholePoseAndChangesNoStep) {
  step(0.0, 0.8, 100);
  const std::vector<float> before = matrices();
  const double shift_m[3] = {10.0, 0.0, -3.0};
  gaitpad_walk_move(walk_, shift_m, 0.0);
  const std::vector<float> after = matrices();
  for (std::size_t at = 12; at < after.size(); at += 16) {
    EXPECT_NEAR(after[at] - before[at], 10.0, 1e-5);
    EXPECT_NEAR(after[at + 2] - before[at + 2], -3.0, 1e-5);
  }
  const double place_m[3] = {-4.0, 0.0, 7.0};
  gaitpad_walk_put(walk_, place_m, 2.0);
  EXPECT_NEAR(frame().root_m[0], -4.0, 1e-9);
  EXPECT_NEAR(frame().heading_rad, 2.0, 1e-9);
}

TEST_F(CApi, AFootStepsToAPlaceInReach) {
  step(0.0, 0.8, 200);
  double place_m[3] = {frame().root_m[0] + 20.0, 0.0, frame().root_m[2]}, heading_rad = 0.7;
  EXPECT_FALSE(gaitpad_walk_step_to(walk_, place_m, heading_rad)) << "it is far away";
  while (!gaitpad_walk_nearest_step(walk_, place_m, &heading_rad)) step(0.0, 0.8);
  EXPECT_LT(std::abs(place_m[0] - frame().root_m[0]), 1.5);
  ASSERT_TRUE(gaitpad_walk_step_to(walk_, place_m, heading_rad));
  const gaitpad_frame asked = frame();
  gaitpad_frame f = asked;
  for (int tick = 0;
       tick < 60 && f.landings[0] + f.landings[1] == asked.landings[0] + asked.landings[1];
       ++tick) {
    step(0.0, 0.8);
    f = frame();
  }
  const int side = f.heel_struck[1];
  EXPECT_NEAR(f.heel_m[side][0], place_m[0], 1e-4);
  EXPECT_NEAR(f.heel_m[side][2], place_m[2], 1e-4);
}

TEST_F(CApi, APushMovesTheHips) {
  const double push_m_s[3] = {1.0, 0.0, 0.0}, too_hard_m_s[3] = {9.0, 0.0, 0.0};
  EXPECT_FALSE(gaitpad_walk_push(walk_, push_m_s)) << "it stands";
  step(0.0, 0.8, 250);
  const double unpushed_m = frame().root_m[0];
  destroy();
  make(defaults());
  step(0.0, 0.8, 200);
  EXPECT_FALSE(gaitpad_walk_push(walk_, too_hard_m_s));
  EXPECT_TRUE(gaitpad_walk_push(walk_, push_m_s));
  step(0.0, 0.8, 50);
  EXPECT_GT(frame().root_m[0], unpushed_m + 0.1);
}

TEST_F(CApi, ADetailChangesThePoseAndNotTheWay) {
  step(0.3, 0.8, 300);
  const gaitpad_frame full = frame();
  destroy();
  make(defaults());
  ASSERT_TRUE(gaitpad_walk_set_detail(walk_, GAITPAD_TABLES));
  EXPECT_FALSE(gaitpad_walk_set_detail(walk_, 2));
  step(0.3, 0.8, 300);
  const gaitpad_frame tables = frame();
  EXPECT_EQ(tables.bad_inputs, 0);
  EXPECT_EQ(tables.root_m[2], full.root_m[2]);
  EXPECT_NE(tables.heel_m[0][2], full.heel_m[0][2]);
}

TEST_F(CApi, EventsAreThoseOfTheFrameWithTheirPlaces) {
  std::array<gaitpad_event, GAITPAD_MOST_EVENTS> events;
  int seen[3] = {};
  for (int tick = 0; tick < 600; ++tick) {
    step(0.2, 0.8);
    const gaitpad_frame f = frame();
    int struck[2] = {}, off[2] = {};
    const int count = gaitpad_walk_events(walk_, events.data(), GAITPAD_MOST_EVENTS);
    for (int i = 0; i < count; ++i) {
      const gaitpad_event& event = events[static_cast<std::size_t>(i)];
      ++seen[event.kind];
      struck[event.side] += event.kind == GAITPAD_HEEL_STRIKE;
      off[event.side] += event.kind == GAITPAD_TOE_OFF;
      if (event.kind == GAITPAD_HEEL_STRIKE) {
        EXPECT_NEAR(event.place_m[0], f.heel_m[event.side][0], 1e-3);
        EXPECT_NEAR(event.place_m[2], f.heel_m[event.side][2], 1e-3);
      }
    }
    for (int side = 0; side < 2; ++side) {
      EXPECT_EQ(struck[side], f.heel_struck[side]);
      EXPECT_EQ(off[side], f.toe_off[side]);
    }
    EXPECT_EQ(gaitpad_walk_events(walk_, events.data(), 0), 0);
  }
  for (const int kind : seen) EXPECT_GT(kind, 12);
}

TEST_F(CApi, AWalkFollowsTheCapsuleOfAnEngine) {
  gaitpad_capsule capsule = {};
  capsule.size = sizeof capsule;
  capsule.place_m[0] = kStart_m[0], capsule.place_m[2] = kStart_m[2];
  capsule.velocity_m_s[0] = 0.6, capsule.velocity_m_s[2] = 0.8;
  for (int tick = 0; tick < 600; ++tick) {
    for (int i = 0; i < 3; ++i) capsule.place_m[i] += capsule.velocity_m_s[i] * kTick_s;
    ASSERT_TRUE(gaitpad_walk_follow(walk_, &capsule, kTick_s));
  }
  const gaitpad_frame f = frame();
  EXPECT_LT(std::hypot(f.root_m[0] - capsule.place_m[0], f.root_m[2] - capsule.place_m[2]), 0.15);
  EXPECT_EQ(f.bad_inputs, 0);
  capsule.heading_rad = kNan;
  EXPECT_TRUE(gaitpad_walk_follow(walk_, &capsule, kTick_s));
  EXPECT_GT(frame().bad_inputs, 0);
  EXPECT_GT(frame().speed_m_s, 0.5) << "it goes on";
  capsule.size = 8;
  EXPECT_FALSE(gaitpad_walk_follow(walk_, &capsule, kTick_s));
}

TEST_F(CApi, APoseIsDrawnBetweenTheLastTwoTicks) {
  step(0.0, 0.8, 99);
  const std::vector<float> before = matrices();
  step(0.0, 0.8);
  const std::vector<float> now = matrices();
  ASSERT_TRUE(gaitpad_walk_draw(walk_, 0.0));
  EXPECT_EQ(matrices(), before);
  ASSERT_TRUE(gaitpad_walk_draw(walk_, 0.5));
  const std::vector<float> between = matrices();
  for (const std::size_t axis : {12u, 13u, 14u})
    EXPECT_NEAR(between[axis], 0.5f * (before[axis] + now[axis]), 1e-6) << "the root";
  EXPECT_FALSE(gaitpad_walk_draw(walk_, kNan));
  EXPECT_EQ(matrices(), between);
  ASSERT_TRUE(gaitpad_walk_draw(walk_, 7.0));
  EXPECT_EQ(matrices(), now);
  const double place_m[3] = {50.0, 0.0, 0.0};
  gaitpad_walk_put(walk_, place_m, 0.0);
  ASSERT_TRUE(gaitpad_walk_draw(walk_, 0.5));
  EXPECT_NEAR(matrices()[12], 50.0, 0.1) << "a teleport is not drawn halfway";
  step(0.0, 0.8);
  ASSERT_TRUE(gaitpad_walk_draw(walk_, 0.5));
  EXPECT_NEAR(matrices()[12], 50.0, 0.1);
}

TEST_F(CApi, ASticksNumbersThatAreNoneAreCountedAndTheLastGoodOnesHold) {
  step(0.0, 0.8, 200);
  step(kNan, 3.0, 50);
  step(0.0, 0.8);
  const gaitpad_frame bad = frame();
  EXPECT_EQ(bad.bad_inputs, 100);
  destroy();
  make(defaults());
  step(0.0, 0.8, 251);
  EXPECT_EQ(frame().root_m[2], bad.root_m[2]);
}

TEST_F(CApi, AStyleIsSetByItsKeysWithinTheirBounds) {
  EXPECT_TRUE(gaitpad_walk_set(walk_, "left_leg.weight.knee", 0.2));
  EXPECT_FALSE(gaitpad_walk_set(walk_, "left_leg.weight.knee", 1.5));
  EXPECT_FALSE(gaitpad_walk_set(walk_, "no_such_key", 1.0));
}

TEST_F(CApi, AGroundIsAskedForItsHeight) {
  destroy();
  gaitpad_model_options options = defaults();
  const double slope = 0.1;
  options.game = &slope;
  options.ground = [](const void* game, double, double z_m) {
    return *static_cast<const double*>(game) * z_m;
  };
  make(options);
  EXPECT_NEAR(frame().heel_m[0][1], slope * frame().heel_m[0][2], 0.01);
  step(0.0, 0.8, 300);
  EXPECT_GT(frame().heel_m[0][1], 0.3) << "it has climbed";
}

TEST_F(CApi, AWalkOutlivesItsModelsHandle) {
  gaitpad_model_destroy(model_);
  model_ = nullptr;
  step(0.0, 0.8, 60);
  EXPECT_GT(frame().speed_m_s, 0.5);
}

TEST_F(CApi, AMoveThatIsNoneIsCountedAndMovesNothing) {
  const std::vector<float> before = matrices();
  const double nowhere_m[3] = {0.0, kNan, 1e7}, here_m[3] = {};
  gaitpad_walk_move(walk_, nowhere_m, 0.0);
  gaitpad_walk_put(walk_, here_m, kNan);
  gaitpad_walk_move(walk_, nullptr, 0.0);
  gaitpad_walk_put(walk_, nullptr, 0.0);
  EXPECT_EQ(frame().bad_inputs, 5);
  EXPECT_EQ(matrices(), before);
}

TEST_F(CApi, ANullHandleOrPointerIsRefused) {
  std::array<float, 16> room = {};
  gaitpad_frame f = {};
  f.size = sizeof f;
  gaitpad_model_defaults(nullptr);
  gaitpad_model_destroy(nullptr);
  gaitpad_walk_destroy(nullptr);
  gaitpad_walk_step(nullptr, 0.0, 1.0, kTick_s);
  gaitpad_walk_move(nullptr, kStart_m, 0.0);
  gaitpad_walk_put(nullptr, kStart_m, 0.0);
  EXPECT_FALSE(gaitpad_walk_step_to(nullptr, kStart_m, 0.0));
  EXPECT_FALSE(gaitpad_walk_step_to(walk_, nullptr, 0.0));
  double place_m[3] = {}, heading_rad = 0.0;
  EXPECT_FALSE(gaitpad_walk_nearest_step(nullptr, place_m, &heading_rad));
  EXPECT_FALSE(gaitpad_walk_nearest_step(walk_, nullptr, &heading_rad));
  EXPECT_FALSE(gaitpad_walk_nearest_step(walk_, place_m, nullptr));
  EXPECT_FALSE(gaitpad_walk_push(nullptr, kStart_m));
  EXPECT_FALSE(gaitpad_walk_push(walk_, nullptr));
  EXPECT_FALSE(gaitpad_walk_set_detail(nullptr, GAITPAD_FULL));
  gaitpad_capsule capsule = {};
  capsule.size = sizeof capsule;
  EXPECT_FALSE(gaitpad_walk_follow(nullptr, &capsule, kTick_s));
  EXPECT_FALSE(gaitpad_walk_follow(walk_, nullptr, kTick_s));
  gaitpad_event event;
  EXPECT_EQ(gaitpad_walk_events(nullptr, &event, 1), 0);
  EXPECT_EQ(gaitpad_walk_events(walk_, nullptr, 1), 0);
  EXPECT_FALSE(gaitpad_walk_draw(nullptr, 0.5));
  EXPECT_EQ(gaitpad_joint_count(nullptr), 0);
  EXPECT_EQ(gaitpad_joint_name(nullptr, 0), nullptr);
  EXPECT_EQ(gaitpad_joint_parent(nullptr, 0), -1);
  EXPECT_FALSE(gaitpad_walk_set(nullptr, "hip_sway", 1.0));
  EXPECT_FALSE(gaitpad_walk_set(walk_, nullptr, 1.0));
  EXPECT_FALSE(gaitpad_walk_frame(nullptr, &f));
  EXPECT_FALSE(gaitpad_walk_frame(walk_, nullptr));
  EXPECT_EQ(gaitpad_pose_local(nullptr, room.data(), 1, room.data()), 0);
  EXPECT_EQ(gaitpad_pose_local(walk_, nullptr, 1, nullptr), 0);
  EXPECT_EQ(gaitpad_pose_world(nullptr, room.data(), 1), 0);
  EXPECT_EQ(gaitpad_pose_world(walk_, nullptr, 1), 0);
  EXPECT_EQ(gaitpad_model_create(nullptr, error_.data(), error_.size()), nullptr);
  EXPECT_STREQ(error_.data(), "gaitpad_model_create: options is null");
}

TEST_F(CApi, AStartThatIsRefusedNamesTheArgumentAndItsValue) {
  struct Case {
    const gaitpad_model* model;
    const double* place_m;
    double heading_rad;
    const char* sentence;
  };
  const double nan_m[] = {kNan, 0.0, 0.0}, far_m[] = {0.0, 0.0, -2e6};
  const double infinity = std::numeric_limits<double>::infinity();
  for (const Case& c : {
           Case{nullptr, kStart_m, 0.0, "model is null"},
           Case{model_, nullptr, 0.0, "place_m is null"},
           Case{model_, nan_m, 0.0, "place_m[0] is nan, outside [-1e+06, 1e+06]"},
           Case{model_, far_m, 0.0, "place_m[2] is -2e+06, outside [-1e+06, 1e+06]"},
           Case{model_, kStart_m, infinity, "heading_rad is inf, outside [-1e+06, 1e+06]"},
       })
    EXPECT_EQ(refused_start(c.model, c.place_m, c.heading_rad),
              std::string("gaitpad_walk_create: ") + c.sentence);
}

TEST(CApiRefusals, NameTheFieldInOneSentence) {
  gaitpad_model_options options = defaults();
  options.scale = 0.0;
  EXPECT_NE(refusal(options).find("scale is 0"), std::string::npos) << refusal(options);
  options = defaults();
  options.size = 8;
  EXPECT_NE(refusal(options).find("size is 8, but the struct has "), std::string::npos);
  const gaitpad_bone hips = {"Hips", -1, 0, {0, 0, 0}};
  options = defaults();
  options.bones = &hips;
  for (const int count : {0, -1, 1'000'000}) {
    options.bone_count = count;
    EXPECT_NE(refusal(options).find("bone_count"), std::string::npos);
  }
  options.bone_count = 1;
  EXPECT_FALSE(refusal(options).empty()) << "it has no legs";
  const gaitpad_bone unnamed = {nullptr, -1, 0, {0, 0, 0}};
  options.bones = &unnamed;
  EXPECT_NE(refusal(options).find("bone 0 has no name"), std::string::npos);
}

TEST(CApiRefusals, ASentenceIsCutToTheCallersBytes) {
  gaitpad_model_options options = defaults();
  options.scale = 0.0;
  std::array<char, 8> error;
  error.fill('x');
  EXPECT_EQ(gaitpad_model_create(&options, error.data(), 5), nullptr);
  EXPECT_EQ(std::string(error.data()).size(), 4u);
  EXPECT_EQ(error[5], 'x');
  EXPECT_EQ(gaitpad_model_create(&options, nullptr, 0), nullptr);
}

TEST(CApiRefusals, AFrameOfAnUnknownSizeIsNotWritten) {
  gaitpad_frame frame = {};
  frame.size = 8;
  gaitpad_model* model = nullptr;
  const gaitpad_model_options options = defaults();
  ASSERT_NE(model = gaitpad_model_create(&options, nullptr, 0), nullptr);
  gaitpad_walk* walk = gaitpad_walk_create(model, kStart_m, 0.0, nullptr, 0);
  EXPECT_FALSE(gaitpad_walk_frame(walk, &frame));
  EXPECT_EQ(frame.landings[0], 0);
  gaitpad_walk_destroy(walk);
  gaitpad_model_destroy(model);
}

}  // namespace

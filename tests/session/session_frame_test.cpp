#include "gaitpad/session_frame.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <type_traits>

#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

// Both are copied through wait-free buffers, so they must be trivially copyable.
static_assert(std::is_trivially_copyable_v<TickSample>);

class SessionFrameTest : public testing::Test {
 protected:
  void start(int walkers) {
    config_ = made_config(walkers);
    simulation_.emplace(made_simulation(config_));
    copy_frame(*simulation_, frame_);
  }
  void step(const std::vector<Report>& reports = {}) {
    simulation_->step(reports);
    copy_frame(*simulation_, frame_);
  }

  SimulationConfig config_;
  std::optional<Simulation> simulation_;
  SessionFrame frame_;
};

TEST_F(SessionFrameTest, TheCastStandsBeforeTheFirstTick) {
  start(3);
  EXPECT_EQ(frame_.tick, -1);
  EXPECT_EQ(frame_.walker_count, 3);
  EXPECT_EQ(frame_.pad.device, 0) << "the pad is plugged in from the start";
  EXPECT_EQ(frame_.pad.reports, 0u);
  for (int i = 0; i < 3; ++i) {
    const WalkerFrame& w = frame_.walkers[i];
    EXPECT_EQ(w.presence, 0.0);
    EXPECT_EQ(w.walk.stage, Stage::idle);
  }
}

TEST_F(SessionFrameTest, HoldsTheStateAfterATickAndThePoseBefore) {
  start(2);
  step({made_report(0x80, 0x20)});
  for (int tick = 1; tick < 600; ++tick) {
    const Pose last = frame_.walkers[1].pose;
    step();
    ASSERT_EQ(frame_.tick, tick);
    ASSERT_EQ(frame_.walkers[1].before.root_m, last.root_m);
    ASSERT_EQ(frame_.walkers[1].before.local[5], last.local[5]);
  }
  EXPECT_EQ(frame_.stick.left, simulation_->stick().left);
  EXPECT_EQ(frame_.walkers[1].pose.root_m, simulation_->walkers()[1].pose.root_m);
  EXPECT_EQ(frame_.walkers[1].style_index, 1);
  EXPECT_TRUE(frame_.walkers[1].style == made_limp());
  EXPECT_GT(frame_.walkers[0].presence, 0.99);
  EXPECT_EQ(frame_.counts.ticks, 600);
}

// A walk counts in its own coordinates; a frame has world coordinates.
TEST_F(SessionFrameTest, FeetOfAMovedWalkAreInTheWorld) {
  start(1);
  step({made_report(0x60, 0x10)});
  // No session moves its walkers yet, so the test changes its own simulation.
  auto& walker = const_cast<Walker&>(simulation_->walkers().front());
  const Placement by{vec3(30.0, 0.0, -20.0), 1.2};
  for (int tick = 1; tick < 600; ++tick) step();
  const WalkerFrame before = frame_.walkers[0];
  move_walk(by, walker.state, walker.pose);
  copy_frame(*simulation_, frame_);
  const WalkerFrame& after = frame_.walkers[0];
  // Through another root's rotation, whose length is 1 to the rounding of floats.
  for (const Side side : {kLeftSide, kRightSide})
    EXPECT_LT(glm::distance(after.walk.heel_m[side], to_world(by, before.walk.heel_m[side])), 5e-7);
}

TEST_F(SessionFrameTest, ThePhaseStartsAtTheRightHeelStrike) {
  start(1);
  step({made_report(0x80, 0x00)});
  double before = 0.0;
  for (int tick = 1; tick < 1500; ++tick) {
    const bool had_landed = frame_.walkers[0].walk.stage == Stage::roll;
    step();
    const WalkerFrame& w = frame_.walkers[0];
    ASSERT_GE(w.phase, 0.0);
    ASSERT_LE(w.phase, 1.0);
    const bool strikes = !had_landed && w.walk.stage == Stage::roll && w.walk.swing == kRightSide;
    if (strikes) {
      EXPECT_LT(w.phase, 0.02);
    }
    // While a walk starts, the phase follows hips that stand between the feet. Until the step has
    // some length they have no certain phase, so it may fall, but almost none of it is shown.
    constexpr double kHardlyShown = 0.02;
    if (!strikes && w.presence > kHardlyShown && w.phase < before) {
      EXPECT_GT(before, 0.98) << tick;
    }
    before = w.phase;
  }
}

TEST_F(SessionFrameTest, KnowsTheDrivingPad) {
  start(1);
  Report pressed = made_report(0x80, 0x20);
  pressed.bytes[4] = 0x18;
  step({made_report(0x80, 0x20), pressed, made_report(0x80, 0x20), pressed});
  EXPECT_EQ(frame_.pad.device, 0);
  EXPECT_TRUE(frame_.pad.is_present);
  EXPECT_EQ(frame_.pad.reports, 4u);
  EXPECT_TRUE(frame_.pad.calibration == config_.pads[0].calibration);
  EXPECT_GT(frame_.pad.state.axis[kLeftY], 0.7f);
  std::uint32_t presses = 0;
  for (const std::uint32_t n : frame_.presses) presses += n;
  EXPECT_EQ(presses, 2u);
  step({made_plug(ReportKind::removed)});
  EXPECT_FALSE(frame_.pad.is_present);
}

TEST_F(SessionFrameTest, CommandsShowInTheFrame) {
  start(2);
  step({made_command("set 2 fatigue 0.5"), made_command("gait 1 speed_m_s 1")});
  EXPECT_EQ(frame_.walkers[1].style.fatigue, 0.5);
  EXPECT_TRUE(frame_.walkers[0].overrides.is_set[static_cast<int>(GaitKey::speed_m_s)]);
  EXPECT_NEAR(value_of(GaitKey::speed_m_s, frame_.walkers[0].params), 1.0, 1e-12);
}

TEST_F(SessionFrameTest, TheCastDescribesTheSession) {
  start(2);
  const Cast cast = cast_of(*simulation_, config_);
  ASSERT_EQ(cast.members.size(), 2u);
  EXPECT_EQ(cast.members[1].style, "limp");
  EXPECT_EQ(cast.members[1].model, simulation_->walkers()[1].model);
  EXPECT_EQ(cast.styles, (std::vector<std::string>{"even", "limp"}));
  EXPECT_EQ(cast.source->skeleton.joints.size(), config_.cycle.skeleton.joints.size());
}

// Flexion is positive in all samples. A knee never bends forward; hip and ankle bend both ways.
TEST_F(SessionFrameTest, SamplesHoldFlexionAndPlants) {
  start(1);
  TickSample sample;
  simulation_->step(std::vector<Report>{made_report(0x80, 0x10)});
  double knee_rad = 0.0, hip_min_rad = 1.0, hip_max_rad = -1.0;
  for (int tick = 1; tick < 1200; ++tick) {
    simulation_->step({});
    copy_sample(*simulation_, sample);
    ASSERT_EQ(sample.tick, tick);
    const WalkerSample& w = sample.walkers[0];
    ASSERT_GE(w.joint_rad[kLeftSide][1], -0.01f);
    knee_rad = std::max<double>(knee_rad, w.joint_rad[kLeftSide][1]);
    hip_min_rad = std::min<double>(hip_min_rad, w.joint_rad[kLeftSide][0]);
    hip_max_rad = std::max<double>(hip_max_rad, w.joint_rad[kLeftSide][0]);
    // A swinging heel is in the air.
    if (w.stage == Stage::flight) {
      ASSERT_FALSE(w.heel_planted[w.swing]);
    }
  }
  EXPECT_GT(knee_rad, 0.7);
  EXPECT_GT(hip_max_rad, 0.3);
  EXPECT_LT(hip_min_rad, -0.05);
}

}  // namespace
}  // namespace gaitpad

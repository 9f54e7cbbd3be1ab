#include "gaitpad/simulation.h"

#include <gtest/gtest.h>

#include "gaitpad/gait_cycle.h"
#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

TEST(Simulation, StandsWithoutAReport) {
  Simulation s = made_simulation(made_config(1));
  step(s, {}, 480);
  EXPECT_EQ(s.walkers()[0].state.frame.stage, Stage::idle);
  EXPECT_EQ(s.walkers()[0].state.frame.speed_m_s, 0.0);
}

TEST(Simulation, AForwardStickWalksStraight) {
  const Simulation s = walked(made_config(1), 0x80, 0x00, 960);
  const WalkFrame& frame = s.walkers()[0].state.frame;
  EXPECT_GT(frame.pelvis_m.z, 3.0);
  EXPECT_EQ(frame.heading_rad, 0.0);
}

TEST(Simulation, UnpluggingFinishesTheStepAndStands) {
  Simulation s = walked(made_config(1), 0x80, 0x00, 700);
  step(s, {made_plug(ReportKind::removed)}, 480);
  EXPECT_EQ(s.walkers()[0].state.frame.stage, Stage::idle);
  EXPECT_EQ(s.stick().left, vec2(0.0));
}

// A character in a T pose, half as large again, under the procedural walk.
TEST(Simulation, ACharacterWalksOnTheSkeletonThatItBrings) {
  SimulationConfig config = made_config(1);
  config.walkers[0].character = {};
  config.walkers[0].character.skeleton = "giant.bvh";
  Motion giant = procedural_motion();
  giant.frames.resize(1);
  for (Joint& joint : giant.skeleton.joints) joint.offset_m *= 1.5;
  auto own = cycle_on_skeleton(config.cycle, giant);
  ASSERT_TRUE(own) << own.error().message;
  config.walkers[0].own_cycle = *own;
  const Simulation s = walked(config, 0x80, 0x10, 1200);
  const Walker& w = s.walkers()[0];
  EXPECT_EQ(w.ik_failures, 0);
  EXPECT_NEAR(w.model->leg_length_m, 1.5 * w.model->source_leg_length_m, 1e-9);
  EXPECT_GT(w.state.frame.pelvis_m.z, 4.0);
}

TEST(Simulation, OneGroundForAllGrowsWithTheLongestFoot) {
  SimulationConfig config = made_config(2);
  auto stairs = std::make_shared<Terrain>();
  ASSERT_FALSE(add_section(*stairs, FlatSection{2.0}));
  ASSERT_FALSE(add_section(*stairs, StairsSection{0.17, 0.28, 3}));
  config.terrain = stairs;
  config.walkers[1].character.leg_ratio = 0.8;
  Simulation s = made_simulation(config);
  EXPECT_EQ(s.terrain_scale(), 1.0);
  EXPECT_EQ(s.terrain(), config.terrain);
  config.walkers[1].character.leg_ratio = 1.5;
  s = made_simulation(config);
  EXPECT_NEAR(s.terrain_scale(), s.walkers()[1].model->leg_length_m / kReferenceLeg_m, 1e-12);
  EXPECT_NEAR(least_tread_m(*s.terrain()), 0.28 * s.terrain_scale(), 1e-12);
  for (const Walker& w : s.walkers()) EXPECT_EQ(w.model->terrain, s.terrain());
}

TEST(Simulation, CharactersBeginOnTheGroundThatIsThere) {
  SimulationConfig config = made_config(2);
  auto step_up = std::make_shared<Terrain>();
  ASSERT_FALSE(add_section(*step_up, StairsSection{0.2, 2.0, 1}));  // its line is z = 0
  config.terrain = step_up;
  const Simulation s = made_simulation(config);
  for (const Walker& w : s.walkers()) EXPECT_EQ(w.start_m.y, 0.2);
}

TEST(Simulation, CharactersStandSideBySideAndDoNotDisturbEachOther) {
  Simulation one = walked(made_config(1), 0x90, 0x20, 480);
  Simulation three = walked(made_config(3), 0x90, 0x20, 480);
  const auto pelvis = [](const Simulation& s, int i) {
    return s.walkers()[i].state.frame.pelvis_m;
  };
  EXPECT_EQ(pelvis(one, 0), pelvis(three, 0));
  Simulation standing = made_simulation(made_config(3));
  EXPECT_NEAR(pelvis(standing, 0).x - pelvis(standing, 1).x, 1.2, 1e-9);
  EXPECT_NEAR(pelvis(standing, 1).x - pelvis(standing, 2).x, 1.2, 1e-9);
}

TEST(Simulation, AMirroredStickMirrorsTheHeadingAtEveryTick) {
  Simulation left = made_simulation(made_config(1)), right = made_simulation(made_config(1));
  // 8-bit counts have no middle: 0x00 and 0xff mirror each other about 127.5.
  for (int tick = 0; tick < 1920; ++tick) {
    std::vector<Report> to_left, to_right;
    if (tick == 0) to_left = {made_report(0x40, 0x20)}, to_right = {made_report(0xbf, 0x20)};
    if (tick == 900) to_left = {made_report(0x00, 0x70)}, to_right = {made_report(0xff, 0x70)};
    left.step(to_left);
    right.step(to_right);
    const WalkFrame& l = left.walkers()[0].state.frame;
    const WalkFrame& r = right.walkers()[0].state.frame;
    ASSERT_EQ(left.stick().left.x, -right.stick().left.x);
    ASSERT_NEAR(l.heading_rad, -r.heading_rad, 1e-12) << "tick " << tick;
  }
  EXPECT_GT(left.walkers()[0].state.frame.heading_rad, 1.0);
}

TEST(Simulation, ACopyGoesItsOwnWayAndSharesWhatStandsStill) {
  Simulation s = walked(made_config(4), 0x80, 0x20, 333), copy = s;
  EXPECT_EQ(&s.styles(), &copy.styles());
  EXPECT_EQ(s.walkers()[3].model, copy.walkers()[3].model);
  step(s, {made_report(0x20, 0x00)}, 100);
  const std::uint64_t hash = s.pose_hash();
  step(copy, {made_report(0x80, 0x80)}, 100);
  EXPECT_NE(copy.pose_hash(), hash);
  Simulation again = walked(made_config(4), 0x80, 0x20, 333);
  copy = again;
  step(copy, {made_report(0x20, 0x00)}, 100);
  EXPECT_EQ(copy.pose_hash(), hash);
}

TEST(Simulation, BadReportsAreCountedAndChangeNothing) {
  Simulation sound = walked(made_config(1), 0x80, 0x20, 300);
  Simulation s = made_simulation(made_config(1));
  Report cut = made_report(0xff, 0xff);
  cut.size = 2;
  step(s, {made_report(0x80, 0x20), cut, made_report(0, 0, 7)}, 300);
  EXPECT_EQ(s.counts().reports, 3);
  EXPECT_EQ(s.counts().bad_reports, 2);
  EXPECT_EQ(s.pose_hash(), sound.pose_hash());
}

TEST(Simulation, TheHashTellsOneStickCountApart) {
  const SimulationConfig config = made_config(1);
  EXPECT_EQ(walked(config, 0x80, 0x20, 400).pose_hash(),
            walked(config, 0x80, 0x20, 400).pose_hash());
  EXPECT_NE(walked(config, 0x80, 0x20, 400).pose_hash(),
            walked(config, 0x80, 0x21, 400).pose_hash());
}

// Two pads that come and go, the second one held, resting and driving in between; bad reports and
// a device that is no pad.
std::vector<Report> plugging_tick(int tick) {
  switch (tick) {
    case 30:
      return {made_plug(ReportKind::added, 0), made_report(0x80, 0x20, 0)};
    case 100:
      return {made_plug(ReportKind::added, 1), made_report(0x80, 0x10, 1)};
    case 120:
      return {made_plug(ReportKind::added, 2), made_report(0x20, 0x00, 2), made_report(0, 0, 9)};
    case 500:
      return {made_plug(ReportKind::removed, 1)};
    case 560:
      return {made_report(0x30, 0x20, 2)};
    case 600:
      return {made_plug(ReportKind::added, 1), made_report(0x80, 0x80, 1), made_report(0, 0, 0)};
    case 620:
      return {made_plug(ReportKind::removed, 1), made_report(0x80, 0x80, 2)};
    case 640:
      return {made_report(0x30, 0x00, 2), made_plug(ReportKind::added, 1)};
    case 900:
      return {made_report(0x80, 0x80, 1), made_plug(ReportKind::removed, 2),
              made_report(0x80, 0x10, 1)};
    default:
      return {};
  }
}

std::vector<PadConfig> plugged_pads() {
  std::vector<PadConfig> pads(3, made_pad_config());
  pads[0].is_usable = false;
  pads[2].streams = true;
  for (PadConfig& pad : pads) pad.is_present = false;
  return pads;
}

TEST(Simulation, PadsThatArriveLaterWalkAsIfTheyHadBeenKnownFromTheStart) {
  SimulationConfig known = made_config(2), unknown = known;
  known.pads = plugged_pads();
  unknown.pads = unknown_pads(16);
  Simulation replay = made_simulation(known), live = made_simulation(unknown);
  std::vector<PadConfig> found = plugged_pads();
  std::vector<bool> is_set(found.size(), false);
  for (int tick = 0; tick < 1400; ++tick) {
    const std::vector<Report> reports = plugging_tick(tick);
    for (const Report& r : reports) {
      if (r.kind != ReportKind::added || is_set[r.device]) continue;
      live.set_pad(r.device, std::move(found[r.device]));
      is_set[r.device] = true;
    }
    replay.step(reports);
    live.step(reports);
    ASSERT_EQ(live.pads().driving(), replay.pads().driving()) << "tick " << tick;
    ASSERT_EQ(live.stick().left, replay.stick().left) << "tick " << tick;
  }
  EXPECT_EQ(live.pose_hash(), replay.pose_hash());
  EXPECT_EQ(live.counts().bad_reports, replay.counts().bad_reports);
  EXPECT_EQ(live.pads().driving(), 1);
  EXPECT_GT(live.walkers()[0].state.frame.steps[kLeftSide], 3);
}

TEST(Simulation, AHeelStrikesOnceAStep) {
  Simulation s = made_simulation(made_config(2));
  int strikes = 0;
  Stage before = Stage::idle;
  s.step(std::vector<Report>{made_report(0x80, 0x00)});
  for (int tick = 1; tick < 1200; ++tick) {
    if (tick == 900) s.step(std::vector<Report>{made_report(0x80, 0x80)});
    s.step({});
    const WalkFrame& frame = s.walkers()[0].state.frame;
    EXPECT_EQ(s.heel_struck(), before == Stage::flight && frame.stage == Stage::roll);
    strikes += s.heel_struck();
    before = frame.stage;
  }
  const WalkFrame& frame = s.walkers()[0].state.frame;
  EXPECT_EQ(frame.stage, Stage::idle);
  EXPECT_EQ(strikes, frame.steps[kLeftSide] + frame.steps[kRightSide]);
  EXPECT_GT(strikes, 6);
}

TEST(Simulation, RefusesNoCharacterAndTooMany) {
  EXPECT_FALSE(Simulation::create(made_config(0)));
  SimulationConfig crowd = made_config(1);
  crowd.walkers.resize(kMaxWalkers + 1);
  EXPECT_FALSE(Simulation::create(crowd));
}

}  // namespace
}  // namespace gaitpad

#include "gaitpad/simulation.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "gaitpad/config_files.h"
#include "gaitpad/gait_cycle.h"
#include "tests/folders.h"
#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

TEST(Simulation, StandsWithoutAReport) {
  Simulation s = made_simulation(made_config(1));
  step(s, {}, 480);
  EXPECT_EQ(walk_steps(s.walkers()[0].state).stage, Stage::idle);
  EXPECT_EQ(walk_frame(s.walkers()[0]).speed_m_s, 0.0);
}

TEST(Simulation, AForwardStickWalksStraight) {
  const Simulation s = walked(made_config(1), 0x80, 0x00, 960);
  const WalkFrame frame = walk_frame(s.walkers()[0]);
  EXPECT_GT(frame.pelvis_m.z, 3.0);
  EXPECT_EQ(frame.heading_rad, 0.0);
}

// The stick points for a camera that looks along +z, and for one that looks to the left.
TEST(Simulation, AStickThatPointsLeadsThereWhereverTheCharacterFaces) {
  struct Case {
    int x, y;
    const char* command;
    double heading_deg;
  };
  for (const Case& c :
       {Case{0xff, 0x80, "stick points", -90.0}, Case{0x00, 0x00, "stick points", 45.0},
        Case{0x80, 0xff, "stick points", 180.0}, Case{0x80, 0x00, "stick points 90", 90.0}}) {
    Simulation s = made_simulation(made_config(1));
    step(s, {made_command(c.command)});
    step(s, {made_report(c.x, c.y)}, 5 * 240);
    const vec3 from_m = walk_frame(s.walkers()[0]).pelvis_m;
    step(s, {}, 240);
    const WalkFrame frame = walk_frame(s.walkers()[0]);
    const SinCos aim = sin_cos(c.heading_deg * kPi / 180.0);
    const vec3 way_m = frame.pelvis_m - from_m;
    EXPECT_GT(way_m.x * aim.sin + way_m.z * aim.cos, 1.0) << c.command << " " << c.x << " " << c.y;
    EXPECT_LT(std::abs(way_m.x * aim.cos - way_m.z * aim.sin), 0.05) << c.command;
    EXPECT_GT(sin_cos(frame.heading_rad - c.heading_deg * kPi / 180.0).cos, 0.999) << c.command;
    step(s, {made_command("stick steers")});
    EXPECT_EQ(s.stick_means(), StickMeans::steers);
  }
}

TEST(Simulation, UnpluggingFinishesTheStepAndStands) {
  Simulation s = walked(made_config(1), 0x80, 0x00, 700);
  step(s, {made_plug(ReportKind::removed)}, 480);
  EXPECT_EQ(walk_steps(s.walkers()[0].state).stage, Stage::idle);
  EXPECT_EQ(s.stick().left, vec2(0.0));
}

// A character with its own skeleton, in a T pose and 1.5 times as large, walks the procedural walk.
TEST(Simulation, ACharacterWalksOnTheSkeletonThatItBrings) {
  SimulationConfig config = made_config(1);
  config.walkers[0].character = {};
  config.walkers[0].character.skeleton = "giant.bvh";
  Motion giant = procedural_motion();
  giant.frames.resize(1);
  for (Joint& joint : giant.skeleton.joints) joint.offset_m *= 1.5;
  auto own = cycle_on_skeleton(config.cycle, giant);
  ASSERT_TRUE(own) << own.error().message;
  config.walkers[0].own_cycle = clean_cycle(*own);
  const Simulation s = walked(config, 0x80, 0x10, 1200);
  const Walker& w = s.walkers()[0];
  EXPECT_EQ(w.ik_failures, 0);
  EXPECT_NEAR(w.model->leg_length_m, 1.5 * w.model->source_leg_length_m, 1e-9);
  EXPECT_GT(walk_frame(w).pelvis_m.z, 4.0);
}

TEST(Simulation, AConfigurationThatCannotRunIsRefusedWithOneSentence) {
  const auto said_of = [](const auto& spoil) {
    SimulationConfig config = made_config(2);
    spoil(config);
    const auto simulation = Simulation::create(config);
    return simulation ? "" : simulation.error().message;
  };
  using Config = SimulationConfig;
  EXPECT_EQ(said_of([](Config&) {}), "");
  EXPECT_EQ(said_of([](Config& c) { c.styles.clear(); }),
            "SimulationConfig: styles is empty, one is needed");
  EXPECT_EQ(said_of([](Config& c) { c.walkers[1].style = 5; }),
            "SimulationConfig: walkers[1].style is 5, outside [0, 1]");
  EXPECT_EQ(said_of([](Config& c) { c.walkers[0].style = -1; }),
            "SimulationConfig: walkers[0].style is -1, outside [0, 1]");
  for (const int rate_hz : {0, -60, 1, 1'000'000}) {
    EXPECT_NE(said_of([&](Config& c) { c.rate_hz = rate_hz; }).find("rate_hz is "),
              std::string::npos)
        << rate_hz;
  }
  EXPECT_EQ(said_of([](Config& c) { c.styles[1].hip_sway = -2.0; }),
            "style \"limp\": StyleValues: hip_sway is -2, outside [0, 3]");
  EXPECT_EQ(said_of([](Config& c) { c.terrain = nullptr; }),
            "SimulationConfig: terrain is null, see flat_terrain()");
  EXPECT_EQ(said_of([](Config& c) { c.pads.at(0).calibration.left.outer = 0.2; }),
            "SimulationConfig: pads[0]: Calibration: left.outer - inner is 0, outside [0.05, 1]");
  EXPECT_EQ(said_of([](Config& c) { c.walkers.clear(); }), "0 characters: 1 to 16 can walk");
  EXPECT_EQ(said_of([](Config& c) { c.walkers[0].character.scale = 0.0; }),
            "as in the motion file: scale is 0, outside [0.05, 20]");
  EXPECT_EQ(
      said_of([](Config& c) {
        Terrain torn;
        add_section(torn, FlatSection{2.0});
        add_section(torn, FlatSection{2.0});
        torn.sections[1].begin_m = 3.0;
        c.terrain = std::make_shared<const Terrain>(torn);
      }),
      "flat: sections[1] does not begin where the one before ends: lay it with add_section()");
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

TEST(Simulation, CharactersStartOnTheGround) {
  SimulationConfig config = made_config(2);
  auto step_up = std::make_shared<Terrain>();
  ASSERT_FALSE(add_section(*step_up, StairsSection{0.2, 2.0, 1}));  // a step whose edge is at z = 0
  config.terrain = step_up;
  const Simulation s = made_simulation(config);
  for (const Walker& w : s.walkers()) EXPECT_EQ(w.start_m.y, 0.2);
}

TEST(Simulation, CharactersStandSideBySideAndDoNotDisturbEachOther) {
  Simulation one = walked(made_config(1), 0x90, 0x20, 480);
  Simulation three = walked(made_config(3), 0x90, 0x20, 480);
  const auto pelvis = [](const Simulation& s, int i) {
    return walk_frame(s.walkers()[i]).pelvis_m;
  };
  EXPECT_EQ(pelvis(one, 0), pelvis(three, 0));
  Simulation standing = made_simulation(made_config(3));
  EXPECT_NEAR(pelvis(standing, 0).x - pelvis(standing, 1).x, 1.2, 1e-9);
  EXPECT_NEAR(pelvis(standing, 1).x - pelvis(standing, 2).x, 1.2, 1e-9);
}

TEST(Simulation, ACopyIsIndependentAndSharesTheModel) {
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

TEST(Simulation, TheHashDiffersForOneStickCount) {
  const SimulationConfig config = made_config(1);
  EXPECT_EQ(walked(config, 0x80, 0x20, 400).pose_hash(),
            walked(config, 0x80, 0x20, 400).pose_hash());
  EXPECT_NE(walked(config, 0x80, 0x20, 400).pose_hash(),
            walked(config, 0x80, 0x21, 400).pose_hash());
}

// The reports of a tick: two pads are plugged in and out; the second one is held, rests and drives
// meanwhile. There are bad reports, and reports of a device that is not a pad.
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

TEST(Simulation, PadsAddedLaterGiveTheSameWalkAsPadsKnownFromTheStart) {
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
  EXPECT_GT(walk_steps(live.walkers()[0].state).steps[kLeftSide], 3);
}

TEST(Simulation, AHeelStrikesOnceAStep) {
  Simulation s = made_simulation(made_config(2));
  int strikes = 0;
  Stage before = Stage::idle;
  s.step(std::vector<Report>{made_report(0x80, 0x00)});
  for (int tick = 1; tick < 1200; ++tick) {
    if (tick == 900) s.step(std::vector<Report>{made_report(0x80, 0x80)});
    s.step({});
    const WalkFrame frame = walk_frame(s.walkers()[0]);
    EXPECT_EQ(s.heel_struck(), before == Stage::flight && frame.stage == Stage::roll);
    strikes += s.heel_struck();
    before = frame.stage;
  }
  const WalkFrame frame = walk_frame(s.walkers()[0]);
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

// Commands at any time of a walk.

TEST(Simulation, AStyleCommandIsForAllOrForOneAndUnknownOnesAreCounted) {
  Simulation s = made_simulation(made_config(3));
  const auto style = [&s](int i) { return s.styles()[s.walkers()[i].style].name; };
  step(s, {made_command("style limp")});
  EXPECT_EQ(style(0) + style(1) + style(2), "limplimplimp");
  step(s, {made_command("style 2 even")});
  EXPECT_EQ(style(0) + style(1) + style(2), "limpevenlimp");
  EXPECT_EQ(s.counts().bad_commands, 0);
  const char* const bad[] = {
      "",          "style",        "style none",    "style 0 even",     "style 4 even",
      "sing even", "style x even", "style -1 even", "style 1 even now", "style 1"};
  for (const char* text : bad) step(s, {made_command(text)});
  EXPECT_EQ(s.counts().bad_commands, 10);
  EXPECT_EQ(s.counts().commands, 12);
  EXPECT_EQ(style(0) + style(1) + style(2), "limpevenlimp");
}

TEST(Simulation, ASetCommandChangesAStyleValueUntilTheNextStyle) {
  Simulation s = made_simulation(made_config(3));
  step(s, {made_command("set fatigue 0.5"), made_command("set 3 left_leg.stride_length 0.25")});
  EXPECT_EQ(s.counts().bad_commands, 0);
  for (const Walker& w : s.walkers()) EXPECT_EQ(w.values.fatigue, 0.5);
  EXPECT_EQ(s.walkers()[0].values.stride[kLeftSide].length, 1.0);
  EXPECT_EQ(s.walkers()[2].values.stride[kLeftSide].length, 0.25);
  EXPECT_EQ(s.walkers()[2].style, 0) << "it is still the same style, with a changed value";
  step(s, {made_command("style 3 limp")});
  EXPECT_TRUE(s.walkers()[2].values == made_limp());
  EXPECT_EQ(s.walkers()[0].values.fatigue, 0.5);
}

TEST(Simulation, AGaitCommandOverridesAParameterUntilItIsReturnedToTheStick) {
  Simulation s = made_simulation(made_config(2));
  step(s, {made_command("gait 2 speed_m_s 1"), made_command("gait hip_sway 0.5")}, 1200);
  EXPECT_EQ(walk_steps(s.walkers()[0].state).stage, Stage::idle);
  // Not exactly 1 m/s: a stage lasts a whole number of ticks, and a cycle has only some hundred.
  EXPECT_NEAR(walk_frame(s.walkers()[1]).speed_m_s, 1.0, 0.01);
  EXPECT_EQ(s.walkers()[0].params.hip_sway, 0.5);
  step(s, {made_command("gait 2 speed_m_s stick")}, 480);
  EXPECT_EQ(walk_steps(s.walkers()[1].state).stage, Stage::idle);
  EXPECT_EQ(s.walkers()[1].params.hip_sway, 0.5);
  step(s, {made_command("gait stick")});
  EXPECT_EQ(s.walkers()[0].params.hip_sway, 1.0);
  EXPECT_EQ(s.walkers()[1].params.hip_sway, 1.0);
  EXPECT_EQ(s.counts().bad_commands, 0);
}

TEST(Simulation, AResetRestoresTheStart) {
  const SimulationConfig config = made_config(3);
  const Simulation fresh = walked(config, 0x60, 0x00, 600);
  Simulation s = made_simulation(config);
  step(s,
       {made_report(0x90, 0x10), made_command("gait 1 hip_sway 2"), made_command("style 1 limp"),
        made_command("set 2 fatigue 1")},
       777);
  const std::array<int, 2> steps = walk_steps(s.walkers()[0].state).steps;
  const double walked_m = s.walkers()[0].walked_m;
  EXPECT_GT(walked_m, 1.0);
  // A reset keeps the chosen style, so the first walker's initial style is chosen first.
  step(s, {made_command("style 1 even"), made_report(0x60, 0x00), made_command("reset")}, 600);
  for (std::size_t i = 0; i < 3; ++i) {
    const Walker &w = s.walkers()[i], &f = fresh.walkers()[i];
    EXPECT_EQ(w.state.root.place_m, f.state.root.place_m) << i;
    EXPECT_EQ(w.state.root.heading_rad, f.state.root.heading_rad) << i;
    for (int j = 0; j < w.pose.joint_count; ++j) ASSERT_EQ(w.pose.local[j], f.pose.local[j]);
    EXPECT_EQ(w.overrides.is_set, GaitOverrides().is_set);
    EXPECT_TRUE(w.values == s.styles()[w.style]);
  }
  EXPECT_EQ(walk_steps(s.walkers()[0].state).steps[kLeftSide],
            steps[kLeftSide] + walk_steps(fresh.walkers()[0].state).steps[kLeftSide])
      << "a reset does not reset the count of steps";
  EXPECT_NEAR(s.walkers()[0].walked_m, walked_m + fresh.walkers()[0].walked_m, 1e-9)
      << "the jump back to the start is not walked";
}

TEST(Simulation, AResetKeepsTheChosenStyleAndDropsItsChanges) {
  Simulation s = made_simulation(made_config(1));
  step(s, {made_command("style limp"), made_command("set hip_sway 3"), made_command("reset")});
  EXPECT_EQ(s.styles()[s.walkers()[0].style].name, "limp");
  EXPECT_TRUE(s.walkers()[0].values == made_limp());
}

TEST(Simulation, AnInvalidCommandChangesNothing) {
  const char* const bad[] = {"set arms 1",          "set fatigue 1.01",      "set 4 fatigue 0.5",
                             "set fatigue -0.01",   "set fatigue nan",       "set fatigue",
                             "gait speed 1",        "gait speed_m_s 1e9",    "gait speed_m_s -1e9",
                             "gait 4 speed_m_s 1",  "gait wings stick",      "gait 4 stick",
                             "gait hip_sway three", "gait 2 hip_sway 3.001", "reset 1"};
  Simulation s = made_simulation(made_config(3));
  for (const char* text : bad) step(s, {made_command(text)});
  EXPECT_EQ(s.counts().bad_commands, static_cast<std::int64_t>(std::size(bad)));
  for (const Walker& w : s.walkers()) {
    EXPECT_TRUE(w.values == s.styles()[w.style]);
    EXPECT_EQ(w.overrides.is_set, GaitOverrides().is_set);
  }
}

// The command would lock the second walker's leg, so it is applied to neither of them.
TEST(Simulation, ASetCommandAppliesToAllOrToNone) {
  Simulation s = made_simulation(made_config(3));
  step(s, {made_command("set 2 legs.weight.hip 0"), made_command("set 2 legs.weight.knee 0"),
           made_command("set legs.weight.ankle 0")});
  EXPECT_EQ(s.counts().bad_commands, 1);
  for (const Walker& w : s.walkers()) EXPECT_EQ(w.values.weight[kLeftSide][kAnkleX], 1.0);
}

std::string any_value(std::mt19937& random, double min, double max) {
  return fmt::format("{}", mix(min, max, static_cast<double>(random() % 9) / 8.0));
}

std::string any_gait_command(std::mt19937& random) {
  const std::string who = random() % 2 == 0 ? "1 " : "";
  if (random() % 12 == 0) return "gait " + who + "stick";
  const GaitKeyInfo& key = info_of(static_cast<GaitKey>(random() % kGaitKeys));
  return fmt::format("gait {}{} {}", who, key.name,
                     any_value(random, std::max(key.min, -2.0), std::min(key.max, 2.0)));
}

std::string any_command(std::mt19937& random) {
  const std::string who = random() % 2 == 0 ? "1 " : "";
  const StyleKey& key = style_keys()[random() % style_keys().size()];
  switch (random() % 12) {
    case 0:
      return random() % 4 == 0 ? "reset" : "style " + who + "even";
    case 1:
    case 2:
    case 3:
      return fmt::format("set {}{} {}", who, key.name, any_value(random, key.min, key.max));
    default:
      return any_gait_command(random);
  }
}

// Sends a random command every quarter of a second and a random stick every two seconds; `check`
// gets each walker in each tick.
template <class Check>
void walk_at_random(IkMode mode, std::string (*command)(std::mt19937&), const Check& check,
                    unsigned seed = 11, int ticks = 12000) {
  std::mt19937 random(seed);
  SimulationConfig config = made_config(2);
  config.walkers[1].style = 0;
  config.ik = mode;
  Simulation s = made_simulation(config);
  for (int tick = 0; tick < ticks; ++tick) {
    std::vector<Report> reports;
    if (tick % 60 == 0) reports.push_back(made_command(command(random)));
    if (tick % 500 == 0) {
      const auto x = random() % 256;
      reports.push_back(made_report(x, random() % 256));
    }
    s.step(reports);
    for (const Walker& w : s.walkers()) {
      check(w);
      if (testing::Test::HasFailure()) FAIL() << "seed " << seed << ", tick " << tick;
    }
  }
  EXPECT_LT(s.counts().bad_commands, s.counts().commands / 10)
      << "only commands that would lock a leg are refused";
}

// Commands change parameters abruptly in mid-step, which a stick cannot do. A foot may lag by 0.15
// m where one leg has to stop while the other takes its longest step, or has to turn at once.
TEST(Simulation, LegsFollowRandomGaitCommands) {
  walk_at_random(IkMode::robust, any_gait_command, [](const Walker& w) {
    EXPECT_GT(walk_frame(w).pelvis_m.y, 0.45 * w.model->stand_m);
    for (const Side side : {kLeftSide, kRightSide}) {
      EXPECT_GT(walk_frame(w).heel_m[side].y, -0.02);
      EXPECT_LT(walk_frame(w).ik_error_m[side], 0.16);
    }
  });
}

TEST(Simulation, RandomCommandsKeepThePoseValid) {
  for (const IkMode mode : {IkMode::robust, IkMode::paper}) {
    walk_at_random(mode, any_command, [](const Walker& w) {
      // Low, because a random style may bounce three times as far.
      EXPECT_GT(walk_frame(w).pelvis_m.y, 0.3 * w.model->stand_m);
      EXPECT_LT(walk_frame(w).pelvis_m.y, 1.15 * w.model->stand_m);
      // Joints are unit quaternions of floats.
      for (int j = 0; j < w.pose.joint_count; ++j)
        ASSERT_NEAR(glm::length(w.pose.local[j]), 1.0, 4e-7);
    });
  }
}

// A regression: when a stop was planned while the hips moved back, they continued for 0.8 m and
// dived below the floor. In 17 a style that lifts the feet goes as the last foot flies, which
// jumped by 0.16 m.
TEST(Simulation, NoCommandsMakeTheHipsDive) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const auto check = [](const Walker& w) {
      EXPECT_GT(walk_frame(w).pelvis_m.y, 0.5 * w.model->stand_m);
    };
    walk_at_random(IkMode::robust, any_command, check, seed, 5000);
  }
}

TEST(Simulation, AMarkDoesNothing) {
  const SimulationConfig config = made_config(1);
  Simulation marked = made_simulation(config);
  marked.step(std::vector<Report>{made_command("mark"), made_report(0x80, 0x20)});
  for (int tick = 1; tick < 400; ++tick) marked.step({});
  EXPECT_EQ(marked.pose_hash(), walked(config, 0x80, 0x20, 400).pose_hash());
  EXPECT_EQ(marked.counts().bad_commands, 0);
}

// Effects that follow from the state: zones of the terrain, fatigue, blending.

TerrainZone zone(double from_m, double to_m, const std::string& style) {
  TerrainZone zone;
  zone.from_m = from_m, zone.to_m = to_m, zone.style = style;
  return zone;
}

// A session with the style `limp` in zones: z from 2 to 4 m at any x, and z from 6 to 8 m only
// where x is above -0.5 m.
SimulationConfig zoned(int walkers = 1) {
  SimulationConfig config = made_config(walkers);
  for (WalkerConfig& w : config.walkers) w.style = 0, w.character.leg_ratio = 1.0;
  config.styles.emplace_back().name = "slow";
  config.styles[2].fatigue = 0.5;
  auto terrain = std::make_shared<Terrain>();
  terrain->zones = {zone(2.0, 4.0, "limp"), zone(6.0, 8.0, "limp")};
  terrain->zones[1].right_m = -0.5;
  config.terrain = terrain;
  return config;
}

void walk_to(Simulation& s, double z_m) {
  s.take_report(made_report(0x80, 0x00));
  for (int k = 0; k < 10000 && s.walkers()[0].state.root.place_m.z < z_m; ++k) s.step({});
  EXPECT_GE(s.walkers()[0].state.root.place_m.z, z_m);
}
std::string style_of(const Simulation& s, int walker = 0) {
  return s.styles()[s.walkers()[walker].style].name;
}

TEST(Zones, ApplyTheirStyleOnlyInside) {
  Simulation s = made_simulation(zoned());
  walk_to(s, 1.9);
  EXPECT_EQ(style_of(s), "even");
  walk_to(s, 2.1);
  EXPECT_EQ(style_of(s), "limp");
  EXPECT_TRUE(s.walkers()[0].in_force == s.styles()[1]);
  walk_to(s, 4.1);
  EXPECT_EQ(style_of(s), "even");
  EXPECT_TRUE(s.walkers()[0].in_force == s.styles()[0]);
}

TEST(Zones, ApplyToEachWalkerByItsOwnPlace) {
  // At x = -1.2 the second walker is outside of the second zone.
  Simulation s = made_simulation(zoned(2));
  walk_to(s, 7.0);
  EXPECT_EQ(style_of(s, 0), "limp");
  EXPECT_EQ(style_of(s, 1), "even");
}

TEST(Zones, RestoreTheValuesSetBeforeThem) {
  Simulation s = made_simulation(zoned());
  s.take_report(made_command("set hip_sway 2"));
  walk_to(s, 3.0);
  EXPECT_EQ(s.walkers()[0].values.hip_sway, 1.0);
  // Changes the style that the zone gave, and only that.
  s.take_report(made_command("set hip_sway 0.5"));
  EXPECT_EQ(s.walkers()[0].values.hip_sway, 0.5);
  walk_to(s, 4.1);
  EXPECT_EQ(s.walkers()[0].values.hip_sway, 2.0);
}

TEST(Zones, AChosenStyleWinsAndStays) {
  Simulation s = made_simulation(zoned());
  walk_to(s, 3.0);
  s.take_report(made_command("style slow"));
  walk_to(s, 3.5);
  EXPECT_EQ(style_of(s), "slow");
  walk_to(s, 4.2);
  EXPECT_EQ(style_of(s), "slow");
  walk_to(s, 7.0);  // walks on to the next zone
  EXPECT_EQ(style_of(s), "limp");
  walk_to(s, 8.2);
  EXPECT_EQ(style_of(s), "slow");
}

TEST(Zones, AResetLeavesThemWithTheChosenStyle) {
  Simulation s = made_simulation(zoned());
  walk_to(s, 3.0);
  s.step(std::vector{made_report(0x80, 0x80), made_command("reset")});
  EXPECT_EQ(style_of(s), "even");
  EXPECT_TRUE(s.walkers()[0].in_force == s.styles()[0]);
  walk_to(s, 3.0);
  EXPECT_EQ(style_of(s), "limp");
}

TEST(Zones, TheLastOfOverlappingOnesWins) {
  SimulationConfig config = zoned();
  auto terrain = std::make_shared<Terrain>(*config.terrain);
  terrain->zones.push_back(zone(3.0, 5.0, "slow"));
  config.terrain = terrain;
  Simulation s = made_simulation(config);
  walk_to(s, 2.5);
  EXPECT_EQ(style_of(s), "limp");
  walk_to(s, 3.5);
  EXPECT_EQ(style_of(s), "slow");
  walk_to(s, 5.2);
  EXPECT_EQ(style_of(s), "even");
}

TEST(Zones, AnUnknownStyleIsNamedWithFileAndLine) {
  SimulationConfig config = zoned();
  auto terrain = std::make_shared<Terrain>();
  terrain->zones = {zone(0.0, 1.0, "strut")};
  terrain->zones[0].where = "a.toml:7";
  config.terrain = terrain;
  const auto simulation = Simulation::create(config);
  ASSERT_FALSE(simulation);
  EXPECT_EQ(simulation.error().message, "a.toml:7: there is no style \"strut\"");
}

TEST(Zones, BlendOverTheTimeOfTheStyle) {
  SimulationConfig config = zoned();
  config.styles[1].blend_s = 0.5;
  Simulation s = made_simulation(config);
  walk_to(s, 1.9);
  double before = 1.0;
  int ticks = 0;
  while (!(s.walkers()[0].in_force == s.styles()[1]) && ticks < 2000) {
    s.step({});
    const double now = s.walkers()[0].in_force.stride[kLeftSide].length;
    EXPECT_LT(std::abs(now - before), 0.5 * 1.6 / 120.0);
    before = now;
    ticks += s.walkers()[0].style == 1;
  }
  EXPECT_NEAR(ticks, 120, 1);
  walk_to(s, 4.02);
  const double length = s.walkers()[0].in_force.stride[kLeftSide].length;
  EXPECT_GT(length, 0.5);
  EXPECT_LT(length, 1.0);  // the way back to the own style is blended as well
}

TEST(Tiring, SlowsAWalkWithDistanceAndRecoversAtRest) {
  SimulationConfig config = made_config(1);
  config.styles[0].fatigue_per_100_m = 4.0;
  config.styles[0].fatigue_recovery_per_s = 0.05;
  Simulation s = made_simulation(config);
  walk_to(s, 4.0);
  const double fresh_m_s = walk_frame(s.walkers()[0]).speed_m_s;
  walk_to(s, 15.0);
  const Walker& w = s.walkers()[0];
  EXPECT_NEAR(w.in_force.fatigue, std::min(w.walked_m * 0.04, 1.0), 1e-3);
  EXPECT_LT(walk_frame(w).speed_m_s, 0.85 * fresh_m_s);
  s.take_report(made_report(0x80, 0x80));
  for (int k = 0; k < 480; ++k) s.step({});
  const double tired = w.tired;
  EXPECT_EQ(walk_steps(w.state).stage, Stage::idle);
  for (int k = 0; k < 480; ++k) s.step({});
  EXPECT_NEAR(w.tired, tired - 0.1, 1e-9);
  s.step(std::vector{made_command("reset")});
  EXPECT_LT(w.tired, 1e-9);
}

// RMS difference in degrees of the left leg's angles in two runs of a walk, tick by tick.
double difference_deg(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size())) / kDegree;
}

TEST(Builds, ChangeTheKneeAngle) {
  const auto knee_of = [](const std::string& name) {
    SimulationConfig config = made_config(1);
    auto style = load_style(kSourceFolder + "/config/styles/" + name + ".toml");
    EXPECT_TRUE(style) << style.error().message;
    config.styles[0] = *style;
    Simulation s = made_simulation(config);
    walk_to(s, 3.0);
    std::vector<double> knee_rad;
    for (int k = 0; k < 720; ++k) {
      s.step({});
      knee_rad.push_back(leg_angles(*s.walkers()[0].model, s.walkers()[0].pose)[kLeftSide][kKneeX]);
    }
    EXPECT_EQ(s.walkers()[0].ik_failures, 0);
    return knee_rad;
  };
  const auto even = knee_of("even"), heavy = knee_of("heavy_slack"), strong = knee_of("muscular");
  EXPECT_GT(difference_deg(heavy, even), 3.0);
  EXPECT_GT(difference_deg(strong, even), 1.0);
  EXPECT_GT(difference_deg(heavy, strong), 2.5);
}

TEST(Tiring, AStyleWithoutAModelDoesNotTire) {
  Simulation s = made_simulation(made_config(1));
  walk_to(s, 6.0);
  EXPECT_EQ(s.walkers()[0].tired, 0.0);
  EXPECT_TRUE(s.walkers()[0].in_force == s.styles()[0]);
}

}  // namespace
}  // namespace gaitpad

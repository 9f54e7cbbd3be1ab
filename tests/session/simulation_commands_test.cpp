// What commands do to a session that walks, whatever they are and whenever they come.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

TEST(Simulation, AStyleCommandIsForAllOrForOneAndWhatIsUnknownIsCounted) {
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
  EXPECT_EQ(s.walkers()[2].style, 0) << "it is still that style, changed";
  step(s, {made_command("style 3 limp")});
  EXPECT_TRUE(s.walkers()[2].values == made_limp());
  EXPECT_EQ(s.walkers()[0].values.fatigue, 0.5);
}

TEST(Simulation, AGaitCommandTakesAParameterFromTheStickAndGivesItBack) {
  Simulation s = made_simulation(made_config(2));
  step(s, {made_command("gait 2 speed_m_s 1"), made_command("gait hip_sway 0.5")}, 1200);
  EXPECT_EQ(s.walkers()[0].state.frame.stage, Stage::idle);
  // Stages are whole ticks, of some hundred in a cycle.
  EXPECT_NEAR(s.walkers()[1].state.frame.speed_m_s, 1.0, 0.01);
  EXPECT_EQ(s.walkers()[0].params.hip_sway, 0.5);
  step(s, {made_command("gait 2 speed_m_s stick")}, 480);
  EXPECT_EQ(s.walkers()[1].state.frame.stage, Stage::idle);
  EXPECT_EQ(s.walkers()[1].params.hip_sway, 0.5);
  step(s, {made_command("gait stick")});
  EXPECT_EQ(s.walkers()[0].params.hip_sway, 1.0);
  EXPECT_EQ(s.walkers()[1].params.hip_sway, 1.0);
  EXPECT_EQ(s.counts().bad_commands, 0);
}

TEST(Simulation, AResetIsTheBeginningAgain) {
  const SimulationConfig config = made_config(3);
  const Simulation fresh = walked(config, 0x60, 0x00, 600);
  Simulation s = made_simulation(config);
  step(s,
       {made_report(0x90, 0x10), made_command("gait 1 hip_sway 2"), made_command("style 1 limp"),
        made_command("set 2 fatigue 1")},
       777);
  const std::array<int, 2> steps = s.walkers()[0].state.frame.steps;
  const double walked_m = s.walkers()[0].walked_m;
  EXPECT_GT(walked_m, 1.0);
  // The first one's style stays as chosen: it is no other than at the beginning for the others.
  step(s, {made_command("style 1 even"), made_report(0x60, 0x00), made_command("reset")}, 600);
  for (std::size_t i = 0; i < 3; ++i) {
    const Walker &w = s.walkers()[i], &f = fresh.walkers()[i];
    EXPECT_EQ(w.state.hips_m, f.state.hips_m) << i;
    EXPECT_EQ(w.state.heading_rad, f.state.heading_rad) << i;
    for (int j = 0; j < w.pose.joint_count; ++j) ASSERT_EQ(w.pose.local[j], f.pose.local[j]);
    EXPECT_EQ(w.overrides.is_set, GaitOverrides().is_set);
    EXPECT_TRUE(w.values == s.styles()[w.style]);
  }
  EXPECT_EQ(s.walkers()[0].state.frame.steps[kLeftSide],
            steps[kLeftSide] + fresh.walkers()[0].state.frame.steps[kLeftSide])
      << "steps are counted on";
  EXPECT_NEAR(s.walkers()[0].walked_m, walked_m + fresh.walkers()[0].walked_m, 1e-9)
      << "the way back is no walk";
}

TEST(Simulation, AResetKeepsTheStyleThatWasChosenAndDropsItsChanges) {
  Simulation s = made_simulation(made_config(1));
  step(s, {made_command("style limp"), made_command("set hip_sway 3"), made_command("reset")});
  EXPECT_EQ(s.styles()[s.walkers()[0].style].name, "limp");
  EXPECT_TRUE(s.walkers()[0].values == made_limp());
}

TEST(Simulation, ACommandThatCannotBeObeyedChangesNothing) {
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

// The second one's leg would be locked, so the others keep theirs, too.
TEST(Simulation, ASetCommandIsObeyedByAllOrByNone) {
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

// Every quarter of a second a command, every two seconds another stick; `check` sees each walker.
template <class Check>
void walk_at_random(IkMode mode, std::string (*command)(std::mt19937&), const Check& check) {
  std::mt19937 random(11);
  SimulationConfig config = made_config(2);
  config.walkers[1].style = 0;
  config.ik = mode;
  Simulation s = made_simulation(config);
  for (int tick = 0; tick < 40000; ++tick) {
    std::vector<Report> reports;
    if (tick % 60 == 0) reports.push_back(made_command(command(random)));
    if (tick % 500 == 0) reports.push_back(made_report(random() % 256, random() % 256));
    s.step(reports);
    for (const Walker& w : s.walkers()) {
      check(w);
      if (testing::Test::HasFailure()) FAIL() << "tick " << tick;
    }
  }
  EXPECT_LT(s.counts().bad_commands, s.counts().commands / 10) << "a leg is not locked";
}

// All at once and in the middle of a step, which no stick can do: a lunge, some
// centimetres, no more.
TEST(Simulation, WhateverParametersAreTakenOverTheLegsFollow) {
  walk_at_random(IkMode::robust, any_gait_command, [](const Walker& w) {
    EXPECT_GT(w.state.frame.pelvis_m.y, 0.45 * w.model->stand_m);
    for (const Side side : {kLeftSide, kRightSide}) {
      EXPECT_GT(w.state.frame.heel_m[side].y, -0.02);
      EXPECT_LT(w.state.frame.ik_error_m[side], 0.05);
    }
  });
}

TEST(Simulation, WhateverIsChangedThePoseIsAPose) {
  for (const IkMode mode : {IkMode::robust, IkMode::paper}) {
    walk_at_random(mode, any_command, [](const Walker& w) {
      EXPECT_GT(w.state.frame.pelvis_m.y, 0.3 * w.model->stand_m);
      EXPECT_LT(w.state.frame.pelvis_m.y, 1.15 * w.model->stand_m);
      for (int j = 0; j < w.pose.joint_count; ++j)
        ASSERT_NEAR(glm::length(w.pose.local[j]), 1.0, 1e-9);
    });
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

}  // namespace
}  // namespace gaitpad

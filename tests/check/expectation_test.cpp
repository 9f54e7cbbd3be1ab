#include "check/expectation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

constexpr const char* kWhole = R"(# Walks around the hall.
# Kept by hand.
pose_hash = "0123456789abcdef"
keep_poses = false
ticks = 480
bad_reports = 0

[replay]
motion = "walks/slow.bvh"
pace = "adult"
character = ["child", "own/tall.toml"]
style = ["limp_left"]
crowd = 3
terrain = "stairs"
script = "turn.toml"
ik = "paper"
calibration = "worn.toml"
rate = 120
lenient = true

[[character]]
steps_left = 4
speed_m_s = { value = 1.25, within = 0.05 }

[[character]]
distance_m = { value = 3, within = 0.5 }
)";

std::string refusal(const std::string& text) {
  const auto read = parsed_expectation(text, "x.expect.toml");
  return read ? "none" : read.error().message;
}

TEST(RunMeter, ASlipThatIsNotANumberStays) {
  const double no_number = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(worse_slip_m(0.001, 0.002), 0.002);
  EXPECT_EQ(worse_slip_m(0.002, 0.001), 0.002);
  EXPECT_TRUE(std::isnan(worse_slip_m(0.002, no_number)));
  EXPECT_TRUE(std::isnan(worse_slip_m(no_number, 0.001)));
}

TEST(Expectation, HoldsOptionsHashCountsAndNumbers) {
  const Expectation e = value_of(parsed_expectation(kWhole, "x"));
  EXPECT_EQ(e.heading, "# Walks around the hall.\n# Kept by hand.\n");
  EXPECT_EQ(e.pose_hash, 0x0123456789abcdefu);
  EXPECT_FALSE(e.keeps_poses);
  ASSERT_EQ(e.run.size(), 2u);
  EXPECT_EQ(kOfRun[e.run[0].measure].name, "ticks");
  EXPECT_EQ(e.run[0].value, 480);
  EXPECT_EQ(e.walk.pace, Pace::adult);
  EXPECT_EQ(e.walk.crowd, 3);
  EXPECT_EQ(e.walk.ik, IkMode::paper);
  EXPECT_EQ(e.rate_hz, 120);
  EXPECT_TRUE(e.is_lenient);
  ASSERT_EQ(e.characters.size(), 2u);
  EXPECT_EQ(e.characters[0][1].value, 1.25);
  EXPECT_EQ(e.characters[0][1].within, 0.05);
  EXPECT_EQ(e.characters[1][0].value, 3);
}

TEST(Expectation, IsWrittenAsItWasRead) {
  const Expectation e = value_of(parsed_expectation(kWhole, "x"));
  const std::string text = expectation_text(e);
  EXPECT_EQ(expectation_text(value_of(parsed_expectation(text, "x"))), text);
  for (const char* line : {"# Kept by hand.\n", "pose_hash = \"0123456789abcdef\"\n",
                           "character = [\"child\", \"own/tall.toml\"]\n", "crowd = 3\n",
                           "speed_m_s = { value = 1.25, within = 0.05 }\n", "lenient = true\n"})
    EXPECT_NE(text.find(line), text.npos) << line << text;
}

TEST(Expectation, PathsAreRelativeToItsFolderAndNamesAreNot) {
  const SessionSpec spec =
      session_of(value_of(parsed_expectation(kWhole, "x")), "out/walks", "out/walks/a.hid");
  EXPECT_EQ(spec.walk.motion, "out/walks/walks/slow.bvh");
  EXPECT_EQ(spec.walk.characters, (std::vector<std::string>{"child", "out/walks/own/tall.toml"}));
  EXPECT_EQ(spec.walk.terrain, "stairs");
  EXPECT_EQ(spec.walk.script, "out/walks/turn.toml");
  EXPECT_EQ(spec.pad.calibration, "out/walks/worn.toml");
  EXPECT_EQ(spec.pad.map, "");
  EXPECT_EQ(spec.replay.trace, "out/walks/a.hid");
  EXPECT_EQ(spec.replay.damage, Damage::skip);
}

TEST(Expectation, WhatIsWrongIsNamedWithItsLine) {
  EXPECT_EQ(refusal("pose_hsh = \"0123456789abcdef\"\n").substr(0, 42),
            "x.expect.toml:1: unknown key \"pose_hsh\"; d");
  for (const auto& [text, cause] : {
           std::pair("pose_hash = \"0123\"\n", "x.expect.toml:1: \"0123\" is not 16 hexadecimal"),
           {"pose_hash = \"0123456789abcdeg\"\n", "x.expect.toml:1: "},
           {"\nticks = 1.5\n", "x.expect.toml:2: "},
           {"ticks = -1\n", "x.expect.toml:1: "},
           {"[replay]\npace = \"fast\"\n", "x.expect.toml:2: \"fast\" is no pace"},
           {"[replay]\nik = \"best\"\n", "x.expect.toml:2: \"best\" is neither"},
           {"[replay]\nrate = 0\n", "x.expect.toml:2: "},
           {"[replay]\nout = \"folder\"\n", "x.expect.toml:2: unknown key"},
           {"[[character]]\nspeed_m_s = 1.5\n", "x.expect.toml:2: "},
           {"[[character]]\nspeed_m_s = { value = 1 }\n", "x.expect.toml:2: "},
           {"[[character]]\nspeed_m_s = { value = 1, within = -1 }\n", "x.expect.toml:2: "},
           {"[[character]]\nspeed_m_s = { value = nan, within = 1 }\n", "x.expect.toml:2: "},
           {"[[character]]\nsteps_left = { value = 1, within = 1 }\n", "x.expect.toml:2: "},
           {"ticks = \n", "x.expect.toml:1: "},
       }) {
    EXPECT_EQ(refusal(text).substr(0, std::string_view(cause).size()), cause) << text;
  }
}

TEST(Expectation, NumbersAreMetWithinTheirToleranceAndCountsExactly) {
  const Expectation e = value_of(parsed_expectation(kWhole, "x"));
  Measured measured;
  measured.run[kTicks] = 480;
  measured.characters.resize(2);
  measured.characters[0][kStepsLeft] = 4;
  measured.characters[0][kSpeed] = 1.2999;
  measured.characters[1][kDistance] = 2.5001;
  EXPECT_EQ(unmet_numbers(e, measured), std::vector<std::string>());
  measured.run[kTicks] = 481;
  measured.characters[0][kSpeed] = 1.31;
  measured.characters[1][kDistance] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(unmet_numbers(e, measured),
            (std::vector<std::string>{"ticks is 481, expected 480",
                                      "character 1: speed_m_s is 1.31, expected 1.25 within 0.05",
                                      "character 2: distance_m is nan, expected 3 within 0.5"}));
  measured.characters.resize(1);
  EXPECT_EQ(unmet_numbers(e, measured).back(), "character 2 is expected and does not walk");
}

TEST(Expectation, RenewingKeepsOptionsTolerancesAndWhatIsLeftOut) {
  const Expectation before = value_of(parsed_expectation(kWhole, "x"));
  Measured measured;
  measured.pose_hash = 0xfedcba9876543210u;
  measured.run[kTicks] = 500;
  measured.characters.resize(2);
  measured.characters[0][kSpeed] = 2.0 / 3.0;
  const Expectation after = renewed(before, measured);
  EXPECT_EQ(after.walk.motion, before.walk.motion);
  ASSERT_EQ(after.characters[0].size(), 2u);
  EXPECT_EQ(after.characters[0][1].value, 0.666667);
  EXPECT_EQ(after.characters[0][1].within, 0.05);
  EXPECT_EQ(unmet_numbers(after, measured), std::vector<std::string>());
  const auto changed = changes(before, after);
  EXPECT_EQ(changed.front(), "pose_hash: 0123456789abcdef -> fedcba9876543210");
  EXPECT_NE(std::ranges::find(changed, "character 1: speed_m_s: 1.25 -> 0.666667"), changed.end());
  EXPECT_TRUE(changes(after, after).empty());
}

TEST(Expectation, RenewingNothingExpectsEverything) {
  Measured measured;
  measured.characters.resize(1);
  measured.characters[0][kDistance] = 100.0;
  const Expectation e = renewed(Expectation{}, measured);
  EXPECT_TRUE(e.pose_hash);
  EXPECT_EQ(e.run.size(), kOfRun.size());
  ASSERT_EQ(e.characters.size(), 1u);
  ASSERT_EQ(e.characters[0].size(), kOfCharacter.size());
  EXPECT_EQ(e.characters[0][kDistance].within, 1.0) << "a hundredth";
  EXPECT_EQ(e.characters[0][kSpeed].within, 0.02) << "at least";
  EXPECT_EQ(e.characters[0][kStepsLeft].within, 0.0) << "a count";
}

TEST(RunMeter, MeasuresWhatThePosesShow) {
  Simulation simulation = made_simulation(made_config(2));
  RunMeter meter;
  constexpr int kTicks_ = 1200;
  std::array<double, 2> way_m{}, moving_ticks{};
  std::array<vec3, 2> last_m;
  for (int i = 0; i < 2; ++i) last_m[i] = simulation.walkers()[i].state.root.place_m;
  for (int tick = 0; tick < kTicks_; ++tick) {
    const auto reports = tick == 120 ? std::vector{made_report(0x80, 0x10)} : std::vector<Report>();
    simulation.step(reports);
    meter.look(simulation);
    for (int i = 0; i < 2; ++i) {
      const Walker& walker = simulation.walkers()[i];
      const vec3 step_m = walker.state.root.place_m - last_m[i];
      way_m[i] += std::hypot(step_m.x, step_m.z);
      last_m[i] = walker.state.root.place_m;
      moving_ticks[i] += walk_steps(walker.state).stage != Stage::idle;
    }
  }
  const SimulationConfig config = made_config(2);
  const RunSummary summary = run_summary(simulation, cast_of(simulation, config));
  const Measured measured = meter.finish(simulation, summary);
  EXPECT_EQ(measured.pose_hash, simulation.pose_hash());
  EXPECT_EQ(measured.run[kTicks], kTicks_);
  EXPECT_EQ(measured.run[kReports], 1);
  ASSERT_EQ(measured.characters.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    const auto& m = measured.characters[i];
    const WalkFrame frame = walk_frame(simulation.walkers()[i]);
    EXPECT_NEAR(m[kDistance], way_m[i], 1e-9);
    EXPECT_NEAR(m[kSpeed], way_m[i] / (moving_ticks[i] / 240.0), 1e-9);
    EXPECT_EQ(m[kStepsLeft], frame.steps[kLeftSide]);
    EXPECT_NEAR(m[kEndZ], frame.pelvis_m.z, 1e-12);
    EXPECT_LT(m[kSlip], 1e-5) << "planted feet do not slide on level ground";
    EXPECT_GT(m[kKneeLeft], 30.0) << "a knee bends by more in a walk";
    EXPECT_LT(m[kKneeLeft], 120.0);
  }
  EXPECT_NEAR(measured.characters[0][kStepLeft], measured.characters[0][kStepRight], 0.05);
  EXPECT_LT(measured.characters[1][kStepLeft], 0.8 * measured.characters[1][kStepRight])
      << "the limp's left step is half as long";
}

}  // namespace
}  // namespace gaitpad

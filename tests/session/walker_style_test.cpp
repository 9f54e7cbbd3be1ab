// What follows from the state itself: zones of the terrain, tiring, blending. Walked in a session.
#include <gtest/gtest.h>

#include "gaitpad/config_files.h"
#include "gaitpad/simulation.h"
#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

TerrainZone zone(double from_m, double to_m, const std::string& style) {
  TerrainZone zone;
  zone.from_m = from_m, zone.to_m = to_m, zone.style = style;
  return zone;
}

// Zones of the style `limp`: z from 2 to 4 m everywhere; from 6 to 8 m for who walks left of x =
// -0.5.
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
  for (int k = 0; k < 10000 && s.walkers()[0].state.hips_m.z < z_m; ++k) s.step({});
  EXPECT_GE(s.walkers()[0].state.hips_m.z, z_m);
}
std::string style_of(const Simulation& s, int walker = 0) {
  return s.styles()[s.walkers()[walker].style].name;
}

TEST(Zones, GiveTheirStyleAndTakeItBack) {
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

TEST(Zones, CountForEachWalkerByItsOwnPlace) {
  Simulation s = made_simulation(zoned(2));  // the second one walks at x = -1.2
  walk_to(s, 7.0);
  EXPECT_EQ(style_of(s, 0), "limp");
  EXPECT_EQ(style_of(s, 1), "even");
}

TEST(Zones, BringBackWhatWasChangedBeforeThem) {
  Simulation s = made_simulation(zoned());
  s.take_report(made_command("set hip_sway 2"));
  walk_to(s, 3.0);
  EXPECT_EQ(s.walkers()[0].values.hip_sway, 1.0);
  s.take_report(made_command("set hip_sway 0.5"));  // of the zone's style: gone with it
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
  walk_to(s, 7.0);  // the next zone is another
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

TEST(Zones, OverlappingOnesTheLastCounts) {
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

TEST(Zones, AStyleThatIsNotThereIsNamedWithItsPlace) {
  SimulationConfig config = zoned();
  auto terrain = std::make_shared<Terrain>();
  terrain->zones = {zone(0.0, 1.0, "strut")};
  terrain->zones[0].where = "a.toml:7";
  config.terrain = terrain;
  const auto simulation = Simulation::create(config);
  ASSERT_FALSE(simulation);
  EXPECT_EQ(simulation.error().message, "a.toml:7: there is no style \"strut\"");
}

TEST(Zones, BlendInTheTimeOfTheStyle) {
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
  EXPECT_LT(length, 1.0);  // on the way back, too
}

TEST(Tiring, SlowsAWalkWithItsWayAndRestHelps) {
  SimulationConfig config = made_config(1);
  config.styles[0].fatigue_per_100_m = 4.0;
  config.styles[0].fatigue_recovery_per_s = 0.05;
  Simulation s = made_simulation(config);
  walk_to(s, 4.0);
  const double fresh_m_s = s.walkers()[0].state.frame.speed_m_s;
  walk_to(s, 15.0);
  const Walker& w = s.walkers()[0];
  EXPECT_NEAR(w.in_force.fatigue, std::min(w.walked_m * 0.04, 1.0), 1e-3);
  EXPECT_LT(w.state.frame.speed_m_s, 0.85 * fresh_m_s);
  s.take_report(made_report(0x80, 0x80));
  for (int k = 0; k < 480; ++k) s.step({});
  const double tired = w.tired;
  EXPECT_EQ(w.state.frame.stage, Stage::idle);
  for (int k = 0; k < 480; ++k) s.step({});
  EXPECT_NEAR(w.tired, tired - 0.1, 1e-9);
  s.step(std::vector{made_command("reset")});
  EXPECT_LT(w.tired, 1e-9);
}

// Mean square difference of the left leg's angles at the same ticks of the same walk, degrees.
double difference_deg(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum / static_cast<double>(a.size())) / kDegree;
}

TEST(Builds, AreSeenInTheKnee) {
  const auto knee_of = [](const std::string& name) {
    SimulationConfig config = made_config(1);
    auto style = load_style(GAITPAD_SOURCE_DIR "/config/styles/" + name + ".toml");
    EXPECT_TRUE(style) << style.error().message;
    config.styles[0] = *style;
    Simulation s = made_simulation(config);
    walk_to(s, 3.0);
    std::vector<double> knee_rad;
    for (int k = 0; k < 720; ++k) {
      s.step({});
      knee_rad.push_back(s.walkers()[0].state.angles_rad[kLeftSide][kKneeX]);
    }
    EXPECT_EQ(s.walkers()[0].ik_failures, 0);
    return knee_rad;
  };
  const auto even = knee_of("even"), heavy = knee_of("heavy_slack"), strong = knee_of("muscular");
  EXPECT_GT(difference_deg(heavy, even), 3.0);
  EXPECT_GT(difference_deg(strong, even), 1.0);
  EXPECT_GT(difference_deg(heavy, strong), 2.5);
}

TEST(Tiring, AStyleWithoutAModelWalksAsEver) {
  Simulation s = made_simulation(made_config(1));
  walk_to(s, 6.0);
  EXPECT_EQ(s.walkers()[0].tired, 0.0);
  EXPECT_TRUE(s.walkers()[0].in_force == s.styles()[0]);
}

}  // namespace
}  // namespace gaitpad

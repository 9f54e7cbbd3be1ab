// The files of config/ load, and hold the numbers that they promise.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "files/keyframe.h"
#include "gaitpad/calibration.h"
#include "gaitpad/config_files.h"
#include "gaitpad/gait_cycle.h"
#include "gaitpad/style.h"
#include "gaitpad/walk_model.h"
#include "tests/folders.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

const std::string kConfig = kSourceFolder + "/config/";

Style style(const std::string& name) {
  const Style style = value_of(load_style(kConfig + "styles/" + name + ".toml"));
  EXPECT_EQ(style.name, name);
  return style;
}
Character character(const std::string& name) {
  return value_of(load_character(kConfig + "characters/" + name + ".toml"));
}
std::string weights_of(const Style& s, Side side) {
  std::string text;
  for (double w : s.weight[side]) text += std::to_string(w).substr(0, 3) + " ";
  return text;
}
constexpr const char* kEven = "1.0 1.0 1.0 1.0 1.0 1.0 1.0 ";
constexpr const char* kHip = "0.2 0.2 0.2 1.0 1.0 1.0 1.0 ";
constexpr const char* kKnee = "1.0 1.0 1.0 0.8 1.0 1.0 1.0 ";

TEST(ShippedStyles, EveryFileLoads) {
  for (const auto& entry : std::filesystem::directory_iterator(kConfig + "styles")) {
    style(entry.path().stem().string());
  }
}

TEST(ShippedMotions, EveryFileWalks) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kConfig + "motions")) {
    auto file = TomlFile::load(entry.path().string());
    ASSERT_TRUE(file) << file.error().message;
    ASSERT_TRUE(is_keyframe_file(*file)) << entry.path();
    const auto motion = keyframe_motion(*file);
    ASSERT_TRUE(motion) << motion.error().message;
    const auto cycle = gait_cycle(*motion);
    EXPECT_TRUE(cycle) << cycle.error().message;
    ++files;
  }
  EXPECT_GE(files, 1);
}

// Fig. 5a: red 1, green hip -80 %, blue knee -20 %.
TEST(ShippedStyles, WeightsOfFigure5a) {
  for (const Side side : {kLeftSide, kRightSide}) {
    EXPECT_EQ(weights_of(style("even"), side), kEven);
    EXPECT_EQ(weights_of(style("stiff_hip"), side), kHip);
    EXPECT_EQ(weights_of(style("stiff_knee"), side), kKnee);
  }
}

// Fig. 5b: left stride length -50 %, flight height -50 %, speed +30 %, weights on the left leg
// only.
TEST(ShippedStyles, FactorsAndWeightsOfFigure5b) {
  for (const auto& [name, left] : {std::pair("limp_left", kEven), std::pair("limp_left_hip", kHip),
                                   std::pair("limp_left_knee", kKnee)}) {
    const Style limp = style(name);
    EXPECT_EQ(limp.stride[kLeftSide].length, 0.5);
    EXPECT_EQ(limp.stride[kLeftSide].speed, 1.3);
    EXPECT_EQ(limp.stride[kLeftSide].flight_height, 0.5);
    EXPECT_EQ(limp.stride[kRightSide].length, 1.0);
    EXPECT_EQ(limp.stride[kRightSide].speed, 1.0);
    EXPECT_EQ(limp.stride[kRightSide].flight_height, 1.0);
    EXPECT_EQ(weights_of(limp, kLeftSide), left);
    EXPECT_EQ(weights_of(limp, kRightSide), kEven);
    EXPECT_EQ(limp.fatigue, 0.0);
  }
}

// Section 3.3.3: low muscle tone low weights, strong muscles high ones. Even ones would say
// nothing, since they count relative to the largest.
TEST(ShippedStyles, BuildsHaveLowAndHighWeightsThatDiffer) {
  const Style heavy = style("heavy_slack"), muscular = style("muscular");
  for (const Side side : {kLeftSide, kRightSide}) {
    for (int d = 0; d < kLegDofs; ++d) EXPECT_LT(heavy.weight[side][d], muscular.weight[side][d]);
    for (const Style* build : {&heavy, &muscular}) {
      const auto [low, high] = std::ranges::minmax(build->weight[side]);
      EXPECT_LT(low, 0.8 * high);
      EXPECT_EQ(build->stride[side], StrideFactors());  // by weights alone
    }
  }
}

TEST(ShippedStyles, TiringTiresAndRecovers) {
  const Style tiring = style("tiring");
  EXPECT_GT(tiring.fatigue_per_100_m, 0.0);
  EXPECT_GT(tiring.fatigue_recovery_per_s, 0.0);
  EXPECT_EQ(tiring.fatigue, 0.0);
}

TEST(ShippedStyles, TiredIsFatigued) { EXPECT_GT(style("tired").fatigue, 0.3); }

TEST(ShippedCharacters, EveryFileLoadsAndTheNamedOnesAreThere) {
  for (const auto& entry : std::filesystem::directory_iterator(kConfig + "characters")) {
    if (entry.path().extension() == ".toml") character(entry.path().stem().string());
  }
  EXPECT_EQ(character("adult").leg_ratio, 1.0);
  EXPECT_EQ(character("child").scale, 0.62);
  EXPECT_EQ(character("tall").scale, 1.12);
  EXPECT_EQ(character("as_in_motion_file").name, Character().name);
  EXPECT_EQ(character("as_in_motion_file").scale, 1.0);
}

Terrain terrain(const std::string& name) {
  const Terrain terrain = value_of(load_terrain(kConfig + "terrain/" + name + ".toml"));
  EXPECT_EQ(terrain.name, name);
  return terrain;
}
template <class Shape>
int count_of(const Terrain& t) {
  return static_cast<int>(std::ranges::count_if(
      t.sections, [](const TerrainSection& s) { return std::holds_alternative<Shape>(s.shape); }));
}

TEST(ShippedTerrains, EveryFileLoadsAndTheNamedOnesAreWhatTheySay) {
  for (const auto& entry : std::filesystem::directory_iterator(kConfig + "terrain"))
    if (entry.path().extension() == ".toml") terrain(entry.path().stem().string());
  EXPECT_TRUE(is_flat(terrain("flat")));
  EXPECT_GT(ground_at(terrain("slope_up"), 0.0, 1e3).height_m, 1.0);
  EXPECT_LT(ground_at(terrain("slope_down"), 0.0, 1e3).height_m, -1.0);
  const Terrain stairs = terrain("stairs");
  EXPECT_NEAR(least_tread_m(stairs), 0.28, 1e-9);
  const double riser_m = piece_at(stairs, 0.0).to_m;
  EXPECT_NEAR(ground_at(stairs, 0.0, riser_m).height_m, 0.17, 1e-12);
  EXPECT_GT(count_of<RoughSection>(terrain("rough")), 0);
}

TEST(ShippedTerrains, ZonesNameStylesThatAreThere) {
  int zones = 0;
  for (const auto& entry : std::filesystem::directory_iterator(kConfig + "terrain")) {
    if (entry.path().extension() != ".toml") continue;
    for (const TerrainZone& zone : terrain(entry.path().stem().string()).zones)
      ++zones, style(zone.style);
  }
  EXPECT_GE(zones, 2);
}

TEST(ShippedTerrains, TheCourseHasAllKindsInARow) {
  const Terrain course = terrain("course");
  EXPECT_GT(count_of<FlatSection>(course), 0);
  EXPECT_GE(count_of<SlopeSection>(course), 2);
  EXPECT_GE(count_of<StairsSection>(course), 2);
  EXPECT_GT(count_of<RoughSection>(course), 0);
  EXPECT_GT(count_of<FieldSection>(course), 0);
  EXPECT_TRUE(std::holds_alternative<FlatSection>(course.sections.front().shape));  // a run-in
}

TEST(ShippedCalibrations, SonyPadsGetTheNarrowZoneAndUnknownOnesTheWide) {
  const std::string folders[] = {kConfig + "calibration"};
  const auto inner = [&](std::uint16_t vendor, std::uint16_t product) {
    const FoundCalibration found = find_calibration(folders, {vendor, product, "", "", "hidraw"});
    for (const std::string& problem : found.problems) ADD_FAILURE() << problem;
    const CalibrationFile* file = &found.file;
    EXPECT_EQ(file->calibration.left.inner, file->calibration.right.inner);
    EXPECT_EQ(file->calibration.left.sideways, 0.08);
    EXPECT_EQ(file->calibration.left.outer, 0.95);
    EXPECT_EQ(file->calibration.left.shape, ZoneShape::both);
    return file->calibration.left.inner;
  };
  EXPECT_EQ(inner(0x054c, 0x09cc), kInnerZoneSony);
  EXPECT_EQ(inner(0x054c, 0x0ce6), kInnerZoneSony);
  EXPECT_EQ(inner(0x045e, 0x028e), kInnerZoneUnknown);
}

}  // namespace
}  // namespace gaitpad

// The files of config/ load, and those that the paper or a page describes have the described
// values.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "files/keyframe.h"
#include "gaitpad/calibration.h"
#include "gaitpad/config_files.h"
#include "gaitpad/gait_cycle.h"
#include "gaitpad/style.h"
#include "gaitpad/walk_model.h"
#include "tests/shared_data.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

const std::string kConfig = kSourceFolder + "/config/";

// The names of all files of a kind; there must be at least `least`.
std::vector<std::string> names_of(const std::string& kind, std::size_t least) {
  std::vector<std::string> names;
  for (const std::string& path : files_in(kConfig + kind, ".toml"))
    names.push_back(std::filesystem::path(path).stem().string());
  EXPECT_GE(names.size(), least) << kind;
  return names;
}

Style style(const std::string& name) {
  const Style style = value_of(load_style(kConfig + "styles/" + name + ".toml"));
  EXPECT_EQ(style.name, name);
  return style;
}
Terrain terrain(const std::string& name) {
  const Terrain terrain = value_of(load_terrain(kConfig + "terrain/" + name + ".toml"));
  EXPECT_EQ(terrain.name, name);
  return terrain;
}

TEST(ShippedFiles, EveryOneLoads) {
  for (const std::string& name : names_of("styles", 10)) style(name);
  for (const std::string& name : names_of("characters", 4))
    value_of(load_character(kConfig + "characters/" + name + ".toml"));
  for (const std::string& name : names_of("motions", 1)) {
    TomlFile file = value_of(TomlFile::load(kConfig + "motions/" + name + ".toml"));
    ASSERT_TRUE(is_keyframe_file(file)) << name;
    value_of(gait_cycle(value_of(keyframe_motion(file))));
  }
  int zones = 0;
  for (const std::string& name : names_of("terrain", 6))
    for (const TerrainZone& zone : terrain(name).zones) ++zones, style(zone.style);
  EXPECT_GE(zones, 2);
}

// Fig. 5a: red 1, green hip -80 %, blue knee -20 %. Fig. 5b: the same weights on the left leg
// alone, whose stride is 50 % shorter and 30 % faster, and its flight half as high.
TEST(ShippedStyles, AreThoseOfFigure5) {
  const LegWeights hip = {0.2, 0.2, 0.2, 1, 1, 1, 1}, knee = {1, 1, 1, 0.8, 1, 1, 1};
  for (const auto& [both, left, weights] : {std::tuple("even", "limp_left", kEvenWeights),
                                            {"stiff_hip", "limp_left_hip", hip},
                                            {"stiff_knee", "limp_left_knee", knee}}) {
    const Style stiff = style(both), limp = style(left);
    for (const Side side : {kLeftSide, kRightSide}) EXPECT_EQ(stiff.weight[side], weights) << both;
    EXPECT_EQ(limp.weight[kLeftSide], weights) << left;
    EXPECT_EQ(limp.weight[kRightSide], kEvenWeights) << left;
    const StrideFactors injured = {.length = 0.5, .speed = 1.3, .flight_height = 0.5};
    EXPECT_EQ(limp.stride[kLeftSide], injured) << left;
    EXPECT_EQ(limp.stride[kRightSide], StrideFactors()) << left;
  }
}

// Section 3.3.3: low muscle tone low weights, strong muscles high ones. Even weights would have no
// effect, since weights count relative to the largest.
TEST(ShippedStyles, BuildsHaveLowAndHighWeightsThatDiffer) {
  const Style heavy = style("heavy_slack"), muscular = style("muscular");
  for (const Side side : {kLeftSide, kRightSide}) {
    for (int d = 0; d < kLegDofs; ++d) EXPECT_LT(heavy.weight[side][d], muscular.weight[side][d]);
    for (const Style* build : {&heavy, &muscular}) {
      const auto [low, high] = std::ranges::minmax(build->weight[side]);
      EXPECT_LT(low, 0.8 * high);
      EXPECT_EQ(build->stride[side], StrideFactors());  // a build differs by weights alone
    }
  }
}

template <class Shape>
int count_of(const Terrain& t) {
  return static_cast<int>(std::ranges::count_if(
      t.sections, [](const TerrainSection& s) { return std::holds_alternative<Shape>(s.shape); }));
}

TEST(ShippedTerrains, TheCourseHasAllKindsInARow) {
  const Terrain course = terrain("course");
  EXPECT_GT(count_of<FlatSection>(course), 0);
  EXPECT_GE(count_of<SlopeSection>(course), 2);
  EXPECT_GE(count_of<StairsSection>(course), 2);
  EXPECT_GT(count_of<RoughSection>(course), 0);
  EXPECT_GT(count_of<FieldSection>(course), 0);
  // The course begins with a flat stretch.
  EXPECT_TRUE(std::holds_alternative<FlatSection>(course.sections.front().shape));
}

TEST(ShippedCalibrations, SonyPadsGetTheNarrowZoneAndUnknownOnesTheWide) {
  const std::string folders[] = {kConfig + "calibration"};
  for (const auto& [device, inner] :
       {std::pair(DeviceIdentity{0x054c, 0x09cc, "", "", "hidraw"}, kInnerZoneSony),
        {DeviceIdentity{0x045e, 0x028e, "", "", "hidraw"}, kInnerZoneUnknown}}) {
    const FoundCalibration found = find_calibration(folders, device);
    for (const std::string& problem : found.problems) ADD_FAILURE() << problem;
    EXPECT_EQ(found.file.calibration.left.inner, inner);
    EXPECT_EQ(found.file.calibration.right.inner, inner);
  }
}

}  // namespace
}  // namespace gaitpad

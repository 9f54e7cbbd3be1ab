// Walks over stairs that begin or end at them, judged from their poses: captured limps too, whose
// hips lurch.
#include <gtest/gtest.h>

#include "gaitpad/config_files.h"
#include "gaitpad/motion_file.h"
#include "tests/folders.h"
#include "tests/shared_data.h"
#include "tests/walk/made_walker.h"
#include "tests/walk/terrain_judge.h"

namespace gaitpad {
namespace {

constexpr double kBefore_m = 1.5, kTread_m = 0.28;
constexpr int kTreads = 5;
constexpr double kStairs_m = kBefore_m + kTreads * kTread_m;

WalkModel on_stairs(WalkModel model, double rise_m, double scale) {
  Terrain terrain;
  for (const SectionShape& s :
       {SectionShape{FlatSection{kBefore_m}},
        SectionShape{StairsSection{rise_m, kTread_m, kTreads}}, SectionShape{FlatSection{4.0}}})
    EXPECT_FALSE(add_section(terrain, s));
  model.terrain = std::make_shared<const Terrain>(scaled(terrain, scale));
  return model;
}
WalkModel built_in(double leg_ratio, double rise_m) {
  return on_stairs(model_of(leg_ratio), rise_m, std::max(1.0, leg_ratio));
}
WalkModel captured(const char* file, double leg_ratio, double rise_m) {
  Character character;
  character.leg_ratio = leg_ratio;
  return on_stairs(
      model_of(value_of(gait_cycle(value_of(load_motion(kCapturedMotions + file)))), character),
      rise_m, std::max(1.0, leg_ratio));
}
StyleValues shipped_limp() {
  return value_of(load_style(kSourceFolder + "/config/styles/limp_left.toml"));
}

class Judged : public MadeWalker {
 public:
  explicit Judged(const WalkModel& model) : MadeWalker(model), judge_(model) {}
  void walk_to(double z_m, double y, const StyleValues& style = {}) {
    for (int k = 0; k < 30 * kRate && state().root.place_m.z < z_m; ++k) {
      walk(0.0, y, 1, style);
      judge_.see(state(), pose());
      hips_z_m_.push_back(pose().root_m.z);
    }
  }
  const TerrainWorst& worst() const { return judge_.worst; }
  // The hips' greatest acceleration ahead or back beyond `from_m`, over twentieths of a second.
  double hips_m_s2(double from_m) const {
    constexpr int kTicks = kRate / 20;
    constexpr double kTime_s = kTicks * kDt;
    double most = 0.0;
    for (std::size_t k = 2 * kTicks; k < hips_z_m_.size(); ++k) {
      const double first_m = hips_z_m_[k - 2 * kTicks];
      if (first_m < from_m) continue;
      most = std::max(most, std::abs(hips_z_m_[k] - 2.0 * hips_z_m_[k - kTicks] + first_m));
    }
    return most / (kTime_s * kTime_s);
  }

 private:
  TerrainJudge judge_;
  std::vector<double> hips_z_m_;
};

// Level steps are three times as fast as those on stairs. Between them the hips lead, as where a
// stick changes the pace.
TEST(WalkTerrainEnds, HipsSpeedUpEvenlyWhereStairsEnd) {
  for (const double rise_m : {0.17, -0.17}) {
    for (const double ratio : {0.6, 1.0}) {
      const WalkModel model = built_in(ratio, rise_m);
      Judged walker(model);
      walker.walk_to(kStairs_m + 1.5, 1.0);
      EXPECT_LT(walker.hips_m_s2(kStairs_m - 0.4), 9.0) << ratio << " " << rise_m;
      // A start of short legs, on the level ground before, reaches 0.93.
      EXPECT_LT(walker.worst().jump_deg, ratio < 1.0 ? 0.95 : 0.85) << ratio << " " << rise_m;
    }
  }
}

// The knees of a walk that has come up slowly are nearly straight: the hips sink before the first
// quick step, not in it.
TEST(WalkTerrainEnds, HipsSinkBeforeTheQuickStepAfterStairs) {
  GAITPAD_NEEDS(kCapturedMotions);
  const WalkModel model = captured("cmu_m21_walk.bvh", 0.6, 0.17);
  Judged walker(model);
  walker.walk_to(kStairs_m + 1.5, 1.0);
  EXPECT_LT(walker.worst().jump_deg, 1.0) << "at z " << walker.worst().jump_z_m;
}

TEST(WalkTerrainEnds, LimpsReachTheirFeetOverStairs) {
  GAITPAD_NEEDS(kCapturedMotions);
  for (const char* file : {"bvhtoolbox_walk01.bvh", "cmu_m21_walk.bvh"}) {
    for (const double rise_m : {0.17, -0.17}) {
      const WalkModel model = captured(file, 0.6, rise_m);
      Judged walker(model);
      walker.walk_to(kStairs_m + 1.5, 1.0, shipped_limp());
      EXPECT_EQ(walker.worst().failures, 0) << file << " " << rise_m;
      EXPECT_LT(walker.worst().slide_mm, 0.01) << file << " " << rise_m;
    }
  }
}

// A foot that goes down passes each edge ahead of its path, and does not come back to it.
TEST(WalkTerrainEnds, HeelsStayClearOfTheEdgesTheyPassOnTheWayDown) {
  for (const double ratio : {1.0, 1.6}) {
    for (const StyleValues& style : {StyleValues{}, shipped_limp()}) {
      const WalkModel model = built_in(ratio, -0.17);
      Judged walker(model);
      walker.walk_to(std::max(1.0, ratio) * (kStairs_m + 0.5), 1.0, style);
      EXPECT_LT(walker.worst().sunk_mm, ratio > 1.0 ? 4.6 : 3.3) << ratio;
    }
  }
}

// A captured foot may roll far onto its edge as it leaves the ground. In a first step it would be
// in the ground with it, for both feet still stand flat.
TEST(WalkTerrainEnds, TheEdgeOfAFootThatStartsStaysOutOfTheGround) {
  GAITPAD_NEEDS(kCapturedMotions);
  for (const double ratio : {1.0, 1.6}) {
    const WalkModel model = captured("cmu_m21_walk.bvh", ratio, 0.17);
    Judged walker(model);
    walker.walk_to(0.6, 1.0);
    EXPECT_LT(walker.worst().sunk_mm, 5.0) << ratio;
  }
}

}  // namespace
}  // namespace gaitpad

// Checks the promises of a family of strides by forward kinematics of its numbers.
#include "gaitpad/clean_strides.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "gaitpad/motion_file.h"
#include "gaitpad/stride_family.h"
#include "motion/leg_pose.h"
#include "strides/solver_input.h"
#include "tests/clean_cycle.h"
#include "tests/motion/made_walk.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

constexpr double kMillimetre = 1e-3;
constexpr std::array<int, 2> kSides = {kLeftSide, kRightSide};

double fraction(double phase) { return phase - std::floor(phase); }

std::vector<double> numbers_of(const StrideFamily& family) {
  std::vector<double> numbers;
  for_each_number(family, [&numbers](double number) { numbers.push_back(number); });
  return numbers;
}

// A leg's pose from a cell's angles: x and z in the table's frame, y over the floor.
LegPose pose_in(const GaitCycle& cycle, const StrideCell& cell, int side) {
  const StrideFamily& family = *cycle.strides;
  LegAngles angles = family.stand_rad[side];
  for (int j = 0; j < kLegDofs; ++j) angles[j] += cell.leg_rad[side][j];
  const quat pelvis =
      rotation_y(cell.pelvis_yaw_rad) *
      from_rotation_vector(cell.pelvis_tilt + vec3(0.0, 0.0, family.stand_roll_rad));
  return leg_pose(cycle.leg[side], cell.pelvis_m + vec3(0.0, family.stand_m, 0.0), pelvis, angles,
                  0.0);
}

// The cell of a table at one of its samples, where the spline weighs three knots.
StrideCell sample_of(const StrideTable& table, int i) {
  const auto knot = [&](int k) { return table.knot[(k + kCycleSamples) % kCycleSamples]; };
  return mixed(mixed(knot(i - 1), knot(i + 1), 1.0 / 6, 1.0 / 6), knot(i), 1.0, 4.0 / 6);
}

// Phases at which a foot stands, in its own cycle, which begins at its strike.
struct Stance {
  double own, roll, support;
};
Stance stance_of(const GaitCycle& cycle, int sample, int side) {
  const double strike = cycle.strike[side];
  return {fraction(double(sample) / kCycleSamples - strike),
          fraction(cycle.toe_off[1 - side] - strike), fraction(cycle.toe_off[side] - strike)};
}

// The built-in walk, and one whose steps are uneven.
class StrideFamilyOf : public testing::TestWithParam<const char*> {
 protected:
  const GaitCycle cycle = [] {
    if (GetParam() == std::string("built_in")) return clean_cycle(procedural_gait());
    MadeWalk uneven;
    uneven.left_at = 0.47;
    return clean_cycle(value_of(gait_cycle(made_walk(uneven))));
  }();
  const StrideFamily& family = *cycle.strides;
};
INSTANTIATE_TEST_SUITE_P(Walks, StrideFamilyOf, testing::Values("built_in", "uneven"),
                         [](const auto& info) { return std::string(info.param); });

TEST_P(StrideFamilyOf, KeepsPlantedPointsWhereTheyStand) {
  for (const StrideTable& table : family.table) {
    double worst_m = 0.0;
    for (int i = 0; i < kCycleSamples; ++i) {
      for (const int side : kSides) {
        const Stance s = stance_of(cycle, i, side);
        const LegPose pose = pose_in(cycle, sample_of(table, i), side);
        const LegModel& leg = cycle.leg[side];
        const vec3 travelled(0.0, 0.0, table.stride_m * (cycle.strike[side] + s.own));
        const vec3 heel_m = table.footprint_m[side], toe_m = heel_m + leg.toe_m - leg.heel_m;
        if (s.own <= s.roll)
          worst_m = std::max(worst_m, glm::distance(pose.heel_m + travelled, heel_m));
        if (s.own >= s.roll && s.own <= s.support)
          worst_m = std::max(worst_m, glm::distance(pose.toe_m + travelled, toe_m));
      }
    }
    EXPECT_LT(worst_m, kMillimetre) << table.stride_m << " m";
  }
}

TEST_P(StrideFamilyOf, StaysAboveTheFloor) {
  for (const StrideTable& table : family.table) {
    for (int i = 0; i < kCycleSamples; ++i) {
      for (const int side : kSides) {
        const LegPose pose = pose_in(cycle, sample_of(table, i), side);
        EXPECT_GT(pose.heel_m.y, -kMillimetre) << table.stride_m << " m, sample " << i;
        EXPECT_GT(pose.toe_m.y - cycle.leg[side].toe_rest_m, -kMillimetre)
            << table.stride_m << " m, sample " << i;
      }
    }
  }
}

TEST_P(StrideFamilyOf, BendsEveryKneeAboutADegreeAtLeast) {
  for (const StrideTable& table : family.table) {
    for (int i = 0; i < kCycleSamples; ++i) {
      const StrideCell cell = sample_of(table, i);
      for (const int side : kSides) {
        const double knee = family.stand_rad[side][kKneeX] + cell.leg_rad[side][kKneeX];
        EXPECT_GT(knee, 0.8 * kDegree) << table.stride_m << " m";
      }
    }
  }
}

TEST_P(StrideFamilyOf, HasNoSeam) {
  for (const StrideTable& table : family.table) {
    const auto change = [&table](int from) {
      const StrideCell d =
          mixed(sample_of(table, (from + 1) % kCycleSamples), sample_of(table, from), 1, -1);
      double most = glm::length(d.pelvis_m);
      for (const int side : kSides) {
        for (const double angle : d.leg_rad[side]) most = std::max(most, std::abs(angle));
      }
      return most;
    };
    double most = 0.0;
    for (int i = 0; i < kCycleSamples - 1; ++i) most = std::max(most, change(i));
    EXPECT_LE(change(kCycleSamples - 1), most);
  }
}

TEST_P(StrideFamilyOf, HasFeetThatAgreeWithTheLegs) {
  for (const StrideTable& table : family.table) {
    for (int i = 0; i < kCycleSamples; ++i) {
      for (const int side : kSides) {
        const LegPose pose = pose_in(cycle, sample_of(table, i), side);
        const StrideFoot foot = sample_of(table, i).foot[side];
        EXPECT_LT(glm::distance(foot.heel_m, pose.heel_m), 1e-9);
        const vec3 line = cycle.leg[side].toe_m - cycle.leg[side].heel_m;
        const vec3 ahead = glm::normalize(vec3(line.x, 0.0, line.z)),
                   across = glm::cross(kUp, ahead);
        const quat rotation = rotation_about(across, foot.pitch_rad) *
                              from_rotation_vector(kUp * foot.twist_rad + ahead * foot.roll_rad);
        EXPECT_LT(glm::distance(rotation * line, pose.toe_m - pose.heel_m), 1e-6);
      }
    }
  }
}

TEST(StrideFamily, ItsSplinesGoThroughTheSamplesThatTheyAreMadeFor) {
  std::array<StrideCell, kCycleSamples> samples;
  for (int i = 0; i < kCycleSamples; ++i) {
    auto* number = reinterpret_cast<double*>(&samples[i]);
    for (std::size_t n = 0; n < sizeof(StrideCell) / sizeof(double); ++n)
      number[n] = std::sin(1.0 + i * i + 3.0 * n);  // as rough as a table can be
  }
  std::vector<StrideTable> tables(kStrideRatios);
  for (StrideTable& table : tables) table.knot = knots_through(samples);
  for (int i = 0; i < kCycleSamples; ++i) {
    const StridePlace place = stride_at(tables, double(i) / kCycleSamples, 0.7);
    const StrideCell off = mixed(place.cell, samples[i], 1.0, -1.0);
    const auto* number = reinterpret_cast<const double*>(&off);
    for (std::size_t n = 0; n < sizeof(StrideCell) / sizeof(double); ++n)
      EXPECT_NEAR(number[n], 0.0, 1e-12);
  }
}

TEST_P(StrideFamilyOf, GrowsWithItsRatioAndIsReadAtItsOwnRatiosAsItStands) {
  for (int k = 0; k < kStrideRatios; ++k) {
    const StrideTable& table = family.table[k];
    EXPECT_NEAR(table.stride_m, k * kRatioStep * cycle.stride_m, 1e-12);
    const StridePlace place = stride_at(family.table, 0.3, k * kRatioStep);
    EXPECT_NEAR(place.track.stride_m, table.stride_m, 1e-12);
    for (const int side : kSides) {
      EXPECT_EQ(table.footprint_m[side].y, 0.0);
      EXPECT_LT(glm::distance(place.track.footprint_m[side], table.footprint_m[side]), 1e-12);
    }
  }
}

TEST_P(StrideFamilyOf, IsReadWithoutKinks) {
  // Compares slopes from both sides, in phase and in ratio, at and between the tables.
  constexpr double kStep = 1e-6;
  const auto slopes_agree = [](const std::function<vec3(double)>& curve, double at) {
    const vec3 before = (curve(at) - curve(at - kStep)) / kStep,
               after = (curve(at + kStep) - curve(at)) / kStep;
    EXPECT_LT(glm::distance(before, after), 1e-2) << at;
  };
  for (const double ratio : {0.3, 0.6, 1.0}) {
    for (const double phase : {0.0, 0.25, 0.5, 77.0 / kCycleSamples, 0.9}) {
      const auto along_phase = [&](double p) {
        return stride_at(family.table, p, ratio).cell.pelvis_m;
      };
      const auto along_ratio = [&](double r) {
        return stride_at(family.table, phase, r).cell.pelvis_m;
      };
      slopes_agree(along_phase, phase);
      slopes_agree(along_ratio, ratio);
    }
  }
}

TEST_P(StrideFamilyOf, IsPeriodicInPhaseAndClampedInRatio) {
  const auto knee = [this](double phase, double ratio) {
    return stride_at(family.table, phase, ratio).cell.leg_rad[kLeftSide][kKneeX];
  };
  EXPECT_NEAR(knee(0.3, 0.9), knee(5.3, 0.9), 1e-12);
  EXPECT_NEAR(knee(0.3, 0.9), knee(-0.7, 0.9), 1e-12);
  EXPECT_EQ(knee(0.3, 9.0), knee(0.3, kMostRatio));
  EXPECT_EQ(knee(0.3, -1.0), knee(0.3, 0.0));
}

TEST(StrideFamily, KeepsTheBuiltInWalksJoints) {
  const GaitCycle cycle = clean_cycle(procedural_gait());
  const StrideTable own = cycle.strides->table[static_cast<std::size_t>(1.0 / kRatioStep + 0.5)];
  ASSERT_NEAR(own.stride_m, cycle.stride_m, 1e-12);
  // Root mean square change of an angle; the data may be shifted in phase.
  const auto change = [&](int side, int joint, double shift) {
    double squares = 0.0;
    for (int i = 0; i < kCycleSamples; ++i) {
      const double now =
          cycle.strides->stand_rad[side][joint] + sample_of(own, i).leg_rad[side][joint];
      const CycleSample data = sample_at(cycle, double(i) / kCycleSamples + shift);
      squares += std::pow(now - data.leg[side].angles[joint], 2);
    }
    return std::sqrt(squares / kCycleSamples);
  };
  double best_shift = 0.0, least = 1e9;
  for (double shift = -0.03; shift < 0.03; shift += 0.001) {
    double sum = 0.0;
    for (const int joint : {kHipX, kKneeX, kAnkleX}) sum += change(kLeftSide, joint, shift);
    if (sum < least) best_shift = shift, least = sum;
  }
  for (const int side : kSides) {
    EXPECT_LT(change(side, kHipX, best_shift), 3.0 * kDegree);
    EXPECT_LT(change(side, kKneeX, best_shift), 3.0 * kDegree);
    EXPECT_LT(change(side, kAnkleX, best_shift), 3.5 * kDegree);
  }
}

// The pelvis' forward speed between neighbouring samples, over its mean; z is where it is in the
// travel frame.
using Speeds = std::array<double, kCycleSamples>;
Speeds speeds_of(double stride_m, const std::function<double(int)>& z_m) {
  Speeds speeds;
  for (int i = 0; i < kCycleSamples; ++i)
    speeds[i] = 1.0 + kCycleSamples * (z_m((i + 1) % kCycleSamples) - z_m(i)) / stride_m;
  return speeds;
}

// The sample of a step, the mean of both, at which the pelvis is fastest.
int fastest(const Speeds& speeds) {
  const auto both = [&speeds](int i) { return speeds[i] + speeds[i + kCycleSamples / 2]; };
  int most = 0;
  for (int i = 0; i < kCycleSamples / 2; ++i) {
    if (both(i) > both(most)) most = i;
  }
  return most;
}

// How far the hips' speed within the data's own stride is from the data's: RMS, as a share of the
// mean speed, and of the fastest moment of a step, as a share of the step.
struct SpeedOff {
  double rms, fastest;
};
SpeedOff speed_off(const GaitCycle& cycle) {
  const StrideTable own = cycle.strides->table[static_cast<std::size_t>(1.0 / kRatioStep + 0.5)];
  EXPECT_NEAR(own.stride_m, cycle.stride_m, 1e-12);
  const Speeds data = speeds_of(cycle.stride_m,
                                [&cycle](int i) { return cycle.samples[i].pelvis_m.z; }),
               walk =
                   speeds_of(own.stride_m, [&own](int i) { return sample_of(own, i).pelvis_m.z; });
  double squares = 0.0;
  for (int i = 0; i < kCycleSamples; ++i) squares += std::pow(walk[i] - data[i], 2);
  constexpr int kStep = kCycleSamples / 2;
  const int apart = std::abs(fastest(walk) - fastest(data));
  return {std::sqrt(squares / kCycleSamples), double(std::min(apart, kStep - apart)) / kStep};
}

// The built-in curves as if they were captured: their hips' speed is kept, too.
TEST(StrideFamily, KeepsTheHipsSpeedWithinAStepWhereTheDataAreCaptured) {
  GaitCycle captured = procedural_gait();
  captured.captured = true;
  const SpeedOff kept = speed_off(clean_cycle(captured)),
                 made = speed_off(clean_cycle(procedural_gait()));
  EXPECT_LT(kept.rms, 0.7 * made.rms);
  EXPECT_LE(kept.fastest, 0.1);
  EXPECT_NE(solver_input(captured), solver_input(procedural_gait()));  // not the other's cache file
}

TEST(StrideFamily, TakesFilesAsCapturedAndTheBuiltInWalkNotOnAnySkeleton) {
  const Motion file = made_walk(MadeWalk());
  const GaitCycle captured = value_of(gait_cycle(file)), built_in = procedural_gait();
  EXPECT_TRUE(captured.captured);
  EXPECT_FALSE(built_in.captured);
  EXPECT_TRUE(value_of(cycle_on_skeleton(captured, procedural_motion())).captured);
  EXPECT_FALSE(value_of(cycle_on_skeleton(built_in, file)).captured);
}

TEST(StrideFamily, FollowsCapturedHipsSpeedsWithinAStep) {
  GAITPAD_NEEDS(kCapturedMotions);
  for (const char* file : {"cmu_m21_walk.bvh", "bvhtoolbox_walk01.bvh", "cmu_07_01.amc"}) {
    SCOPED_TRACE(file);
    const SpeedOff kept = speed_off(
        clean_cycle(value_of(gait_cycle(value_of(load_motion(kCapturedMotions + file))))));
    EXPECT_LT(kept.rms, 0.045);
    EXPECT_LE(kept.fastest, 0.11);
  }
}

TEST(StrideFamily, StretchesNoBentKneeByMoreThanThreeDegrees) {
  GAITPAD_NEEDS(kCapturedMotions);
  for (const char* file : {"bvhtoolbox_walk01.bvh", "cmu_35_01.amc"}) {
    const GaitCycle cycle =
        clean_cycle(value_of(gait_cycle(value_of(load_motion(kCapturedMotions + file)))));
    const StrideFamily& family = *cycle.strides;
    for (const int side : kSides) {
      double data = kPi, walk = kPi;
      for (int i = 0; i < kCycleSamples; ++i) {
        const double bend = sample_of(family.table[5], i).leg_rad[side][kKneeX];
        data = std::min(data, cycle.samples[i].leg[side].angles[kKneeX]);
        walk = std::min(walk, family.stand_rad[side][kKneeX] + bend);
      }
      EXPECT_GT(walk, data - 3.0 * kDegree) << file << ", side " << side;
    }
  }
}

TEST(StrideFamily, IsSymmetricWhereTheDataAre) {
  const GaitCycle cycle = clean_cycle(procedural_gait());
  const StrideFamily& family = *cycle.strides;
  constexpr int kHalf = kCycleSamples / 2;
  for (const StrideTable& table : family.table) {
    for (int i = 0; i < kHalf; ++i) {
      const StrideCell a = sample_of(table, i), b = sample_of(table, i + kHalf);
      EXPECT_LT(glm::distance(a.pelvis_m, mirrored(b.pelvis_m)), 1e-9);
      EXPECT_NEAR(a.pelvis_yaw_rad, -b.pelvis_yaw_rad, 1e-9);
      // The tilt is an axial vector, so its mirror image changes sign.
      EXPECT_LT(glm::distance(a.pelvis_tilt, -mirrored(b.pelvis_tilt)), 1e-9);
      for (const int side : kSides) {
        const StrideFoot &foot = a.foot[side], &other = b.foot[1 - side];
        EXPECT_LT(glm::distance(foot.heel_m, mirrored(other.heel_m)), 1e-9);
        EXPECT_NEAR(foot.pitch_rad, other.pitch_rad, 1e-9);
        EXPECT_NEAR(foot.twist_rad, -other.twist_rad, 1e-9);
        EXPECT_NEAR(foot.roll_rad, -other.roll_rad, 1e-9);
        for (const int j : {kHipX, kKneeX, kAnkleX})
          EXPECT_NEAR(a.leg_rad[side][j], b.leg_rad[1 - side][j], 1e-9);
        for (const int j : {kHipZ, kHipY, kAnkleZ, kAnkleY})
          EXPECT_NEAR(a.leg_rad[side][j], -b.leg_rad[1 - side][j], 1e-9);
      }
    }
  }
}

// A symmetric stride, of which half is solved, and a slightly uneven one, which is solved whole,
// have nearly the same solution. Equal cycles have bit-identical strides.
TEST(StrideFamily, OfEqualAndOfNearlyEqualCyclesIsTheSame) {
  GaitCycle uneven = procedural_gait();
  uneven.samples[3].pelvis_m.x += 1e-8;
  const auto a = numbers_of(value_of(stride_family(procedural_gait()))),
             b = numbers_of(value_of(stride_family(uneven)));
  EXPECT_EQ(a, numbers_of(*clean_cycle(procedural_gait()).strides));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-4);
}

TEST(StrideFamily, NamesWhatIsNoWalk) {
  const double nothing = std::numeric_limits<double>::quiet_NaN(),
               endless = std::numeric_limits<double>::infinity();
  const auto cause = [](const std::function<void(GaitCycle&)>& spoil) {
    GaitCycle cycle = procedural_gait();
    cycle.name = "odd.bvh";
    spoil(cycle);
    return cause_of(with_clean_strides(cycle));
  };
  const std::string no_number = "odd.bvh: holds a number that is not finite";
  EXPECT_EQ(cause([&](GaitCycle& c) { c.samples[9].pelvis_m.y = nothing; }), no_number);
  EXPECT_EQ(cause([&](GaitCycle& c) { c.samples[9].leg[1].angles[kKneeX] = endless; }), no_number);
  EXPECT_EQ(cause([&](GaitCycle& c) { c.toe_off[0] = nothing; }), no_number);
  EXPECT_EQ(cause([&](GaitCycle& c) { c.stride_m = endless; }),
            "odd.bvh: stride_m is inf, outside [0.001, 1000]");
  EXPECT_EQ(cause([](GaitCycle& c) { c.samples.clear(); }),
            "odd.bvh: samples: there are 0, not 128");
  EXPECT_EQ(cause([](GaitCycle& c) { c.leg[0].shank_m = 0.0; }),
            "odd.bvh: leg[0].shank_m is 0, outside [0.001, 1000]");
  EXPECT_EQ(cause([](GaitCycle& c) { c.leg[1].toe_m = c.leg[1].heel_m; }),
            "odd.bvh: has a leg without a thigh, a shank or a foot");
  EXPECT_EQ(cause([](GaitCycle& c) { c.stride_m = 0.0; }),
            "odd.bvh: stride_m is 0, outside [0.001, 1000]");
  EXPECT_EQ(cause([](GaitCycle& c) { c.stride_m = 40.0; }),
            "odd.bvh: takes strides longer than four legs");
  EXPECT_EQ(cause([](GaitCycle& c) { std::swap(c.toe_off[0], c.toe_off[1]); }),
            "odd.bvh: has events that are not in the order of a walk");
  EXPECT_EQ(cause([](GaitCycle& c) { c.samples[0].pelvis = quat(0.0, 0.0, 0.0, 0.0); }),
            "odd.bvh: holds a rotation of the pelvis that is not a unit quaternion");
  EXPECT_EQ(cause([](GaitCycle& c) { c.samples[0].leg[0].angles[kHipX] = 1e6; }),
            "odd.bvh: turns a leg by more than a full turn");
}

TEST(StrideFamily, OfUnlikelyWalksHasFiniteTables) {
  const auto family_of = [](const std::function<void(GaitCycle&)>& bend) {
    GaitCycle cycle = procedural_gait();
    bend(cycle);
    return value_of(stride_family(cycle));
  };
  const auto all_finite = [](const StrideFamily& family) {
    return std::ranges::all_of(numbers_of(family), [](double n) { return std::isfinite(n); });
  };
  EXPECT_TRUE(all_finite(family_of([](GaitCycle& c) { c.stride_m = 3.0; })));
  EXPECT_TRUE(all_finite(family_of([](GaitCycle& c) { c.leg[0].shank_m *= 0.2; })));
  EXPECT_TRUE(all_finite(family_of([](GaitCycle& c) {
    for (CycleSample& s : c.samples) s.pelvis_m.y += 0.5;
  })));
}

TEST_P(StrideFamilyOf, KnowsHowHighAndLowThePelvisIs) {
  for (const auto* tables : {&cycle.strides->table, &cycle.strides->back}) {
    for (std::size_t k = 0; k < tables->size(); ++k) {
      double low = 1e9, high = -1e9;
      for (int i = 0; i < kCycleSamples; ++i) {
        const double y =
            stride_at(*tables, double(i) / kCycleSamples, kRatioStep * double(k)).cell.pelvis_m.y;
        low = std::min(low, y), high = std::max(high, y);
      }
      EXPECT_NEAR((*tables)[k].low_m, low, 1e-9) << k;
      EXPECT_NEAR((*tables)[k].high_m, high, 1e-9) << k;
    }
  }
}

TEST(RollTimeShare, IsTheDatasAtItsOwnRatioLongerInShortStepsAndWithinAPersonsBounds) {
  EXPECT_DOUBLE_EQ(roll_time_share(0.12, 1.0), 0.12);
  for (const double share : {0.01, 0.05, 0.12, 0.2, 0.3}) {
    for (double ratio = 0.0; ratio <= kMostRatio; ratio += 0.05) {
      EXPECT_GE(roll_time_share(share, ratio), std::min(share, 0.04));
      EXPECT_LE(roll_time_share(share, ratio), std::max(share, 0.22));
    }
  }
  for (double ratio = 0.0; ratio < kMostRatio; ratio += 0.1)
    EXPECT_GE(roll_time_share(0.12, ratio), roll_time_share(0.12, ratio + 0.1));
}

StageClock made_clock() { return {{0.12, 0.38, 0.13, 0.37}, {0.17, 0.34, 0.18, 0.31}}; }

TEST(StageClock, EndsEachStageInItsTime) {
  const StageClock clock = made_clock();
  double time = 0.0, phase = 0.0;
  for (int turn = -1; turn < 2; ++turn) {
    time = phase = turn;
    for (int stage = 0; stage < 4; ++stage) {
      EXPECT_NEAR(clock.time_at(phase), time, 1e-12);
      time += clock.time_share[stage];
      phase += clock.phase_share[stage];
    }
  }
}

TEST(StageClock, RunsForwardAtAPaceWithoutJumps) {
  const StageClock clock = made_clock();
  constexpr double kStep = 1e-4;
  double pace_before = (clock.time_at(0.0) - clock.time_at(-kStep)) / kStep;
  for (double phase = 0.0; phase < 1.1; phase += kStep) {
    const double pace = (clock.time_at(phase + kStep) - clock.time_at(phase)) / kStep;
    ASSERT_GT(pace, 0.3) << phase;
    ASSERT_NEAR(pace, pace_before, 1e-2) << phase;
    pace_before = pace;
  }
}

}  // namespace
}  // namespace gaitpad

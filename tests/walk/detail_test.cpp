// Walks that are far away: their pose is the tables' (Detail::tables).
#include <gtest/gtest.h>

#include "tests/walk/made_block.h"
#include "tests/walk/made_crowd.h"

namespace gaitpad {
namespace {

constexpr double kTogether_s = 0.3;  // after a change of the detail, whose fade takes 0.25 s

// The greatest distance between the heels and toes of two walks.
double apart_m(const Pose& a, const Pose& b) {
  double most_m = 0.0;
  for (const Side side : {kLeftSide, kRightSide})
    for (const bool toe : {false, true})
      most_m = std::max(most_m, glm::distance(end_of(a, side, toe), end_of(b, side, toe)));
  return most_m;
}
double most_turned_deg(const Pose& a, const Pose& b) {
  double most_deg = 0.0;
  for (int j = 1; j < a.joint_count; ++j)
    most_deg = std::max(most_deg, turned_deg(a.local[j], b.local[j]));
  return most_deg;
}

class Tables : public testing::TestWithParam<const char*> {};

// At ten moments of a step it comes over and back, beside a walk that is always in full. Weights
// turn a foot about its planted end, and their means begin anew: there that end is compared.
TEST_P(Tables, GoesTheSameWayAndComesBackSmoothly) {
  constexpr double kMostBend_deg = 1.2;  // that of a change of pace
  constexpr double kMostApart_m = 1e-5;
  const GaitParams params = params_of(0.2, 0.8, shipped(GetParam()));
  double slid_m = 0.0, back_m = 0.0, bend_deg = 0.0, full_deg = 0.0;
  for (int wait = 0; wait < kRate; wait += kRate / 10) {
    Alone full, walk;
    full.walk(params, 4 * kRate + wait), walk.walk(params, 4 * kRate + wait);
    Jerks jerks, of_full;
    for (int tick = 0; tick < 3 * kRate; ++tick) {
      set_detail(tick < kRate ? Detail::tables : Detail::full, 0, walk.block);
      const Planted planted = planted_of(full.block);
      full.step(params), walk.step(params);
      ASSERT_EQ(full.pose.root_m, walk.pose.root_m) << wait << ", tick " << tick;
      ASSERT_EQ(full.pose.local[0], walk.pose.local[0]) << wait << ", tick " << tick;
      jerks.add(walk.pose), of_full.add(full.pose);
      const double apart = apart_m(full.pose, walk.pose);
      if (tick < kRate) slid_m = std::max(slid_m, apart);
      if (tick < (1.0 + kTogether_s) * kRate) continue;
      const auto end = [&](const Pose& pose) { return end_of(pose, planted.side, planted.toe); };
      const bool is_weighted = full.block.weighted.asked != 0.0f;
      back_m =
          std::max(back_m, is_weighted ? glm::distance(end(full.pose), end(walk.pose)) : apart);
    }
    bend_deg = std::max(bend_deg, jerks.most_deg), full_deg = std::max(full_deg, of_full.most_deg);
  }
  std::printf("%s: feet %.1f mm off, %.5f mm after it came back; bends %.3f, in full %.3f\n",
              GetParam(), slid_m * 1e3, back_m * 1e3, bend_deg, full_deg);
  EXPECT_LE(slid_m, 0.1);
  EXPECT_GT(slid_m, 0.01);  // it was the tables' pose
  EXPECT_LE(back_m, kMostApart_m);
  EXPECT_LE(bend_deg, kMostBend_deg);
}
INSTANTIATE_TEST_SUITE_P(Of, Tables, testing::Values("even", "stiff_knee", "limp_left"));

// Its pose is that of the even walk's data: no style of legs, arms or trunk shows.
TEST(Detail, TablesShowNoStyle) {
  StyleValues carries;
  carries.body.hand[kLeftSide].carry = 1.0;
  carries.body.spine_weight[0] = 0.4;
  carries.weight[kLeftSide][kKneeX] = 0.2;
  Alone even, styled;
  for (Alone* walk : {&even, &styled}) {
    set_detail(Detail::tables, 0, walk->block);
    walk->walk(params_of(0.0, 0.8, walk == &even ? StyleValues{} : carries), 4 * kRate);
  }
  EXPECT_EQ(most_turned_deg(even.pose, styled.pose), 0.0);
  EXPECT_EQ(styled.block.told.error_m[0], 0.0f);
  // The style comes when the walk is in full again.
  set_detail(Detail::full, 0, styled.block);
  styled.walk(params_of(0.0, 0.8, carries), 2 * kRate);
  even.walk(params_of(0.0, 0.8), 2 * kRate);
  EXPECT_GT(most_turned_deg(even.pose, styled.pose), 20.0);
}

// A walk that stands, starts, turns and stops, by the paper's solver as well, which jumps by
// itself.
TEST(Detail, ComesBackSmoothlyWhateverTheWalkDoes) {
  constexpr double kMostMore_deg = 0.3, kMostByPaper = 1.5;  // than in full, times that in full
  for (const IkMode mode : {IkMode::robust, IkMode::paper}) {
    for (const int every : {40, 97}) {
      Alone full(adult(), {}, mode), walk(adult(), {}, mode);
      Jerks of_full, jerks;
      for (int tick = 0; tick < 12 * kRate; ++tick) {
        const int second = tick / kRate;
        const GaitParams params =
            second % 4 == 0 ? params_of(0.0, 0.0) : params_of(second % 3 == 1 ? 0.5 : 0.0, 0.8);
        set_detail(tick / every % 3 == 1 ? Detail::tables : Detail::full, 0, walk.block);
        full.step(params), walk.step(params);
        ASSERT_EQ(full.pose.root_m, walk.pose.root_m) << tick;
        of_full.add(full.pose), jerks.add(walk.pose);
      }
      std::printf("bends %.3f, in full %.3f\n", jerks.most_deg, of_full.most_deg);
      EXPECT_LE(jerks.most_deg, mode == IkMode::paper ? kMostByPaper * of_full.most_deg
                                                      : of_full.most_deg + kMostMore_deg);
    }
  }
}

TEST(Detail, WalksSideBySideHaveTheBitsOfOneAlone) {
  for_each_width([](auto width) {
    Alone walk;
    walk.walk(params_of(0.2, 0.8, shipped("stiff_knee")), 4 * kRate);
    std::vector<Block<1>> alone;
    for (int w = 0; w < width; ++w) {
      for (int tick = 0; tick < 11 * w + 3; ++tick) walk.step();
      alone.push_back(walk.block);
    }
    const GaitParams styled = params_of(0.2, 0.8, shipped("stiff_knee")),
                     even = params_of(-0.3, 0.5);
    expect_bits_of_one<width>(walk.tables, alone, 600, [&](int tick, int w, Block<1>& block) {
      if (tick % 50 != w % 5) return false;
      // From tick 300 on the tables pose all of them.
      const bool far = tick >= 300 ? tick < 500 : (tick / 50 + w) % 3 == 0;
      set_detail(far ? Detail::tables : Detail::full, 0, block);
      ask((tick / 100 + w) % 2 == 0 ? styled : even, block);
      return true;
    });
  });
}

TEST(Detail, MembersOfACrowdWalkAsTheyWouldAlone) {
  constexpr int kMembers = 40, kTicks = 10 * kCrowdRate;
  MadeCrowd made(kMembers);
  Crowd& crowd = made.crowd();
  std::vector<WalkState> states(kMembers);
  std::vector<Pose> poses(kMembers);
  for (int i = 0; i < kMembers; ++i)
    states[i] = standing(crowd.model(i), made.members()[i].place_m, poses[i]);
  for (int tick = 0; tick < kTicks && !HasFailure(); ++tick) {
    for (int i = 0; i < kMembers; ++i) {
      if ((tick + 13 * i) % 70 != 0) continue;
      states[i].detail = (tick / 70 + i) % 3 == 0 ? Detail::full : Detail::tables;
      crowd.set_detail(i, states[i].detail);
    }
    made.step(tick);
    for (int i = 0; i < kMembers; ++i) {
      advance(crowd.model(i), crowd.params()[i], IkMode::robust, kCrowdDt, states[i], poses[i]);
      const std::span<const quat> local = crowd.local(i);
      EXPECT_EQ(crowd.root_m(i), poses[i].root_m) << "member " << i << ", tick " << tick;
      EXPECT_TRUE(std::equal(local.begin(), local.end(), poses[i].local.begin()))
          << "member " << i << ", tick " << tick;
      if (tick % 9 != 0) continue;
      const WalkState state = crowd.state(i);
      EXPECT_EQ(state.detail, states[i].detail);
      const WalkFrame frame = crowd.frame(i),
                      alone = walk_frame(crowd.model(i), states[i], poses[i]);
      EXPECT_EQ(frame.root_moved_m, alone.root_moved_m);
      EXPECT_EQ(frame.heel_m[0], alone.heel_m[0]);
    }
  }
}

TEST(Detail, OfAMemberStaysWhenItIsPutBack) {
  MadeCrowd made(9);
  made.crowd().set_detail(8, Detail::tables);
  for (int tick = 0; tick < kCrowdRate; ++tick) made.step(tick);
  made.crowd().restart(8, vec3(0.0));
  for (int tick = 0; tick < kCrowdRate; ++tick) made.step(tick);
  const WalkState state = made.crowd().state(8);
  EXPECT_EQ(state.detail, Detail::tables);
  EXPECT_EQ(state.walk.change.to_tables, 1.0f);
}

TEST(Detail, ThatIsNoneIsCounted) {
  const auto none = static_cast<Detail>(7);
  Pose pose;
  WalkState state = standing(adult(), vec3(0.0), pose);
  state.detail = Detail::tables;
  advance(adult(), params_of(0.0, 0.8), IkMode::robust, kDt, state, pose);
  state.detail = none;
  advance(adult(), params_of(0.0, 0.8), IkMode::robust, kDt, state, pose);
  EXPECT_EQ(state.detail, Detail::tables);
  EXPECT_EQ(state.bad_inputs, 1);
  MadeCrowd made(2);
  made.crowd().set_detail(1, none), made.crowd().set_detail(2, Detail::tables);
  made.crowd().set_detail(-1, Detail::tables);
  EXPECT_EQ(made.crowd().detail(1), Detail::full);
  EXPECT_EQ(made.crowd().state(1).bad_inputs, 1);
}

}  // namespace
}  // namespace gaitpad

#include "gaitpad/crowd.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <limits>
#include <random>
#include <thread>

#include "base/lanes.h"
#include "gaitpad/hash.h"
#include "tests/clean_cycle.h"
#include "tests/walk/made_crowd.h"

namespace gaitpad::test {
namespace {

constexpr int kMembers = 64;
constexpr int kTicks = 20 * kCrowdRate;

void expect_same_pose(const Pose& a, std::span<const quat> local, const vec3& root_m, int member,
                      int tick) {
  ASSERT_EQ(a.joint_count, static_cast<int>(local.size()));
  EXPECT_EQ(a.root_m, root_m) << "member " << member << ", tick " << tick;
  EXPECT_TRUE(std::equal(local.begin(), local.end(), a.local.begin()))
      << "member " << member << ", tick " << tick;
}

// The hash of a walk that is computed with this number of lanes.
std::uint64_t hash_with(int lanes) {
  use_lanes(lanes);
  MadeCrowd made(kMembers);
  WordHash hash;
  for (int tick = 0; tick < kTicks; ++tick) {
    made.step(tick);
    made.add_to(hash);
  }
  use_lanes(widest_lanes());
  return hash.value();
}

TEST(Crowd, WalksAsItsMembersWouldAlone) {
  MadeCrowd made(kMembers);
  Crowd& crowd = made.crowd();
  std::vector<WalkState> states(kMembers);
  std::vector<Pose> poses(kMembers);
  for (int i = 0; i < kMembers; ++i)
    states[i] = standing(crowd.model(i), made.members()[i].place_m, poses[i]);
  for (int tick = 0; tick < kTicks; ++tick) {
    made.step(tick);
    for (int i = 0; i < kMembers; ++i) {
      advance(crowd.model(i), crowd.params()[i], IkMode::robust, kCrowdDt, states[i], poses[i]);
      if (tick % 7 == 0) expect_same_pose(poses[i], crowd.local(i), crowd.root_m(i), i, tick);
    }
    if (HasFailure()) break;
  }
}

// Members of equal styles are put side by side while they walk, some of them far away, and styles
// change: all go on to the same bits.
TEST(Crowd, GroupedByStyleItsMembersKeepTheirBits) {
  MadeCrowd as_made(kMembers), grouped(kMembers);
  for (int tick = 0; tick < 6 * kCrowdRate; ++tick) {
    for (MadeCrowd* made : {&as_made, &grouped}) {
      made->command(tick);
      if (tick > 2 * kCrowdRate) made->crowd().params()[8] = made->crowd().params()[16];
      if (tick == kCrowdRate) made->crowd().set_detail(9, Detail::tables);
    }
    if (tick % kCrowdRate == 30) grouped.crowd().group_by_style();
    as_made.crowd().advance(kCrowdDt), grouped.crowd().advance(kCrowdDt);
  }
  WordHash hash, of_grouped;
  as_made.add_to(hash);
  grouped.add_to(of_grouped);
  EXPECT_EQ(of_grouped.value(), hash.value());
  for (int i = 0; i < kMembers; ++i)
    EXPECT_EQ(grouped.crowd().frame(i).steps, as_made.crowd().frame(i).steps) << i;
}

// A block of three members has unused lanes, which repeat the last member. That has to hold as well
// when its ankle bends too far and its leg is solved again, here in an abrupt stop after a turn.
TEST(Crowd, WalksAsItsMembersWouldAloneWhereABlockIsNotFull) {
  const auto model =
      std::make_shared<const WalkModel>(value_of(walk_model(clean_cycle(procedural_gait()), {})));
  const std::vector<CrowdMember> members(3, CrowdMember{model, vec3(0.0)});
  Crowd crowd(members);
  Pose pose;
  WalkState state = standing(*model, vec3(0.0), pose);
  for (int tick = 0; tick < 12 * kCrowdRate && !HasFailure(); ++tick) {
    Stick stick;
    if (tick % (3 * kCrowdRate) < 2 * kCrowdRate) stick.left = vec2(0.3, 0.6 + tick / 2400.0);
    const GaitParams params = gait_params(stick, StyleValues{}, gait_limits(*model));
    for (GaitParams& of : crowd.params()) of = params;
    crowd.advance(kCrowdDt);
    advance(*model, params, IkMode::robust, kCrowdDt, state, pose);
    for (int i = 0; i < 3; ++i) expect_same_pose(pose, crowd.local(i), crowd.root_m(i), i, tick);
  }
}

// The members are in all stages at once: some stand, others walk, turn, limp, climb.
TEST(Crowd, ItsMembersDoDifferentThings) {
  MadeCrowd made(kMembers);
  std::array<int, 3> stages{};
  int climbed = 0, turned = 0;
  for (int tick = 0; tick < kTicks; ++tick) made.step(tick);
  for (int i = 0; i < kMembers; ++i) {
    const WalkFrame& frame = made.crowd().frame(i);
    ++stages[static_cast<std::size_t>(frame.stage)];
    climbed += std::abs(frame.heel_ground_m[0]) > 0.1;
    turned += std::abs(frame.heading_rad) > 1.0;
  }
  for (const int count : stages) EXPECT_GT(count, 0);
  EXPECT_GT(climbed, 4);
  EXPECT_GT(turned, 8);
}

TEST(Crowd, HasTheSameBitsForEveryWidth) {
  const std::uint64_t narrow = hash_with(1);
  for (const int lanes : {4, 8, 16}) {
    if (lanes <= widest_lanes()) {
      EXPECT_EQ(hash_with(lanes), narrow) << lanes << " lanes";
    }
  }
}

// The hash of a crowd whose members walk, stand and turn on the spot by chance, some of them far
// away, computed with this number of lanes.
std::uint64_t hash_by_chance(const std::shared_ptr<const WalkModel>& model, int lanes) {
  use_lanes(lanes);
  Crowd crowd(std::vector<CrowdMember>(16, CrowdMember{model, vec3(0.0)}));
  std::mt19937 chance(1);
  std::vector<Stick> sticks(16);
  WordHash hash;
  for (int tick = 0; tick < 15 * kCrowdRate; ++tick) {
    for (int i = 0; i < crowd.size(); ++i) {
      if (chance() % 100 == 0) {
        const double by = 0.25 * static_cast<int>(chance() % 9) - 1.0;
        const vec2 lefts[] = {vec2(0.0), vec2(0.0, by), vec2(by, 0.0)};
        sticks[i].left = lefts[chance() % 3];
      }
      if (chance() % 200 == 0)
        crowd.set_detail(i, chance() % 2 == 0 ? Detail::tables : Detail::full);
      crowd.params()[i] = gait_params(sticks[i], StyleValues{}, gait_limits(*model));
    }
    crowd.advance(kCrowdDt);
    for (int i = 0; i < crowd.size(); ++i) {
      for (const quat& turn : crowd.local(i)) {
        for (int k = 0; k < 4; ++k) hash.add(turn[k]);
      }
    }
  }
  use_lanes(widest_lanes());
  return hash.value();
}

// Zeros keep their signs, too: what a turn on the spot adds is not added in the other walks of its
// block.
TEST(Crowd, ByChanceHasTheSameBitsForEveryWidth) {
  const auto model =
      std::make_shared<const WalkModel>(value_of(walk_model(clean_cycle(procedural_gait()), {})));
  const std::uint64_t narrow = hash_by_chance(model, 1);
  for (const int lanes : {4, 8, 16}) {
    if (lanes <= widest_lanes()) {
      EXPECT_EQ(hash_by_chance(model, lanes), narrow) << lanes << " lanes";
    }
  }
}

TEST(Crowd, HasTheSameBitsForBlocksOnSeveralThreads) {
  MadeCrowd one(kMembers), shared(kMembers);
  for (int tick = 0; tick < 5 * kCrowdRate; ++tick) {
    one.step(tick);
    shared.command(tick);
    std::atomic<int> next = 0;
    const auto work = [&] {
      for (int block = next++; block < shared.crowd().blocks(); block = next++)
        shared.crowd().advance_block(block, kCrowdDt);
    };
    std::jthread a(work), b(work);
  }
  WordHash hash_one, hash_shared;
  one.add_to(hash_one);
  shared.add_to(hash_shared);
  EXPECT_EQ(hash_one.value(), hash_shared.value());
}

TEST(Crowd, PutsAMemberBack) {
  MadeCrowd made(3);
  Pose at_first;
  made.crowd().copy_pose(1, at_first);
  for (int tick = 0; tick < 5 * kCrowdRate; ++tick) made.step(tick);
  const vec3 other_m = made.crowd().root_m(2);
  made.crowd().restart(1, made.members()[1].place_m);
  expect_same_pose(at_first, made.crowd().local(1), made.crowd().root_m(1), 1, 0);
  EXPECT_EQ(made.crowd().root_m(2), other_m);
}

// All members share a block, and each keeps its own report.
TEST(Crowd, PuttingAMemberBackLeavesTheReportsOfTheOthers) {
  const auto model = std::make_shared<const WalkModel>(
      value_of(walk_model(value_of(with_clean_strides(procedural_gait())), {})));
  Crowd crowd(std::vector<CrowdMember>(4, CrowdMember{model, vec3(0.0)}));
  for (GaitParams& params : crowd.params())
    params = gait_params({.left = vec2(0.3, 0.8)}, StyleValues{}, gait_limits(*model));
  for (int tick = 0; tick < 3 * kCrowdRate; ++tick) crowd.advance(kCrowdDt);
  const WalkFrame before = crowd.frame(0);
  crowd.restart(1, vec3(5.0, 0.0, 0.0));
  const WalkFrame after = crowd.frame(0);
  EXPECT_GT(glm::length(before.root_moved_m), 0.005);
  EXPECT_EQ(after.root_moved_m, before.root_moved_m);
  EXPECT_EQ(after.root_turned_rad, before.root_turned_rad);
  EXPECT_EQ(after.speed_m_s, before.speed_m_s);
  EXPECT_EQ(crowd.frame(1).root_moved_m, vec3(0.0));
}

// Pushes and stepping stones at many moments: members answer as they would alone, to the bit.
TEST(Crowd, PushesAndStepsOfItsMembersAreThoseOfAWalkAlone) {
  constexpr int kSome = 21;
  MadeCrowd made(kSome);
  Crowd& crowd = made.crowd();
  std::vector<WalkState> states(kSome);
  std::vector<Pose> poses(kSome);
  for (int i = 0; i < kSome; ++i)
    states[i] = standing(crowd.model(i), made.members()[i].place_m, poses[i]);
  int pushed = 0, stepped = 0;
  for (int tick = 0; tick < kTicks && !HasFailure(); ++tick) {
    for (int i = 0; i < kSome; ++i) {
      if ((tick + 11 * i) % 47 == 0) {
        const vec3 push_m_s(0.3 * (i % 3 - 1), 0.0, 0.2);
        const bool is_taken = push_walk(push_m_s, states[i]);
        EXPECT_EQ(crowd.push(i, push_m_s), is_taken) << i << ", tick " << tick;
        pushed += is_taken;
      }
      if ((tick + 7 * i) % 59 == 0) {
        const Placement ahead = {
            states[i].root.place_m + 0.5 * heading_direction(states[i].root.heading_rad),
            states[i].root.heading_rad + 0.1};
        const auto alone = nearest_step(crowd.model(i), ahead, states[i]),
                   heel = crowd.nearest_step(i, ahead);
        ASSERT_EQ(heel, alone) << i << ", tick " << tick;
        if (!heel) continue;
        EXPECT_TRUE(step_to(crowd.model(i), *heel, states[i]));
        EXPECT_TRUE(crowd.step_to(i, *heel));
        ++stepped;
      }
    }
    made.step(tick);
    for (int i = 0; i < kSome; ++i) {
      advance(crowd.model(i), crowd.params()[i], IkMode::robust, kCrowdDt, states[i], poses[i]);
      expect_same_pose(poses[i], crowd.local(i), crowd.root_m(i), i, tick);
    }
  }
  EXPECT_GT(pushed, 50);
  EXPECT_GT(stepped, 50);
}

TEST(Crowd, RefusesAPushOrAStepThatIsNone) {
  MadeCrowd made(5);
  Crowd& crowd = made.crowd();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const vec3 push_m_s(0.3, 0.0, 0.0);
  EXPECT_FALSE(crowd.push(1, push_m_s)) << "it stands";
  EXPECT_FALSE(crowd.step_to(1, {}));
  for (int tick = 0; tick < 2 * kCrowdRate; ++tick) made.step(tick);
  ASSERT_TRUE(crowd.push(1, push_m_s));
  for (const int nobody : {-1, 5}) {
    EXPECT_FALSE(crowd.push(nobody, push_m_s));
    EXPECT_FALSE(crowd.nearest_step(nobody, {}));
    EXPECT_FALSE(crowd.step_to(nobody, {}));
  }
  EXPECT_FALSE(crowd.push(1, vec3(nan, 0.0, 0.0)));
  EXPECT_FALSE(crowd.push(1, vec3(0.0, 0.0, 2.0 * kMostPush_m_s)));
  EXPECT_FALSE(crowd.nearest_step(1, {vec3(nan, 0.0, 0.0), 0.0}));
  EXPECT_FALSE(crowd.step_to(1, {crowd.root_m(1) + vec3(0.0, 0.0, 5.0), 0.0}));
}

TEST(Crowd, OfNobodyDoesNothing) {
  Crowd crowd;
  crowd.advance(kCrowdDt);
  EXPECT_EQ(crowd.size(), 0);
  EXPECT_EQ(crowd.blocks(), 0);
}

}  // namespace
}  // namespace gaitpad::test

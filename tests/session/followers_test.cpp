#include "gaitpad/followers.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "gaitpad/replay.h"
#include "session/playback.h"
#include "tests/folders.h"
#include "tests/session/heap_use.h"
#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

SimulationConfig with_crowd(int crowd, int walkers = 1) {
  SimulationConfig config = made_config(walkers);
  config.crowd = crowd;
  return config;
}

// A simulation after a varied walk: standing, straight, curves, commands, unplugging, a reset.
Simulation walked_varied(const SimulationConfig& config, int ticks) {
  Simulation simulation = made_simulation(config);
  for (int tick = 0; tick < ticks; ++tick) simulation.step(made_tick(tick));
  return simulation;
}

vec3 hips_m(const Simulation& simulation, int member) {
  return simulation.followers().crowd().state(member).root.place_m;
}

double on_floor_m(const vec3& a, const vec3& b) { return std::hypot(a.x - b.x, a.z - b.z); }

double least_distance_m(const Simulation& simulation) {
  double least_m = 1e9;
  const int size = simulation.followers().size();
  for (int i = 0; i < size; ++i) {
    for (const Walker& walker : simulation.walkers())
      least_m = std::min(least_m, on_floor_m(hips_m(simulation, i), walker.state.root.place_m));
    for (int j = 0; j < i; ++j)
      least_m = std::min(least_m, on_floor_m(hips_m(simulation, i), hips_m(simulation, j)));
  }
  return least_m;
}

TEST(Followers, StandApartBehindTheFirst) {
  for (const int count : {1, 2, 7, 40, 300}) {
    const Simulation simulation = made_simulation(with_crowd(count, 2));
    ASSERT_EQ(simulation.followers().size(), count);
    for (int i = 0; i < count; ++i) EXPECT_LT(hips_m(simulation, i).z, -0.9) << i;
    EXPECT_GT(least_distance_m(simulation), 0.9) << count;
    double width_m = 0.0;
    for (int i = 0; i < count; ++i)
      width_m = std::max(width_m, std::fabs(hips_m(simulation, i).x + 0.6));
    EXPECT_LT(width_m, 0.75 * std::sqrt(count) + 1.5) << count;
  }
}

TEST(Followers, HaveDifferentBuildsAndStyles) {
  const Simulation simulation = made_simulation(with_crowd(60));
  std::set<int> styles;
  std::set<double> legs_m;
  for (int i = 0; i < 60; ++i) {
    styles.insert(simulation.followers().style(i));
    legs_m.insert(simulation.followers().model(i)->leg_length_m);
  }
  EXPECT_EQ(styles, (std::set<int>{0, 1}));
  EXPECT_GE(legs_m.size(), 12u);
  EXPECT_GT(*legs_m.begin(), 0.82 * 0.84);
  EXPECT_LT(*legs_m.rbegin(), 1.19 * 0.84);
}

// The stick walks, turns both ways and stops; commands change and reset the first character.
TEST(Followers, KeepTheirPlacesWhileTheFirstWalksAndTurns) {
  Simulation simulation = made_simulation(with_crowd(40));
  for (int tick = 0; tick < 3000; ++tick) {
    simulation.step(made_tick(tick));
    if (tick % 60 != 0) continue;
    // Metres; nearer members would touch at the shoulders.
    EXPECT_GT(least_distance_m(simulation), 0.5) << tick;
    const Walker& first = simulation.walkers().front();
    for (int i = 0; i < 40; ++i) {
      const vec3 way_m = hips_m(simulation, i) - simulation.followers().start_m(i);
      ASSERT_LT(on_floor_m(way_m, first.state.root.place_m), 0.9) << tick << " " << i;
    }
  }
}

TEST(Followers, PosesAreTheSameInEachRunAndForAnyNumberOfThreads) {
  SimulationConfig config = with_crowd(70);
  const std::uint64_t hash = walked_varied(config, 900).pose_hash();
  EXPECT_EQ(walked_varied(config, 900).pose_hash(), hash);
  for (const int threads : {2, 64}) {
    config.crowd_threads = threads;
    EXPECT_EQ(walked_varied(config, 900).pose_hash(), hash) << threads;
  }
}

TEST(Followers, ChangeTheHashButNotTheWalkers) {
  const Simulation alone = walked_varied(made_config(2), 1200);
  const Simulation followed = walked_varied(with_crowd(3, 2), 1200);
  EXPECT_NE(alone.pose_hash(), followed.pose_hash());
  for (std::size_t w = 0; w < 2; ++w) {
    const Pose &a = alone.walkers()[w].pose, &b = followed.walkers()[w].pose;
    EXPECT_EQ(a.root_m, b.root_m);
    for (int j = 0; j < a.joint_count; ++j) EXPECT_EQ(a.local[j], b.local[j]);
  }
}

TEST(Followers, ACopyGoesOnAsTheOriginalDoes) {
  Simulation simulation = walked(with_crowd(10), 0x80, 0x10, 300);
  Simulation copy = simulation;
  step(simulation, {}, 200);
  step(copy, {}, 200);
  EXPECT_EQ(copy.pose_hash(), simulation.pose_hash());
}

TEST(Followers, AResetOfTheFirstPutsThemBack) {
  Simulation simulation = walked(with_crowd(10, 2), 0x80, 0x10, 600);
  step(simulation, {made_command("reset 2")});
  EXPECT_GT(on_floor_m(hips_m(simulation, 4), simulation.followers().start_m(4)), 0.5);
  step(simulation, {made_report(0x80, 0x80), made_command("reset")});
  for (int i = 0; i < 10; ++i)
    EXPECT_LT(on_floor_m(hips_m(simulation, i), simulation.followers().start_m(i)), 1e-3);
}

TEST(Followers, StandOnTheTerrain) {
  SimulationConfig config = made_uneven_config(1);
  config.crowd = 12;
  Simulation simulation = made_simulation(config);
  for (int tick = 0; tick < 4000; ++tick) {
    simulation.step(tick == 0 ? std::vector<Report>{made_report(0x80, 0x20)}
                              : std::vector<Report>{});
    for (int i = 0; i < 12; ++i) {
      const WalkFrame frame = simulation.followers().crowd().frame(i);
      for (const Side side : {kLeftSide, kRightSide}) {
        if (!frame.toe_planted[side]) continue;
        ASSERT_NEAR(frame.toe_m[side].y, frame.toe_ground_m[side], 0.05) << tick << " " << i;
      }
    }
  }
  EXPECT_GT(hips_m(simulation, 0).z, 3.0);
}

TEST(Followers, MoreThanThereIsRoomForAreAnError) {
  for (const int count : {-1, kMaxFollowers + 1}) {
    const auto simulation = Simulation::create(with_crowd(count));
    ASSERT_FALSE(simulation);
    EXPECT_NE(simulation.error().message.find("0 to 100000"), std::string::npos)
        << simulation.error().message;
  }
}

TEST(Followers, AStepAndACopyOfItsFrameUseNoHeap) {
  Simulation simulation = made_simulation(with_crowd(20));
  auto frame = std::make_unique<SessionFrame>();
  copy_frame(simulation, *frame);
  begin_counting_heap_use();
  for (int tick = 0; tick < 600; ++tick) {
    simulation.step(std::span<const Report>());
    copy_frame(simulation, *frame);
  }
  EXPECT_EQ(heap_uses(), 0);
}

TEST(Followers, AFrameHoldsThePosesOfTheLastTwoTicks) {
  Simulation simulation = walked(with_crowd(5), 0x80, 0x10, 500);
  SessionFrame before, now;
  copy_frame(simulation, before);
  step(simulation, {});
  copy_frame(simulation, now);
  const Crowd& crowd = simulation.followers().crowd();
  ASSERT_EQ(now.crowd.root_m.size(), 5u);
  EXPECT_EQ(now.crowd.root_before_m, before.crowd.root_m);
  EXPECT_EQ(now.crowd.before, before.crowd.local);
  EXPECT_NE(now.crowd.local, before.crowd.local);
  std::size_t joint = 0;
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(now.crowd.root_m[static_cast<std::size_t>(i)], crowd.root_m(i));
    for (const quat& q : crowd.local(i)) {
      EXPECT_NEAR(now.crowd.local[joint][0], q.x, 1e-6);
      EXPECT_NEAR(now.crowd.local[joint++][3], q.w, 1e-6);
    }
  }
  EXPECT_EQ(now.crowd.local.size(), joint);
}

SessionSpec round_with_crowd(int crowd) {
  SessionSpec spec;
  spec.config_folders = {kSourceFolder + "/config"};
  spec.replay.trace = kSourceFolder + "/config/traces/round.hid";
  spec.walk.crowd = crowd;
  return spec;
}

TEST(Followers, APlaybackThatJumpsHasTheHashOfTheReplay) {
  const SessionSpec spec = round_with_crowd(4);
  const auto replayed = replay(spec);
  ASSERT_TRUE(replayed) << replayed.error().message;
  EXPECT_EQ(replayed->summary.crowd, 4);
  auto playback = Playback::open(spec);
  ASSERT_TRUE(playback) << playback.error().message;
  const std::int64_t last = (*playback)->ticks() - 1;
  for (const std::int64_t tick : {last / 2, last / 5, last}) {
    while (!(*playback)->seek(tick, 5000)) {
    }
  }
  EXPECT_EQ((*playback)->pose_hash(), replayed->summary.pose_hash);
}

}  // namespace
}  // namespace gaitpad

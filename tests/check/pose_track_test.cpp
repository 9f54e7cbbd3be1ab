#include "check/pose_track.h"

#include <gtest/gtest.h>

#include <random>
#include <set>

#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

constexpr int kRateHz = 240, kTicks = 700, kPlanted = 400;

// A walk of two characters. `command`, if there is one, is given in tick kPlanted.
struct Walked {
  PoseTrack poses;
  std::vector<std::uint64_t> hashes;       // the pose hash after each tick
  std::vector<std::array<Pose, 2>> exact;  // the poses of 20 ticks from kPlanted on
  std::vector<std::string> joints;         // names of one character's joints
};
Walked walked_with(const std::string& command, int crowd = 0) {
  SimulationConfig config = made_config(2);
  config.crowd = crowd;
  Simulation simulation = made_simulation(config);
  Walked walked{PoseTrack(simulation, kRateHz, kTicks), {}, {}, {}};
  for (const Joint& joint : simulation.walkers()[0].model->cycle.skeleton.joints)
    walked.joints.push_back(joint.name);
  for (int tick = 0; tick < kTicks; ++tick) {
    std::vector<Report> reports;
    if (tick == 10) reports.push_back(made_report(0x80, 0x10));
    if (tick == kPlanted && !command.empty()) reports.push_back(made_command(command));
    simulation.step(reports);
    walked.poses.add(simulation);
    walked.hashes.push_back(simulation.pose_hash());
    if (tick >= kPlanted && tick < kPlanted + 20)
      walked.exact.push_back({simulation.walkers()[0].pose, simulation.walkers()[1].pose});
  }
  return walked;
}

PoseDifference found_between(const PoseTrack& before, const PoseTrack& after) {
  const auto found = value_of(difference(before, after));
  EXPECT_TRUE(found);
  return found.value_or(PoseDifference{});
}

TEST(PoseTrack, ReadsWhatItWrote) {
  const Walked walked = walked_with("");
  const std::string bytes = walked.poses.bytes();
  const PoseTrack read = value_of(PoseTrack::parse(bytes, "x"));
  EXPECT_EQ(read.rate_hz(), kRateHz);
  EXPECT_EQ(read.ticks(), kTicks);
  EXPECT_EQ(read.kept(), static_cast<std::size_t>(kTicks));
  EXPECT_EQ(read.pose_hash(), walked.hashes.back());
  ASSERT_EQ(read.channels().size(), walked.poses.channels().size());
  for (std::size_t c = 0; c < read.channels().size(); ++c) {
    const PoseChannel &a = read.channels()[c], &b = walked.poses.channels()[c];
    EXPECT_EQ(a.character, b.character);
    EXPECT_EQ(a.joint, b.joint);
    EXPECT_EQ(a.prints, b.prints);
    EXPECT_EQ(a.values, b.values);
  }
  EXPECT_EQ(read.bytes(), bytes);
  EXPECT_FALSE(value_of(difference(read, walked.poses)));
}

TEST(PoseTrack, ShowsRotationsAndPlacesWithinItsSteps) {
  const Walked walked = walked_with("");
  const Pose& pose = walked.exact.front()[0];
  const auto& channels = walked.poses.channels();
  EXPECT_LE(glm::length(shown_value(channels[0], kPlanted) - pose.root_m), 1e-4);
  for (int j = 0; j < pose.joint_count; ++j) {
    const vec3 exact_deg = 57.29577951308232 * rotation_vector(pose.local[j]);
    EXPECT_LE(glm::length(shown_value(channels[j + 1], kPlanted) - exact_deg), 0.02) << j;
  }
}

// The first difference is known from the walk's own hashes (tick) and its exact rotations (joint).
TEST(PoseTrack, FindsTheFirstTickAndJointThatDiffer) {
  for (const char* command : {"style 2 even", "set 2 legs.weight.knee 0.2", "reset"}) {
    const Walked before = walked_with(""), after = walked_with(command);
    std::size_t first = 0;
    while (first < kTicks && before.hashes[first] == after.hashes[first]) ++first;
    ASSERT_LT(first, kPlanted + 20u) << command;
    ASSERT_GE(first, static_cast<std::size_t>(kPlanted)) << command;
    std::set<std::size_t> differing;
    const auto &a = before.exact[first - kPlanted], &b = after.exact[first - kPlanted];
    const std::size_t channels = before.joints.size() + 1;
    for (std::size_t c = 0; c < 2; ++c) {
      if (a[c].root_m != b[c].root_m) differing.insert(c * channels);
      for (std::size_t j = 0; j < before.joints.size(); ++j)
        if (a[c].local[j] != b[c].local[j]) differing.insert(c * channels + 1 + j);
    }
    const PoseDifference d = found_between(before.poses, after.poses);
    EXPECT_EQ(d.first.tick, first) << command;
    EXPECT_TRUE(differing.contains(d.first.channel)) << command;
    EXPECT_EQ(static_cast<std::size_t>(d.others) + 1, differing.size()) << command;
    EXPECT_GE(d.largest.distance, d.first.distance) << command;
    EXPECT_GT(d.largest.distance, 0.5) << command;
  }
}

TEST(PoseTrack, TellsByHowManyDegreesAJointIsOff) {
  PoseChannel a{1, "LeftLeg", {1}, {{{0}, {0}, {0}}}};
  PoseChannel b = a;
  b.values[1][0] = 2856;  // 16384 * sin(20.08 degrees / 2)
  EXPECT_NEAR(distance_of(a, b, 0), 20.08, 0.01);
  a.joint = b.joint = "";
  EXPECT_NEAR(distance_of(a, b, 0), 0.2856, 1e-9);
}

TEST(PoseTrack, CoversTheCrowd) {
  const Walked before = walked_with("", 2), after = walked_with("reset", 2);
  const PoseChannel &a = before.poses.channels().back(), &b = after.poses.channels().back();
  EXPECT_EQ(a.character, 0);
  for (std::size_t tick = 0; tick < kTicks; ++tick)
    ASSERT_EQ(a.prints[tick] == b.prints[tick], tick < kPlanted) << tick;
}

TEST(PoseTrack, OtherJointsAreNoDifferenceButAnError) {
  const Walked before = walked_with(""), after = walked_with("", 1);
  const auto found = difference(before.poses, after.poses);
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().message, "the characters have other joints than the poses that are kept");
}

// Two bits of a zlib header tell the level of compression (RFC 1950, FLEVEL). A file that differs
// in them alone, with a matching check of the header, is valid and holds the same poses.
TEST(PoseTrack, RefusesDamageInOneSentence) {
  const std::string bytes = walked_with("").poses.bytes();
  std::mt19937 random(7);
  for (int i = 0; i < 300; ++i) {
    std::string damaged = bytes;
    if (i % 3 == 0) damaged.resize(random() % bytes.size());
    if (i % 3 != 0)
      damaged[random() % std::min<std::size_t>(bytes.size(), i % 3 == 1 ? 64 : 1u << 20)] ^=
          1 + random() % 255;
    const auto read = PoseTrack::parse(damaged, "x.expect.poses");
    if (read)
      EXPECT_EQ(read->bytes(), bytes);
    else
      EXPECT_EQ(read.error().message.substr(0, 15), "x.expect.poses:");
  }
}

TEST(PoseTrack, ReadsAFileThatSaysItWasCompressedHarder) {
  std::string bytes = walked_with("").poses.bytes();
  constexpr std::size_t kHeader = 24;  // bytes of the first line and the length
  ASSERT_EQ(bytes.substr(kHeader, 2), "\x78\x9c");
  const std::string written = bytes;
  bytes[kHeader + 1] = '\xda';
  const auto read = PoseTrack::parse(bytes, "x");
  ASSERT_TRUE(read);
  EXPECT_EQ(read->bytes(), written);
}

TEST(PoseTrack, ReservesNothingForWhatAFileMerelyClaims) {
  std::string bytes = walked_with("").poses.bytes().substr(0, 40);
  for (std::size_t i = 16; i < 24; ++i) bytes[i] = '\x7f';  // damages the length before compression
  EXPECT_FALSE(PoseTrack::parse(bytes, "x"));
}

}  // namespace
}  // namespace gaitpad

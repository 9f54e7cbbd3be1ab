#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/walk/made_walker.h"

namespace gaitpad {
namespace {

constexpr int kMinute = 60 * kRate;

// Measures of a minute's stand, from its fifth second on, when the idle movement has its full size.
struct Stood {
  std::vector<vec3> hips_m;
  std::vector<double> breath_rad, glance_rad;
};
// How far a joint has turned from the standing pose, in the world.
quat turned(const MadeWalker& walker, int joint, const quat& standing) {
  static JointFrames frames;
  forward_kinematics(walker.model().cycle.skeleton, walker.pose(), frames);
  return frames.rotation[joint] * glm::conjugate(standing);
}
// The chest's pitch, backwards positive.
double trunk_rad(const MadeWalker& walker) {
  const UpperBodyModel& body = walker.model().body;
  const int chest = body.head_path[static_cast<std::size_t>(body.neck_at) - 1];
  const vec3 up = turned(walker, chest, body.chest_standing) * kUp;
  return -std::atan2(up.z, up.y);
}
double glance_rad(const MadeWalker& walker) {
  const UpperBodyModel& body = walker.model().body;
  const double rad =
      heading_of(turned(walker, body.head_path.back(), body.head_standing) * kForward);
  return std::abs(rad) < 1e-6 ? 0.0 : rad;
}
Stood stand(MadeWalker& walker, int ticks, const StyleValues& style = {}) {
  Stood stood;
  for (int i = 0; i < ticks; ++i) {
    walker.walk(0, 0, 1, style);
    if (i < 5 * kRate) continue;
    stood.hips_m.push_back(walker.last().pelvis_m);
    stood.breath_rad.push_back(trunk_rad(walker));
    stood.glance_rad.push_back(glance_rad(walker));
  }
  return stood;
}

// Winter 1995: the centre of pressure of quiet stance sways with a standard deviation of 3 to 5 mm;
// the hips sway less.
TEST(Idle, HipsSwayByMillimetresOverPlantedFeet) {
  MadeWalker walker;
  const Stood stood = stand(walker, kMinute);
  vec3 mean(0.0), squares(0.0);
  for (const vec3& p : stood.hips_m) mean += p / double(stood.hips_m.size());
  for (const vec3& p : stood.hips_m)
    squares += (p - mean) * (p - mean) / double(stood.hips_m.size());
  for (const double square : {squares.x, squares.z}) {
    EXPECT_GT(std::sqrt(square), 1.5e-3);
    EXPECT_LT(std::sqrt(square), 5e-3);
  }
  EXPECT_LT(walker.drift_m(), 1e-6);
  EXPECT_LT(walker.sharpest_turn_rad(), 0.02 * kDegree);
  EXPECT_EQ(walker.last().stage, Stage::idle);
}

// People breathe 12 to 18 times a minute when they rest.
TEST(Idle, BreathesAsPeopleAtRest) {
  MadeWalker walker;
  const Stood stood = stand(walker, kMinute + 5 * kRate);
  int breaths = 0;
  const double half = 0.5 * *std::ranges::max_element(stood.breath_rad);
  EXPECT_GT(half, 0.2 * kDegree);
  for (std::size_t i = 1; i < stood.breath_rad.size(); ++i)
    breaths += stood.breath_rad[i - 1] < half && stood.breath_rad[i] >= half;
  EXPECT_GE(breaths, 12);
  EXPECT_LE(breaths, 18);
}

TEST(Idle, GlancesToBothSidesNowAndThen) {
  MadeWalker walker;
  const Stood stood = stand(walker, kMinute);
  const auto [right, left] = std::ranges::minmax_element(stood.glance_rad);
  EXPECT_LT(*right, -8.0 * kDegree);
  EXPECT_GT(*left, 8.0 * kDegree);
  const auto ahead = std::ranges::count(stood.glance_rad, 0.0);
  EXPECT_GT(ahead, std::ssize(stood.glance_rad) / 2);
}

TEST(Idle, EndsWithinASecondWhenAWalkBegins) {
  MadeWalker walker;
  walker.walk(0, 0, kMinute / 4);
  EXPECT_GT(std::abs(walker.state().walk.styled.idle_share), 0.9);
  walker.walk(0, 0.8, kRate);
  EXPECT_EQ(walker.state().walk.styled.idle_share, 0.0);
  EXPECT_LT(walker.sharpest_turn_rad(), 1.2 * kDegree);
}

TEST(Idle, GoesOnWhereAWalkBeginsWithEitherFoot) {
  for (const double x : {-0.7, 0.7}) {
    MadeWalker walker;
    walker.walk(0, 0, kMinute / 4);
    vec3 hips_m = walker.last().pelvis_m;
    double glanced_rad = glance_rad(walker);
    for (int i = 0; i < kRate / 10; ++i) {
      walker.walk(x, 0.7, 1);
      EXPECT_LT(glm::distance(walker.last().pelvis_m, hips_m), 1e-3);
      EXPECT_NEAR(glance_rad(walker), glanced_rad, 0.5 * kDegree);
      hips_m = walker.last().pelvis_m, glanced_rad = glance_rad(walker);
    }
  }
}

TEST(Idle, AStyleAndPaperModeLeaveItOut) {
  StyleValues still;
  still.body.idle = 0.0;
  MadeWalker statue, paper(adult(), IkMode::paper);
  for (MadeWalker* walker : {&statue, &paper}) {
    const Stood stood = stand(*walker, 8 * kRate, still);
    for (const vec3& p : stood.hips_m) EXPECT_LT(glm::distance(p, stood.hips_m[0]), 1e-9);
    EXPECT_LT(*std::ranges::max_element(stood.breath_rad), 1e-9);
  }
}

// The foot that landed last is the other one, so the stand is mirrored as well.
TEST(Idle, MirroredWalksEndInMirroredStands) {
  MadeWalker left, right;
  for (const auto& [walker, sign] : {std::pair{&left, -1.0}, std::pair{&right, 1.0}})
    walker->walk(sign, 0, kRate);
  const Stood a = stand(left, kMinute / 2), b = stand(right, kMinute / 2);
  for (std::size_t i = 0; i < a.hips_m.size(); ++i) {
    ASSERT_NEAR(a.hips_m[i].x, -b.hips_m[i].x, 1e-6);
    ASSERT_NEAR(a.hips_m[i].z, b.hips_m[i].z, 1e-6);
    ASSERT_EQ(a.glance_rad[i], -b.glance_rad[i]);
  }
}

}  // namespace
}  // namespace gaitpad

// Compares a mannequin's measures with people's and with the skeleton's, and its position with
// forward kinematics and with the walk's samples, which the drawing does not read.
#include "scene/mannequin.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "gaitpad/control.h"
#include "gaitpad/motion_file.h"
#include "gaitpad/walk.h"
#include "motion/made_motion.h"
#include "tests/clean_cycle.h"
#include "tests/shared_data.h"
#include "tests/value_of.h"

namespace gaitpad {
namespace {

std::shared_ptr<const WalkModel> model_of(const GaitCycle& cycle, const Character& character = {}) {
  return std::make_shared<const WalkModel>(value_of(walk_model(clean_cycle(cycle), character)));
}

// Lowest height of a hull of two balls that are stretched along `wide`.
double lowest_m(const Capsule& c) {
  const auto below = [&c](const vec3& at, double radius_m, vec3 wide, double width) {
    const vec3 along = c.b_m - c.a_m;
    if (glm::length(along) > 1e-9) wide -= along * (glm::dot(wide, along) / glm::dot(along, along));
    if (glm::length(wide) > 1e-9) wide = glm::normalize(wide);
    const double upright = wide.y * wide.y * (width * width - 1.0);
    return at.y - radius_m * std::sqrt(1.0 + std::max(upright, 0.0));
  };
  return std::min(below(c.a_m, c.radius_a_m, c.wide, c.width_a),
                  below(c.b_m, c.radius_b_m, c.wide_b, c.width_b));
}

double lowest_m(const std::vector<Capsule>& capsules) {
  double lowest = 1e9;
  for (const Capsule& c : capsules) lowest = std::min(lowest, lowest_m(c));
  return lowest;
}
constexpr double kTouch_m = 1e-5;
// The solver treats the floor of a captured stride as a soft one-sided row: a flying toe that
// touches it is at most 0.22 mm too low, a twentieth of a pixel at the window's usual distance.
constexpr double kGraze_m = 3e-4;

std::vector<Capsule> posed(const Mannequin& mannequin, const Pose& pose) {
  SceneContent content;
  add_mannequin(mannequin, pose, nullptr, rgb(0x56b4e9), content);
  return content.capsules;
}

// Walks for two seconds and passes every tenth pose to `look`.
template <class Look>
void walk(const WalkModel& model, double turn, Look look) {
  Pose pose;
  WalkState state = standing(model, vec3(0.0), pose);
  look(pose);
  Stick stick;
  stick.left = {turn, 0.9};
  const GaitParams params = gait_params(stick, StyleValues{}, gait_limits(model));
  for (int tick = 0; tick < 480; ++tick) {
    advance(model, params, IkMode::robust, 1.0 / 240.0, state, pose);
    if (tick % 10 == 0) look(pose);
  }
}

// World positions of the joints, the feet on the floor.
JointFrames standing_frames(const WalkModel& model) {
  Pose pose;
  standing(model, vec3(0.0), pose);
  JointFrames frames;
  forward_kinematics(model.cycle.skeleton, pose, frames);
  return frames;
}

void expect_plausible(const Mannequin& mannequin) {
  const double leg_m = mannequin.model->leg_length_m;
  EXPECT_GT(mannequin.bones.size(), 30u);
  // People: 1.9 to 2.1 leg lengths; in some clips they bend far forward.
  EXPECT_GT(mannequin.height_m, 1.55 * leg_m);
  EXPECT_LT(mannequin.height_m, 2.3 * leg_m);
  const JointFrames standing = standing_frames(*mannequin.model);
  const UpperBodyJoints& joints = mannequin.model->body.joints;
  const auto height = [&standing](int joint) { return standing.position_m[joint].y; };
  for (const ArmChain& arm : joints.arm) {
    ASSERT_TRUE(arm.is_found());
    EXPECT_NE(arm.shoulder, arm.elbow);
    EXPECT_NE(arm.elbow, arm.wrist);
    EXPECT_GT(height(arm.shoulder), height(arm.wrist));
  }
  EXPECT_GT(standing.position_m[joints.arm[kLeftSide].shoulder].x,
            standing.position_m[joints.arm[kRightSide].shoulder].x + 0.2 * leg_m);
  double widest_m = 0.0;
  for (const MannequinBone& bone : mannequin.bones) {
    for (const double r : {bone.radius_from_m, bone.radius_to_m}) {
      EXPECT_GT(r, 0.004 * leg_m);
      EXPECT_LT(r, 0.16 * leg_m);
    }
    widest_m = std::max(widest_m, bone.radius_from_m * bone.width_from);
  }
  EXPECT_LT(widest_m, 0.27 * leg_m);
}

TEST(Mannequin, TheProceduralOneIsAPersonsSize) {
  const Mannequin mannequin = mannequin_of(model_of(procedural_gait()));
  expect_plausible(mannequin);
  const Skeleton& skeleton = mannequin.model->cycle.skeleton;
  const JointFrames standing = standing_frames(*mannequin.model);
  const UpperBodyJoints& joints = mannequin.model->body.joints;
  EXPECT_EQ(skeleton.joints[joints.head].name, "Head");
  EXPECT_EQ(skeleton.joints[joints.arm[kLeftSide].elbow].name, "LeftForeArm");
  EXPECT_EQ(skeleton.joints[joints.arm[kRightSide].wrist].name, "RightHand");
  // The skeleton has a joint at the top of the head.
  EXPECT_NEAR(mannequin.height_m, standing.position_m[skeleton.find("Head_End")].y, 0.05);
}

// A place on the skin of a standing body, and the two joints of its bone.
struct Spot {
  vec3 at_m{0.0};
  int from = 0, to = 0;
};
std::vector<Spot> skin(const Mannequin& mannequin) {
  constexpr int kAlong = 32, kRound = 40, kUpwards = 16;
  Pose pose;
  standing(*mannequin.model, vec3(0.0), pose);
  const std::vector<Capsule> capsules = posed(mannequin, pose);
  std::vector<Spot> spots;
  for (std::size_t i = 0; i < capsules.size(); ++i) {
    const Capsule& c = capsules[i];
    const vec3 axis = glm::normalize(c.b_m - c.a_m + kUp * 1e-9);
    vec3 side = c.wide - axis * glm::dot(c.wide, axis);
    if (glm::length(side) < 1e-6) side = glm::cross(axis, kForward);
    side = glm::normalize(side);
    const vec3 deep = glm::cross(axis, side);
    for (int k = 0; k <= kAlong; ++k) {
      const double share = static_cast<double>(k) / kAlong;
      const double radius_m = mix(c.radius_a_m, c.radius_b_m, share),
                   width = mix(c.width_a, c.width_b, share);
      for (int r = 0; r < kRound; ++r) {
        for (int u = 0; u <= kUpwards; ++u) {
          const double turn = 2.0 * kPi * r / kRound;
          const double rise = kPi * (static_cast<double>(u) / kUpwards - 0.5);
          const vec3 out = side * (std::cos(rise) * std::cos(turn) * width) +
                           deep * (std::cos(rise) * std::sin(turn)) + axis * std::sin(rise);
          spots.push_back({glm::mix(c.a_m, c.b_m, share) + out * radius_m, mannequin.bones[i].from,
                           mannequin.bones[i].to});
        }
      }
    }
  }
  return spots;
}

// Sizes of adults in fractions of their height. D: Drillis and Contini 1966, as in Winter 2009,
// figure 4.1 (breadths and lengths of segments); G: Gordon et al. 1989, mean of men's and women's
// means (breadths, depths, and girths / pi).
TEST(Mannequin, TheProceduralOneHasAPersonsProportions) {
  const Mannequin mannequin = mannequin_of(model_of(procedural_gait()));
  const std::vector<Spot> spots = skin(mannequin);
  const UpperBodyJoints& joints = mannequin.model->body.joints;
  const JointFrames standing = standing_frames(*mannequin.model);
  const LegJoints& leg = mannequin.model->leg[kLeftSide].model.joints;
  const ArmChain& arm = joints.arm[kLeftSide];
  const double height_m = mannequin.height_m;
  const auto y = [&](int joint) { return standing.position_m[joint].y; };
  const auto is_of = [](const Spot& s, std::initializer_list<int> all) {
    return std::ranges::find(all, s.from) != all.end() || std::ranges::find(all, s.to) != all.end();
  };
  const auto is_arm = [&](const Spot& s) {
    const ArmChain& right = joints.arm[kRightSide];
    return is_of(s, {arm.shoulder, arm.elbow, arm.wrist, right.shoulder, right.elbow, right.wrist});
  };
  // Extent of the selected spots along a direction, over the height.
  const auto extent = [&](const vec3& along, auto&& is_meant) {
    double low = 1e9, high = -1e9;
    for (const Spot& s : spots) {
      if (!is_meant(s)) continue;
      low = std::min(low, glm::dot(s.at_m, along));
      high = std::max(high, glm::dot(s.at_m, along));
    }
    return (high - low) / height_m;
  };
  // Breadths of the body in slices at these heights.
  const auto breadths = [&](const vec3& along, double from_m, double to_m, auto&& is_meant) {
    constexpr double kHalfSlice_m = 0.006;
    std::vector<double> all;
    for (double at_m = from_m; at_m <= to_m; at_m += 0.01) {
      all.push_back(extent(along, [&](const Spot& s) {
        return std::abs(s.at_m.y - at_m) < kHalfSlice_m && is_meant(s);
      }));
    }
    return all;
  };
  const auto least = [](const std::vector<double>& v) { return std::ranges::min(v); };
  const auto most = [](const std::vector<double>& v) { return std::ranges::max(v); };
  const auto is_trunk = [&](const Spot& s) { return !is_arm(s) && !is_of(s, {leg.knee}); };

  double chin_m = height_m;
  for (const Spot& s : spots) {
    const bool is_face = s.from == joints.head && s.at_m.z > 0.065;
    if (is_face) chin_m = std::min(chin_m, s.at_m.y);
  }
  const double shoulder_m = y(arm.shoulder), hip_m = y(leg.hip);
  const auto at_trunk = [&](double share) { return mix(hip_m, shoulder_m, share); };
  const std::vector<double> waist = breadths(kLeft, at_trunk(0.25), at_trunk(0.55), is_trunk),
                            chest = breadths(kLeft, at_trunk(0.6), at_trunk(0.85), is_trunk);
  double crotch_m = height_m;
  for (const Spot& s : spots) {
    const bool is_between = std::abs(s.at_m.x) < 0.001 && s.at_m.y > y(leg.knee) + 0.1;
    if (is_between) crotch_m = std::min(crotch_m, s.at_m.y);
  }
  const auto is_shank = [&](const Spot& s) { return s.from == leg.knee && s.at_m.x > 0.0; };
  const auto is_foot = [&](const Spot& s) {
    return s.at_m.x > 0.0 && (s.from == leg.ankle || s.from == leg.toe);
  };
  const auto is_upper_arm = [&](const Spot& s) { return s.from == arm.shoulder; };
  struct Measure {
    const char* name;
    double drawn, people;
  };
  const Measure measures[] = {
      {"head, chin to top (D)", 1.0 - chin_m / height_m, 0.130},
      {"breadth of the neck (G)",
       least(breadths(kLeft, shoulder_m + 0.05, chin_m + 0.01, is_trunk)), 0.069},
      {"upper arm at the deltoid (G)",
       most(breadths(kForward, shoulder_m - 0.09, shoulder_m - 0.03, is_upper_arm)), 0.073},
      {"breadth of the chest (D)", most(chest), 0.174},
      {"breadth of the waist (G)", least(waist), 0.165},
      {"breadth of the calf (G)",
       most(breadths(kLeft, y(leg.knee) - 0.22, y(leg.knee) - 0.06, is_shank)), 0.068},
      {"crotch (G)", crotch_m / height_m, 0.477},
      {"breadth of the foot (D)", extent(kLeft, is_foot), 0.055},
      {"length of the foot (D)", extent(kForward, is_foot), 0.152},
  };
  for (const Measure& m : measures) {
    EXPECT_NEAR(m.drawn, m.people, 0.07 * m.people) << m.name;
  }
  // Bounds the cost of drawing, which grows with the number of bones.
  EXPECT_LE(mannequin.bones.size(), 39u);
}

// Two parts of a twisted trunk meet with equal thickness, width and direction of width, so that
// there is no gap.
TEST(Mannequin, PartsOfATwistedTrunkMeetInOneSeam) {
  const Mannequin mannequin = mannequin_of(model_of(procedural_gait()));
  const Skeleton& skeleton = mannequin.model->cycle.skeleton;
  Pose pose;
  standing(*mannequin.model, vec3(0.0), pose);
  const int chest = skeleton.find("Chest"), head = skeleton.find("Head");
  pose.local[chest] = rotation_y(0.5) * pose.local[chest];
  const std::vector<Capsule> capsules = posed(mannequin, pose);
  const auto is_trunk = [&](int joint) { return is_ancestor(skeleton, joint, head); };
  int seams = 0;
  for (std::size_t i = 0; i + 1 < capsules.size(); ++i) {
    const Capsule &below = capsules[i], &above = capsules[i + 1];
    const MannequinBone &a = mannequin.bones[i], &b = mannequin.bones[i + 1];
    if (!is_trunk(a.from) || !is_trunk(a.to) || a.to != b.from ||
        glm::distance(below.b_m, above.a_m) > 1e-9)
      continue;
    EXPECT_NEAR(below.radius_b_m, above.radius_a_m, 1e-12);
    EXPECT_NEAR(below.width_b, above.width_a, 1e-12);
    EXPECT_LT(glm::distance(below.wide_b, above.wide), 1e-9);
    ++seams;
  }
  EXPECT_GE(seams, 5);
}

TEST(Mannequin, StandingFeetTouchTheFloorOverTheirWholeLength) {
  const Mannequin mannequin = mannequin_of(model_of(procedural_gait()));
  Pose pose;
  standing(*mannequin.model, vec3(0.0), pose);
  for (const Side side : {kLeftSide, kRightSide}) {
    const LegJoints& joints = mannequin.model->leg[side].model.joints;
    int on_floor = 0;
    for (std::size_t i = 0; i < mannequin.bones.size(); ++i) {
      const MannequinBone& bone = mannequin.bones[i];
      if (bone.to != joints.ankle && bone.to != joints.toe) continue;
      on_floor += std::abs(lowest_m(posed(mannequin, pose)[i])) < 2e-3;
    }
    EXPECT_GE(on_floor, 3);
  }
}

TEST(Mannequin, GrowsWithItsCharacter) {
  const GaitCycle cycle = procedural_gait();
  Character half;
  half.scale = 0.5;
  const Mannequin full = mannequin_of(model_of(cycle)), small = mannequin_of(model_of(cycle, half));
  ASSERT_EQ(full.bones.size(), small.bones.size());
  EXPECT_NEAR(small.height_m, 0.5 * full.height_m, 1e-3);
  for (std::size_t i = 0; i < full.bones.size(); ++i) {
    EXPECT_NEAR(small.bones[i].radius_from_m, 0.5 * full.bones[i].radius_from_m, 1e-6);
  }
}

TEST(Mannequin, ItsBonesMeetTheJointsOfItsPose) {
  const Mannequin mannequin = mannequin_of(model_of(procedural_gait()));
  walk(*mannequin.model, 0.4, [&mannequin](const Pose& pose) {
    JointFrames frames;
    forward_kinematics(mannequin.model->cycle.skeleton, pose, frames);
    const std::vector<Capsule> capsules = posed(mannequin, pose);
    for (const LegBuild& leg : mannequin.model->leg) {
      const vec3 knee_m = frames.position_m[leg.model.joints.knee];
      double nearest_m = 1.0;
      for (const Capsule& c : capsules)
        nearest_m = std::min(nearest_m, glm::distance(c.b_m, knee_m));
      EXPECT_LT(nearest_m, 1e-9);
    }
    const vec3 top_m = head_m(mannequin, pose);
    EXPECT_GT(top_m.y, frames.position_m[mannequin.top].y + 0.15);
    EXPECT_LT(glm::distance(top_m, frames.position_m[mannequin.top]), 0.35);
  });
}

TEST(Mannequin, NothingOfItIsBelowTheFloorWhileItWalksAndTurns) {
  for (const double turn : {0.0, -0.8}) {
    const Mannequin mannequin = mannequin_of(model_of(procedural_gait()));
    walk(*mannequin.model, turn, [&mannequin](const Pose& pose) {
      EXPECT_GE(lowest_m(posed(mannequin, pose)), -kTouch_m);
    });
  }
}

// A skeleton may have legs only.
TEST(Mannequin, WithoutArmsAndHeadTheRestIsDrawn) {
  GaitCycle cycle = procedural_gait();
  ASSERT_EQ(cycle.skeleton.joints[11].name, "Spine");
  keep_legs_alone(cycle);
  const Mannequin mannequin = mannequin_of(model_of(cycle));
  EXPECT_GE(mannequin.bones.size(), 13u);
  walk(*mannequin.model, 0.0, [&mannequin](const Pose& pose) {
    EXPECT_GE(lowest_m(posed(mannequin, pose)), -kTouch_m);
    EXPECT_TRUE(std::isfinite(head_m(mannequin, pose).y));
  });
}

TEST(Mannequin, EveryCapturedSkeletonHasItsArmsAndHeadAndStaysAboveTheFloor) {
  GAITPAD_NEEDS(kCapturedMotions);
  // Each run tests a fifth of them (tests/support/slices.py).
  constexpr std::size_t kSlices = 5;
  const char *all = std::getenv("GAITPAD_ALL"), *slice = std::getenv("GAITPAD_SLICE");
  const bool is_all = all != nullptr && std::string(all) == "1";
  const std::size_t chosen = slice == nullptr ? 0 : std::strtoull(slice, nullptr, 10) % kSlices;
  int walks = 0;
  const auto files = files_in(kCapturedMotions, ".bvh");
  for (std::size_t i = is_all ? 0 : chosen; i < files.size(); i += is_all ? 1 : kSlices) {
    const std::string& file = files[i];
    const auto motion = load_motion(file);
    if (!motion) continue;
    const auto cycle = gait_cycle(*motion);
    if (!cycle) continue;
    SCOPED_TRACE(file);
    const Mannequin mannequin = mannequin_of(model_of(*cycle));
    expect_plausible(mannequin);
    walk(*mannequin.model, 0.3, [&mannequin](const Pose& pose) {
      EXPECT_GE(lowest_m(posed(mannequin, pose)), -kGraze_m);
    });
    ++walks;
  }
  EXPECT_GE(walks, is_all ? 10 : 1);
}

TEST(Interpolate, TurnsTheShorterWayAndMovesStraight) {
  Pose before, pose, shown;
  before.joint_count = pose.joint_count = 2;
  before.root_m = {1.0, 2.0, 3.0};
  pose.root_m = {3.0, 2.0, -1.0};
  before.local[0] = rotation_y(0.2);
  pose.local[0] = rotation_y(0.6);
  before.local[1] = rotation_x(-0.1);
  pose.local[1] = -rotation_x(0.1);  // the same rotation as a quaternion with the other sign
  interpolate(before, pose, 0.5, shown);
  EXPECT_LT(glm::distance(shown.root_m, vec3(2.0, 2.0, 1.0)), 1e-12);
  EXPECT_NEAR(std::abs(glm::dot(shown.local[0], rotation_y(0.4))), 1.0, 1e-9);
  EXPECT_NEAR(std::abs(glm::dot(shown.local[1], kIdentity)), 1.0, 1e-9);
  interpolate(before, pose, 0.0, shown);
  EXPECT_NEAR(std::abs(glm::dot(shown.local[0], before.local[0])), 1.0, 1e-12);
  interpolate(before, pose, 1.0, shown);
  EXPECT_LT(glm::distance(shown.root_m, pose.root_m), 1e-12);
}

double nearest_m(const std::vector<vec3>& places, const vec3& to) {
  double nearest = 1e9;
  for (const vec3& p : places) nearest = std::min(nearest, glm::distance(p, to));
  return nearest;
}

// The samples hold the places of the ankles, without forward kinematics.
TEST(StickFigure, ItsAnklesAreWhereTheSourceHasThem) {
  const GaitCycle cycle = procedural_gait();
  const vec3 place_m(4.0, 7.0, -2.0);
  const double heading_rad = 0.7;
  for (const double phase : {0.0, 0.13, 0.5, 0.77}) {
    SceneContent content;
    add_stick_figure(cycle, phase, 1.0, place_m, heading_rad, rgb(0xffffff), content);
    const CycleSample sample = sample_at(cycle, phase);
    for (const LegSample& leg : sample.leg) {
      const vec3 turned = rotation_y(heading_rad) * leg.ankle_m;
      const vec3 expected = turned + place_m;
      EXPECT_LT(nearest_m(content.joints_m, expected), 3e-3) << phase;
    }
    EXPECT_EQ(content.capsules.size(), 0u);
    EXPECT_GT(content.lines.size(), 12u);
  }
}

TEST(StickFigure, StandsWithBothFeetFlatWhereNothingOfTheWalkShows) {
  const GaitCycle cycle = procedural_gait();
  SceneContent content;
  add_stick_figure(cycle, 0.3, 0.0, vec3(1.0, 0.0, 2.0), 0.0, rgb(0xffffff), content);
  for (const LegModel& leg : cycle.leg) {
    const double ankle_y = -leg.heel_m.y;
    const vec3 ankle = vec3(1.0, ankle_y, 2.0) + vec3(leg.hip_m.x, 0.0, leg.hip_m.z);
    EXPECT_LT(nearest_m(content.joints_m, ankle), 1e-6);
    EXPECT_LT(nearest_m(content.joints_m, ankle + leg.toe_m), 1e-6);
  }
}

}  // namespace
}  // namespace gaitpad

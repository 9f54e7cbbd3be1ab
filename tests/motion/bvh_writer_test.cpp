#include <gtest/gtest.h>

#include <memory>
#include <sstream>

#include "gaitpad/bvh.h"
#include "gaitpad/motion.h"
#include "gaitpad/motion_file.h"
#include "motion/bvh_text.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

std::vector<quat> all_locals(const Motion& m) {
  std::vector<quat> out;
  for (const MotionFrame& f : m.frames) out.insert(out.end(), f.local.begin(), f.local.end());
  return out;
}

BvhLayout layout_of(const Motion& m) {
  BvhLayout layout;
  layout.metres_per_unit = m.metres_per_unit;
  layout.frame_time_s = m.frame_time_s;
  layout.orders = euler_orders(m.skeleton, all_locals(m));
  for (const LegJoints& leg : m.legs) {
    if (m.skeleton.joints[leg.toe].is_end_site) layout.end_sites_as_joints.push_back(leg.toe);
  }
  return layout;
}

std::string exported(const Motion& m) {
  std::stringstream out;
  BvhWriter writer(out, m.skeleton, layout_of(m));
  Pose pose;
  pose.joint_count = static_cast<int>(m.skeleton.joints.size());
  for (const MotionFrame& frame : m.frames) {
    pose.root_m = frame.root_m;
    std::copy(frame.local.begin(), frame.local.end(), pose.local.begin());
    writer.write(pose);
  }
  EXPECT_TRUE(writer.finish());
  return out.str();
}

// Forward kinematics of the file's numbers, apart from the loader: matrices, libm.
std::vector<vec3> places(const Bvh& bvh, int frame) {
  std::vector<vec3> at(bvh.joints.size());
  std::vector<mat3> turn(bvh.joints.size());
  const double* values = bvh.values.data() + static_cast<std::size_t>(frame) * bvh.channels;
  for (std::size_t j = 0; j < bvh.joints.size(); ++j) {
    const BvhJoint& joint = bvh.joints[j];
    mat3 local(1.0);
    vec3 offset = joint.offset;
    for (int c = 0; c < joint.channels; ++c) {
      const double v = values[joint.first_value + c];
      const int axis = static_cast<int>(joint.channel[c]) % 3;
      if (!is_rotation(joint.channel[c])) {
        offset[axis] += v;
        continue;
      }
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      mat3 r(1.0);
      r[a][a] = r[b][b] = std::cos(v * kDegree);
      r[a][b] = std::sin(v * kDegree);
      r[b][a] = -r[a][b];
      local = local * r;
    }
    const bool is_root = joint.parent < 0;
    at[j] = is_root ? offset : at[joint.parent] + turn[joint.parent] * offset;
    turn[j] = is_root ? local : turn[joint.parent] * local;
  }
  return at;
}

void expect_same_motion(const Motion& m, const Bvh& bvh) {
  ASSERT_EQ(static_cast<int>(m.frames.size()), bvh.frames);
  std::vector<int> index(m.skeleton.joints.size(), -1);  // of the file's joint
  for (std::size_t j = 0; j < index.size(); ++j) {
    for (std::size_t i = 0; i < bvh.joints.size(); ++i) {
      if (bvh.joints[i].name == m.skeleton.joints[j].name) index[j] = static_cast<int>(i);
    }
  }
  const auto world = std::make_unique<JointFrames>();
  for (int f = 0; f < bvh.frames; ++f) {
    forward_kinematics(m, m.frames[f], *world);
    const std::vector<vec3> at = places(bvh, f);
    for (std::size_t j = 0; j < index.size(); ++j) {
      ASSERT_GE(index[j], 0) << m.skeleton.joints[j].name;
      ASSERT_LT(glm::distance(at[index[j]] * m.metres_per_unit, world->position_m[j]), 1e-6)
          << m.skeleton.joints[j].name << " frame " << f;
    }
  }
}

TEST(BvhWriter, WritesWhatItWasGiven) {
  WalkerText walker;
  walker.frames = "3 90 4 10 20 30";
  const auto m = motion_from_bvh(walker.text(), "a");
  ASSERT_TRUE(m);
  const auto bvh = parse_bvh(exported(*m), "out");
  ASSERT_TRUE(bvh) << bvh.error().message;
  expect_same_motion(*m, *bvh);
  EXPECT_EQ(bvh->joints[0].offset, vec3(0.0));
  EXPECT_EQ(bvh->joints[0].channels, 6);
  for (std::size_t j = 1; j < bvh->joints.size(); ++j) {
    if (!bvh->joints[j].is_end_site) {
      EXPECT_EQ(bvh->joints[j].channels, 3);
    }
  }
}

TEST(BvhWriter, AnEndSiteThatIsAToeBecomesAJoint) {
  const auto m = motion_from_bvh(WalkerText().text(), "a");
  ASSERT_TRUE(m);
  std::stringstream out;
  BvhLayout layout;
  layout.metres_per_unit = 0.01;
  layout.end_sites_as_joints = {m->legs[0].toe_end};
  BvhWriter writer(out, m->skeleton, layout);
  EXPECT_TRUE(writer.finish());
  EXPECT_NE(out.str().find("JOINT LeftToeBase_End\n"), std::string::npos);
  EXPECT_EQ(out.str().find("JOINT RightToeBase_End\n"), std::string::npos);
}

TEST(BvhWriter, ATurningRootNeverFlipsAChannel) {
  auto m = motion_from_bvh(WalkerText().text(), "a");
  ASSERT_TRUE(m);
  const MotionFrame still = m->frames[0];
  m->frames.clear();
  for (int i = 0; i < 1500; ++i) {
    m->frames.push_back(still);
    m->frames.back().local[0] = rotation_y(i * kDegree) * rotation_x(0.3) * rotation_z(0.2);
    m->frames.back().local[2] = rotation_x(0.1 * i) * rotation_z(0.2);
  }
  const auto bvh = parse_bvh(exported(*m), "out");
  ASSERT_TRUE(bvh) << bvh.error().message;
  expect_same_motion(*m, *bvh);
  for (int f = 1; f < bvh->frames; ++f) {
    for (int c = 3; c < bvh->channels; ++c) {
      const std::size_t at = static_cast<std::size_t>(f) * bvh->channels + c;
      ASSERT_LT(std::abs(bvh->values[at] - bvh->values[at - bvh->channels]), 10.0);
    }
  }
}

TEST(BvhWriter, SharedWalksComeBackWithinAMicrometreAndSmooth) {
  GAITPAD_NEEDS(kCapturedMotions);
  for (const char* file : {"bvhtoolbox_walk01.bvh", "cmu_007_01_iclone.bvh", "cmu_m21_walk.bvh",
                           "makehuman_walk1.bvh", "dpr_walk_simple.bvh", "sheffield_swagger.bvh"}) {
    const auto m = load_motion(kCapturedMotions + file);
    ASSERT_TRUE(m) << m.error().message;
    const auto bvh = parse_bvh(exported(*m), file);
    ASSERT_TRUE(bvh) << bvh.error().message;
    expect_same_motion(*m, *bvh);
    double largest = 0.0;
    for (int f = 1; f < bvh->frames; ++f) {
      for (int c = 3; c < bvh->channels; ++c) {
        const std::size_t at = static_cast<std::size_t>(f) * bvh->channels + c;
        largest = std::max(largest, std::abs(bvh->values[at] - bvh->values[at - bvh->channels]));
      }
    }
    EXPECT_LT(largest, 60.0) << file;
  }
}

TEST(BvhWriter, AStreamThatFailsIsReported) {
  const auto m = motion_from_bvh(WalkerText().text(), "a");
  ASSERT_TRUE(m);
  std::stringstream out;
  BvhWriter writer(out, m->skeleton, BvhLayout{});
  out.setstate(std::ios::badbit);
  EXPECT_FALSE(writer.finish());
}

}  // namespace
}  // namespace gaitpad

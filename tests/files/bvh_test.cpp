#include "gaitpad/bvh.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>

#include "files/bvh_text.h"
#include "gaitpad/motion.h"
#include "gaitpad/motion_file.h"
#include "gaitpad/skeleton.h"
#include "tests/shared_data.h"

namespace gaitpad {
namespace {

std::string error_of(const std::string& text) {
  const auto bvh = parse_bvh(text, "walk.bvh");
  return bvh ? "" : bvh.error().message;
}

const std::string kTiny =
    "HIERARCHY\nROOT a\n{\nOFFSET 1 2 3\nCHANNELS 2 Xrotation Yposition\n"
    "End Site\n{\nOFFSET 0 1 0\n}\n}\nMOTION\nFrames: 2\nFrame Time: 0.5\n1 2\n3 4\n";

TEST(Bvh, KeepsJointsChannelsAndNumbersInTheFilesOrder) {
  const auto bvh = parse_bvh(kTiny, "walk.bvh");
  ASSERT_TRUE(bvh);
  ASSERT_EQ(bvh->joints.size(), 2u);
  EXPECT_EQ(bvh->joints[0].offset, vec3(1.0, 2.0, 3.0));
  EXPECT_EQ(bvh->joints[0].channel[0], BvhChannel::x_rotation);
  EXPECT_EQ(bvh->joints[0].channel[1], BvhChannel::y_position);
  EXPECT_EQ(bvh->joints[1].name, "a_End");
  EXPECT_TRUE(bvh->joints[1].is_end_site);
  EXPECT_EQ(bvh->joints[1].parent, 0);
  EXPECT_EQ(bvh->values, (std::vector<double>{1, 2, 3, 4}));
  EXPECT_EQ(bvh->frame_time_s, 0.5);
}

TEST(Bvh, LineEndsTabsBlanksAndAMissingLastNewlineChangeNothing) {
  const auto plain = parse_bvh(kTiny, "a");
  std::string odd = replaced(kTiny, "\n", " \t\r\n");
  odd = replaced(odd, "1 2 \t", "1\t 2\t");
  odd = "\xef\xbb\xbf" + odd.substr(0, odd.find_last_of('4') + 1);
  const auto other = parse_bvh(odd, "b");
  ASSERT_TRUE(plain);
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_EQ(plain->values, other->values);
  EXPECT_EQ(plain->joints[1].name, other->joints[1].name);
}

TEST(Bvh, ReadsEveryWayToWriteANumber) {
  const std::string text =
      replaced(replaced(kTiny, "0.5", ".0083333"), "3 4", "-9.39531e-005 +1.5E2");
  const auto bvh = parse_bvh(text, "a");
  ASSERT_TRUE(bvh) << bvh.error().message;
  EXPECT_EQ(bvh->frame_time_s, 0.0083333);
  EXPECT_EQ(bvh->values[2], -9.39531e-5);
  EXPECT_EQ(bvh->values[3], 150.0);
}

TEST(Bvh, NamesMayHoldColonsAndBlanksAndTheBraceMayFollowOnTheLine) {
  const auto bvh = parse_bvh(replaced(kTiny, "ROOT a\n{", "ROOT mixamorig:Left Foot {"), "a");
  ASSERT_TRUE(bvh) << bvh.error().message;
  EXPECT_EQ(bvh->joints[0].name, "mixamorig:Left Foot");
}

TEST(Bvh, SeveralEndSitesOfAJointHaveDifferentNames) {
  const auto bvh = parse_bvh(
      replaced(kTiny, "OFFSET 0 1 0\n}", "OFFSET 0 1 0\n}\nEnd Site\n{\nOFFSET 0 2 0\n}"), "a");
  ASSERT_TRUE(bvh) << bvh.error().message;
  EXPECT_EQ(bvh->joints[1].name, "a_End");
  EXPECT_EQ(bvh->joints[2].name, "a_End2");
}

TEST(Bvh, WrongOrMissingValuesAreNamedWithFileAndLine) {
  EXPECT_EQ(error_of(replaced(kTiny, "3 4", "3 x4")),
            "walk.bvh:15: frame 1, value 1: \"x4\" is not a usable number");
  EXPECT_EQ(error_of(replaced(kTiny, "3 4", "3")), "walk.bvh:15: frame 1 has 1 of 2 values");
  EXPECT_EQ(error_of(replaced(kTiny, "3 4", "3 4 5")),
            "walk.bvh:15: frame 1 has more than 2 values");
  EXPECT_EQ(error_of(replaced(kTiny, "1 2\n3 4\n", "1.000 2.000\n")),
            "walk.bvh:15: the motion ends after 1 of 2 frames");
  EXPECT_EQ(error_of(replaced(kTiny, "3 4", "3 4\n5 6")),
            "walk.bvh:16: \"5 6\" after the last of 2 frames");
  EXPECT_EQ(error_of(replaced(kTiny, "OFFSET 1 2 3", "OFFSET 1 2")),
            "walk.bvh:5: OFFSET of \"a\": \"CHANNELS\" is not a number");
}

TEST(Bvh, NumbersThatAreNoneOrOutOfReachAreRefused) {
  for (const char* bad : {"nan", "inf", "-inf", "1e30", "1e999", "0x10", "1,5", "1.#IND", "--1"}) {
    EXPECT_NE(error_of(replaced(kTiny, "3 4", std::string("3 ") + bad)), "") << bad;
  }
  EXPECT_EQ(error_of(replaced(kTiny, "3 4", "3 1e-999")), "");
}

TEST(Bvh, LyingCountsAreRefusedBeforeMemoryIsTaken) {
  EXPECT_EQ(error_of(replaced(kTiny, "Frames: 2", "Frames: 1000000")),
            "walk.bvh:13: 1000000 frames of 2 channels do not fit in the 9 bytes left");
  EXPECT_NE(error_of(replaced(kTiny, "Frames: 2", "Frames: -1")), "");
  EXPECT_NE(error_of(replaced(kTiny, "Frames: 2", "Frames: 1.5")), "");
  EXPECT_NE(error_of(replaced(kTiny, "CHANNELS 2", "CHANNELS 7")), "");
  EXPECT_NE(error_of(replaced(kTiny, "CHANNELS 2", "CHANNELS 3")), "");
  EXPECT_EQ(error_of(replaced(kTiny, "OFFSET 0 1 0\n", "OFFSET 0 1 0\nCHANNELS 1 Xrotation\n")),
            "walk.bvh:9: an End Site has CHANNELS");
  EXPECT_NE(error_of(replaced(kTiny, "0.5", "0")), "");
}

TEST(Bvh, TooManyJointsAndTooDeepASkeletonAreRefused) {
  std::string deep = "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 1 Xrotation\n";
  for (int i = 0; i < 100000; ++i) deep += "JOINT b\n{\n";
  EXPECT_NE(error_of(deep).find("more than 320 joints"), std::string::npos);
}

TEST(Bvh, EveryTruncationIsRefused) {
  const std::string text = WalkerText().text();
  // Cutting off one or two characters may leave a valid last number; every shorter text is an
  // error.
  for (std::size_t n = 0; n + 2 < text.size(); ++n) {
    EXPECT_NE(error_of(text.substr(0, n)), "") << "first " << n << " bytes";
  }
}

TEST(Bvh, DamagedHierarchiesAreRefused) {
  EXPECT_NE(error_of(""), "");
  for (const auto& [sound, damaged] : {std::pair("HIERARCHY", "BIERARCHY"),
                                       {"Yposition", "Wposition"},
                                       {"Yposition", "Xrotation"},
                                       {"OFFSET 0 1 0", "OFFSET 0 1 0\nJOINT b\n{\n}"},
                                       {"MOTION", "ROOT b\n{\n}\nMOTION"},
                                       {"OFFSET 0 1 0", "OFFSET 0 1 0\nOFFSET 0 1 0"}})
    EXPECT_NE(error_of(replaced(kTiny, sound, damaged)), "") << damaged;
  const std::string text = replaced(WalkerText().text(), "OFFSET 10 -2 0\n", "");
  EXPECT_NE(error_of(text).find("\"LeftUpLeg\" has no OFFSET"), std::string::npos);
}

TEST(Bvh, AMissingFileOrAFolderIsOneSentence) {
  EXPECT_EQ(read_bvh("/nowhere/walk.bvh").error().message, "/nowhere/walk.bvh: no such file");
  EXPECT_FALSE(read_bvh(std::filesystem::temp_directory_path().string()));
}

TEST(Bvh, LineEndsOfASharedFileChangeNothing) {
  GAITPAD_NEEDS(kCapturedMotions);
  const auto lf = read_bvh(kCapturedMotions + "mocapbank_test.bvh");
  const auto crlf = read_bvh(kCapturedMotions + "mocapbank_test_crlf.bvh");
  ASSERT_TRUE(lf && crlf);
  EXPECT_EQ(lf->values, crlf->values);
}

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

// Places of the joints by forward kinematics of the file's numbers, independent of the loader:
// matrices and libm.
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
  // Index of each of the file's joints in the skeleton; -1: none.
  std::vector<int> index(m.skeleton.joints.size(), -1);
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

// Largest change of a rotation channel between two frames.
double largest_step_deg(const Bvh& bvh) {
  double largest = 0.0;
  for (int f = 1; f < bvh.frames; ++f) {
    for (int c = 3; c < bvh.channels; ++c) {
      const std::size_t at = static_cast<std::size_t>(f) * bvh.channels + c;
      largest = std::max(largest, std::abs(bvh.values[at] - bvh.values[at - bvh.channels]));
    }
  }
  return largest;
}

TEST(BvhWriter, ATurningRootNeverFlipsAChannel) {
  auto m = motion_from_bvh(WalkerText().text(), "a");
  ASSERT_TRUE(m);
  const MotionFrame still = m->frames[0];
  m->frames.clear();
  for (int i = 0; i < 800; ++i) {
    m->frames.push_back(still);
    m->frames.back().local[0] = rotation_y(i * kDegree) * rotation_x(0.3) * rotation_z(0.2);
    m->frames.back().local[2] = rotation_x(0.1 * i) * rotation_z(0.2);
  }
  const auto bvh = parse_bvh(exported(*m), "out");
  ASSERT_TRUE(bvh) << bvh.error().message;
  expect_same_motion(*m, *bvh);
  EXPECT_LT(largest_step_deg(*bvh), 10.0);
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
    EXPECT_LT(largest_step_deg(*bvh), 60.0) << file;
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

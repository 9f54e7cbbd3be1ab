// Feeds bad values to every function of gaitpad.h: each is refused by a sentence that names the
// field, or counted; no NaN or infinity reaches a pose.
#include "tests/bad_values.h"

#include <gtest/gtest.h>

#include <array>
#include <climits>
#include <iostream>
#include <string>
#include <vector>

#include "gaitpad.h"

namespace gaitpad {
namespace {

// A body of bones in the standing pose. Its names live as long as the program.
const std::vector<gaitpad_bone>& body() {
  static const std::vector<gaitpad_bone> bones = {
      {"Hips", -1, 0, {0.0, 0.0, 0.0}},         {"LeftUpLeg", 0, 0, {0.1, -0.05, 0.0}},
      {"LeftLeg", 1, 0, {0.0, -0.42, 0.0}},     {"LeftFoot", 2, 0, {0.0, -0.42, 0.0}},
      {"LeftToe", 3, 0, {0.0, -0.07, 0.15}},    {"LeftToeTip", 4, 1, {0.0, 0.0, 0.07}},
      {"RightUpLeg", 0, 0, {-0.1, -0.05, 0.0}}, {"RightLeg", 6, 0, {0.0, -0.42, 0.0}},
      {"RightFoot", 7, 0, {0.0, -0.42, 0.0}},   {"RightToe", 8, 0, {0.0, -0.07, 0.15}},
      {"RightToeTip", 9, 1, {0.0, 0.0, 0.07}}};
  return bones;
}

struct ModelOptions {
  gaitpad_model_options options = {};
  std::vector<gaitpad_bone> bones = body();
  ModelOptions() {
    gaitpad_model_defaults(&options);
    options.bone_count = static_cast<int32_t>(bones.size());
    options.root_height_m = 0.98;
  }
};

class BadValuesInC : public testing::Test {
 protected:
  ~BadValuesInC() override {
    gaitpad_walk_destroy(walk_);
    gaitpad_model_destroy(model_);
  }
  // The sentence by which a model is refused; "accepted" if it was made.
  std::string said_of(ModelOptions given) {
    given.options.bones = given.bones.data();
    gaitpad_model* made = gaitpad_model_create(&given.options, error_.data(), error_.size());
    const bool is_made = made != nullptr;
    gaitpad_model_destroy(made);
    return is_made ? "accepted" : error_.data();
  }
  int bad_inputs() const {
    gaitpad_frame frame = {};
    frame.size = sizeof frame;
    EXPECT_EQ(gaitpad_walk_frame(walk_, &frame), 1);
    return frame.bad_inputs;
  }
  void expect_counted(const std::string& what, int count) {
    ++fed_;
    EXPECT_EQ(bad_inputs() - counted_, count) << what;
    counted_ = bad_inputs();
    gaitpad_walk_step(walk_, 0.0, 0.8, 1.0 / 60.0);
    std::vector<float> pose(16 * static_cast<std::size_t>(gaitpad_joint_count(model_)));
    EXPECT_GT(gaitpad_pose_world(walk_, pose.data(), INT_MAX), 0);
    for (const float number : pose) ASSERT_TRUE(std::isfinite(number)) << what;
  }
  void feed_model();
  void feed_start();
  void feed_walk();
  void feed_asked_steps();
  void feed_counts();

  std::array<char, 256> error_ = {};
  gaitpad_model* model_ = nullptr;
  gaitpad_walk* walk_ = nullptr;
  int fed_ = 0, counted_ = 0;
};

void BadValuesInC::feed_model() {
  using O = ModelOptions;
  const std::vector<FedField<O>> fields = {
      {"scale", [](O& o, double v) { o.options.scale = v; }, bad_numbers(0.05, 20.0)},
      {"leg_ratio", [](O& o, double v) { o.options.leg_ratio = v; }, bad_numbers(0.05, 20.0)},
      {"root_height_m", [](O& o, double v) { o.options.root_height_m = v; },
       bad_numbers(-1e6, 1e6)},
      {"bone_count", [](O& o, double v) { o.options.bone_count = static_cast<int32_t>(v); },
       bad_counts(1, 320)},
      {"parent", [](O& o, double v) { o.bones[3].parent = static_cast<int32_t>(v); },
       bad_counts(0, 2)},
      {"offset_m",
       [](O& o, double v) { o.bones[4].offset_m[2] = v; },
       {kNaN, kInfinity, -kInfinity}},
      {"has no name", [](O& o, double) { o.bones[2].name = nullptr; }, {0.0}},
      {"size", [](O& o, double v) { o.options.size = static_cast<size_t>(v); }, {0.0, 1.0, 8.0}}};
  for (const FedField<O>& field : fields) {
    for (const double value : field.bad) {
      ModelOptions bad;
      field.set(bad, value);
      ++fed_;
      EXPECT_NE(said_of(bad).find(field.name), std::string::npos)
          << field.name << " = " << value << ": " << said_of(bad);
    }
  }
}

void BadValuesInC::feed_start() {
  for (const double bad : bad_numbers(-1e6, 1e6)) {
    for (const int i : {0, 2, 3}) {
      double place_m[3] = {1.0, 0.0, 2.0};
      if (i < 3) place_m[i] = bad;
      ++fed_;
      EXPECT_EQ(gaitpad_walk_create(model_, place_m, i < 3 ? 0.5 : bad, error_.data(), 256),
                nullptr);
      const std::string field = i < 3 ? "place_m[" + std::to_string(i) + "]" : "heading_rad";
      EXPECT_NE(std::string(error_.data()).find(field + " is "), std::string::npos)
          << error_.data();
    }
  }
}

void BadValuesInC::feed_walk() {
  const std::vector<double> sticks = bad_numbers(-1.0, 1.0), places = bad_numbers(-1e6, 1e6);
  for (const double bad : sticks) {
    gaitpad_walk_step(walk_, bad, 0.8, 1.0 / 60.0);
    expect_counted("stick_right", 1);
    gaitpad_walk_step(walk_, 0.0, bad, 1.0 / 60.0);
    expect_counted("stick_forward", 1);
  }
  for (const double bad : bad_numbers(1e-4, 0.1)) {
    gaitpad_walk_step(walk_, 0.0, 0.8, bad);
    expect_counted("dt_s", 1);
  }
  for (const double bad : places) {
    for (int i = 0; i < 4; ++i) {
      double place_m[3] = {1.0, 0.0, 2.0};
      if (i < 3) place_m[i] = bad;
      gaitpad_walk_move(walk_, place_m, i < 3 ? 0.5 : bad);
      expect_counted("gaitpad_walk_move()", 1);
      gaitpad_walk_put(walk_, place_m, i < 3 ? 0.5 : bad);
      expect_counted("gaitpad_walk_put()", 1);
    }
  }
  gaitpad_walk_move(walk_, nullptr, 0.0);
  expect_counted("gaitpad_walk_move(null)", 1);
  feed_asked_steps();
  for (const char* key :
       {"hip_sway", "left_leg.weight.knee", "legs.stride_length", "head.yaw_deg"}) {
    for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300, -1e300}) {
      EXPECT_EQ(gaitpad_walk_set(walk_, key, bad), 0) << key;
      expect_counted(key, 0);
    }
  }
  for (const char* key : {"", "hip", "\xff"}) {
    EXPECT_EQ(gaitpad_walk_set(walk_, key, 1.0), 0) << key;
    expect_counted("a key", 0);
  }
}

// What a walk is asked for beside its stick is refused, or counted by the tick.
void BadValuesInC::feed_asked_steps() {
  for (const double bad : {kNaN, kInfinity, -kInfinity, 1e300}) {
    for (int i = 0; i < 3; ++i) {
      double place_m[3] = {1.0, 0.0, 2.0}, heading_rad = i == 1 ? bad : 0.0;
      if (i != 1) place_m[i] = bad;
      EXPECT_EQ(gaitpad_walk_step_to(walk_, place_m, heading_rad), 0);
      expect_counted("gaitpad_walk_step_to()", 0);
      if (bad != 1e300) {
        EXPECT_EQ(gaitpad_walk_nearest_step(walk_, place_m, &heading_rad), 0);
      }
      expect_counted("gaitpad_walk_nearest_step()", 0);
      EXPECT_EQ(
          gaitpad_walk_push(
              walk_, std::array{i == 0 ? bad : 0.0, i == 1 ? bad : 0.0, i == 2 ? bad : 0.0}.data()),
          i == 1 && bad == 1e300);
      expect_counted("gaitpad_walk_push()", 0);
    }
  }
  EXPECT_EQ(gaitpad_walk_draw(walk_, kNaN), 0);
  expect_counted("gaitpad_walk_draw()", 0);
  for (const double share : {kInfinity, -kInfinity, -1e300, 2.0}) {
    EXPECT_EQ(gaitpad_walk_draw(walk_, share), 1);
    expect_counted("gaitpad_walk_draw()", 0);
  }
  for (const int32_t detail : {-1, 2, INT_MIN, INT_MAX}) {
    EXPECT_EQ(gaitpad_walk_set_detail(walk_, detail), 0);
    expect_counted("gaitpad_walk_set_detail()", 0);
  }
  for (const size_t size : {size_t{0}, size_t{1}, sizeof(gaitpad_capsule) - 1}) {
    gaitpad_capsule capsule = {};
    capsule.size = size;
    EXPECT_EQ(gaitpad_walk_follow(walk_, &capsule, 1.0 / 60.0), 0);
    expect_counted("gaitpad_capsule::size", 0);
  }
}

void BadValuesInC::feed_counts() {
  const int32_t joints = gaitpad_joint_count(model_);
  std::vector<float> out(16 * static_cast<std::size_t>(joints), 7.0f);
  for (const int32_t count : {0, -1, INT_MIN}) {
    EXPECT_EQ(gaitpad_pose_world(walk_, out.data(), count), 0);
    EXPECT_EQ(gaitpad_pose_local(walk_, out.data(), count, nullptr), 0);
    fed_ += 2;
  }
  EXPECT_EQ(out, std::vector<float>(out.size(), 7.0f));
  EXPECT_EQ(gaitpad_pose_local(walk_, out.data(), INT_MAX, nullptr), joints);
  for (const int32_t joint : {-1, joints, INT_MIN, INT_MAX}) {
    EXPECT_EQ(gaitpad_joint_name(model_, joint), nullptr);
    EXPECT_EQ(gaitpad_joint_parent(model_, joint), -1);
    fed_ += 2;
  }
  for (const size_t size : {size_t{0}, size_t{1}, sizeof(gaitpad_frame) - 1}) {
    gaitpad_frame frame = {};
    frame.size = size;
    EXPECT_EQ(gaitpad_walk_frame(walk_, &frame), 0);
    ++fed_;
  }
}

TEST_F(BadValuesInC, AreRefusedOrCountedByEveryFunction) {
  ModelOptions good;
  good.options.bones = good.bones.data();
  model_ = gaitpad_model_create(&good.options, error_.data(), error_.size());
  ASSERT_NE(model_, nullptr) << error_.data();
  const double place_m[3] = {1.0, 0.0, 2.0};
  walk_ = gaitpad_walk_create(model_, place_m, 0.5, error_.data(), error_.size());
  ASSERT_NE(walk_, nullptr) << error_.data();
  for (int tick = 0; tick < 60; ++tick) gaitpad_walk_step(walk_, 0.0, 0.8, 1.0 / 60.0);
  feed_model();
  feed_start();
  feed_walk();
  feed_counts();
  std::cout << "all: " << fed_ << " bad values\n";
  EXPECT_GE(fed_, 150);
}

}  // namespace
}  // namespace gaitpad

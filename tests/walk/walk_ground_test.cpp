// The walk written anew over uneven ground, beside the old one.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/animation/made_walker.h"
#include "tests/walk/old_walk.h"

namespace gaitpad::anew {
namespace {

constexpr double kPlanted_m = 1e-5;

std::shared_ptr<const Terrain> ground_of(const std::vector<SectionShape>& sections) {
  Terrain terrain;
  for (const SectionShape& s : sections) {
    const auto problem = add_section(terrain, s);
    EXPECT_FALSE(problem) << problem->message;
  }
  return std::make_shared<const Terrain>(terrain);
}
WalkModel model_on(std::shared_ptr<const Terrain> terrain) {
  WalkModel model = adult();
  model.terrain = std::move(terrain);
  return model;
}

GaitParams params_of(double x, double y) {
  Stick stick;
  stick.left = vec2(x, y);
  return gait_params(stick, StyleValues{}, gait_limits(adult()));
}

double turned_deg(const quat& a, const quat& b) {
  return glm::length(rotation_vector(glm::conjugate(a) * b)) / kDegree;
}

// Where heels and toes are.
vec3 end_of(const Pose& pose, Side side, bool toe) {
  static JointFrames frames;
  forward_kinematics(adult().cycle.skeleton, pose, frames);
  const LegModel& leg = adult().leg[side].model;
  return frames.position_m[leg.joints.ankle] +
         frames.rotation[leg.joints.ankle] *
             (glm::conjugate(leg.standing[2]) * (toe ? leg.toe_m : leg.heel_m));
}

// The old walk and the new one, from a strike on level ground on.
class BothWalks {
 public:
  BothWalks(const WalkModel& model, double x, double y)
      : model_(model),
        params_(params_of(x, y)),
        tables_(tables_of(model, kDt)),
        old_(standing(model, vec3(0.0), old_pose)) {
    for (int tick = 0; tick < 4 * kRate || !has_just_struck(old_); ++tick) step_old();
    block_ = taken_over(old_, params_);
    pose = old_pose;
  }
  void step() {
    step_old();
    quat* local = pose.local.data();
    vec3* root = &pose.root_m;
    advance(*tables_, block_, Poses{&local, &root, 1});
  }
  void steer(double x, double y) {
    params_ = params_of(x, y);
    ask(params_, block_.state.asked);
  }
  const WalkState& old() const { return old_; }
  const Block<1>& block() const { return block_; }
  const Tables& tables() const { return *tables_; }
  Pose old_pose, pose;

 private:
  void step_old() { gaitpad::advance(model_, params_, IkMode::robust, kDt, old_, old_pose); }
  const WalkModel& model_;
  GaitParams params_;
  std::unique_ptr<const Tables> tables_;
  WalkState old_;
  Block<1> block_;
};

struct Course {
  const char* name;
  std::vector<SectionShape> sections;
  double x, y, seconds;
};
void PrintTo(const Course& course, std::ostream* out) { *out << course.name; }

// The motion's own step may bring a heel in the flight a little below its ground.
struct Seen {
  std::array<double, 4> squares{}, most{};
  double root_m = 0.0, slid_m = 0.0, old_slid_m = 0.0, deep_m = 0.0;
};

class OnGround : public testing::TestWithParam<Course> {};

TEST_P(OnGround, WalksAsTheOldWalkDoes) {
  const Course& course = GetParam();
  const WalkModel model = model_on(ground_of(course.sections));
  BothWalks walks(model, course.x, course.y);
  Seen seen;
  std::array<std::array<vec3, 2>, 2> anchor{}, old_anchor{};
  std::array<std::array<bool, 2>, 2> planted{};
  const int ticks = static_cast<int>(course.seconds * kRate);
  const char* const folder = std::getenv("WALK_TRACE");
  std::ofstream trace;
  if (folder) trace.open(std::string(folder) + "/" + course.name + ".csv");
  for (int tick = 0; tick < ticks; ++tick) {
    walks.step();
    const WalkFrame& frame = walks.old().frame;
    for (const Side side : {kLeftSide, kRightSide}) {
      const LegBuild& leg = model.leg[side];
      for (int j = 0; j < 4; ++j) {
        if (leg.joint[j].joint < 0) continue;
        const double off = turned_deg(walks.old_pose.local[leg.joint[j].joint],
                                      walks.pose.local[leg.joint[j].joint]);
        seen.squares[j] += off * off / (2.0 * ticks);
        seen.most[j] = std::max(seen.most[j], off);
      }
      const std::array<bool, 2> now = {frame.heel_planted[side], frame.toe_planted[side]};
      for (const bool toe : {false, true}) {
        const vec3 place = end_of(walks.pose, side, toe),
                   old_place = end_of(walks.old_pose, side, toe);
        if (now[toe] && !planted[side][toe])
          anchor[side][toe] = place, old_anchor[side][toe] = old_place;
        if (now[toe]) {
          seen.slid_m = std::max(seen.slid_m, glm::distance(place, anchor[side][toe]));
          seen.old_slid_m =
              std::max(seen.old_slid_m, glm::distance(old_place, old_anchor[side][toe]));
        }
        planted[side][toe] = now[toe];
      }
    }
    seen.root_m = std::max(seen.root_m, glm::distance(walks.old_pose.root_m, walks.pose.root_m));
    if (!folder) continue;
    for (const Pose* pose : {&walks.old_pose, &walks.pose}) {
      JointFrames frames;
      forward_kinematics(model.cycle.skeleton, *pose, frames);
      for (const Side side : {kLeftSide, kRightSide}) {
        for (const int joint : {model.leg[side].model.joints.hip, model.leg[side].model.joints.knee,
                                model.leg[side].model.joints.ankle})
          trace << frames.position_m[joint].z << ' ' << frames.position_m[joint].y << ' ';
        for (const bool toe : {false, true}) {
          const vec3 end = end_of(*pose, side, toe);
          trace << end.z << ' ' << end.y << ' ';
        }
        for (int j = 0; j < 3; ++j)
          trace << glm::length(rotation_vector(pose->local[model.leg[side].joint[j].joint])) /
                       kDegree
                << ' ';
      }
      for (const Side side : {kLeftSide, kRightSide}) {
        const LegJoints& j = model.leg[side].model.joints;
        const vec3 h = frames.position_m[j.hip], k = frames.position_m[j.knee],
                   a = frames.position_m[j.ankle];
        const vec3 line = glm::normalize(a - h), n = (k - h) - line * glm::dot(k - h, line);
        trace << std::atan2(n.x, n.z) / kDegree << ' ';
      }
      trace << pose->root_m.y << ' ' << pose->root_m.z << ' ';
    }
    trace << walks.block().footing.hips_m.x + walks.block().origin[0].y_m << ' '
          << walks.old().path.base.height_m << '\n';
  }
  constexpr std::array<const char*, 4> kName = {"hip", "knee", "ankle", "toe"};
  for (int j = 0; j < 4; ++j)
    std::printf("%s %.3f most %.3f deg; ", kName[j], std::sqrt(seen.squares[j]), seen.most[j]);
  std::printf("root %.3f mm; planted points move %.5f, old %.5f mm; at %.2f m, %.2f m high\n",
              seen.root_m * 1e3, seen.slid_m * 1e3, seen.old_slid_m * 1e3, walks.pose.root_m.z,
              walks.block().origin[0].y_m);
  EXPECT_LE(seen.slid_m, kPlanted_m);
}
INSTANTIATE_TEST_SUITE_P(
    Courses, OnGround,
    testing::Values(
        Course{"far", {FlatSection{90.0}, SlopeSection{3.0, 0.1, 0.5}}, 0.0, 0.8, 6.0},
        Course{"slope_up", {FlatSection{8.0}, SlopeSection{20.0, 0.15, 0.5}}, 0.0, 0.8, 10.0},
        Course{"slope_down", {FlatSection{8.0}, SlopeSection{20.0, -0.15, 0.5}}, 0.0, 0.8, 10.0},
        Course{"stairs_up", {FlatSection{8.0}, StairsSection{0.17, 0.28, 8}}, 0.0, 0.8, 10.0},
        Course{"stairs_down", {FlatSection{8.0}, StairsSection{-0.17, 0.28, 8}}, 0.0, 0.8, 10.0},
        Course{"slow_up", {FlatSection{5.0}, StairsSection{0.17, 0.28, 8}}, 0.0, 0.3, 12.0}));

}  // namespace
}  // namespace gaitpad::anew

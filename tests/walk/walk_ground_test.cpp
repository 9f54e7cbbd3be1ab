// The walk written anew over uneven ground, beside the old one.
#include <gtest/gtest.h>

#include <fstream>

#include "tests/animation/made_walker.h"
#include "tests/walk/grounds.h"
#include "walk/walk_frame.h"

namespace gaitpad::anew {
namespace {

constexpr double kBound_deg = 0.1;

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

// How far a knee points to the left of straight ahead, seen along the line from hip to ankle.
double knee_points_rad(const WalkModel& model, const JointFrames& frames, Side side) {
  const LegJoints& joints = model.leg[side].model.joints;
  const vec3 hip_m = frames.position_m[joints.hip], knee = frames.position_m[joints.knee] - hip_m,
             line = glm::normalize(frames.position_m[joints.ankle] - hip_m);
  return heading_of(knee - line * glm::dot(knee, line));
}

struct Course {
  const char* name;
  std::vector<SectionShape> sections;
  double x, y, seconds;
  bool eases_ankles = false;
};
void PrintTo(const Course& course, std::ostream* out) { *out << course.name; }

struct Seen {
  std::array<double, 4> squares{}, most{};
  double root_m = 0.0, slid_m = 0.0, old_slid_m = 0.0, swivel_rad = 0.0, old_swivel_rad = 0.0;
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
    for (const bool is_old : {true, false}) {
      static JointFrames frames;
      forward_kinematics(model.cycle.skeleton, is_old ? walks.old_pose : walks.pose, frames);
      double& most_rad = is_old ? seen.old_swivel_rad : seen.swivel_rad;
      for (const Side side : {kLeftSide, kRightSide})
        most_rad = std::max(most_rad, std::abs(knee_points_rad(model, frames, side)));
    }
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
      for (const Side side : {kLeftSide, kRightSide})
        trace << knee_points_rad(model, frames, side) / kDegree << ' ';
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
  std::printf("knees point %.2f, old %.2f deg aside\n", seen.swivel_rad / kDegree,
              seen.old_swivel_rad / kDegree);
  EXPECT_LE(seen.slid_m, kPlanted_m);
  EXPECT_LE(std::sqrt(seen.squares[1]), kBound_deg);
  // Where stairs bend an ankle to its limit, the old walk's knees swivel aside, and these do not.
  if (course.eases_ankles) {
    EXPECT_LE(seen.swivel_rad, seen.old_swivel_rad);
    return;
  }
  for (int j : {0, 2}) EXPECT_LE(std::sqrt(seen.squares[j]), kBound_deg);
}
INSTANTIATE_TEST_SUITE_P(
    Courses, OnGround,
    testing::Values(
        Course{"far", {FlatSection{90.0}, SlopeSection{3.0, 0.1, 0.5}}, 0.0, 0.8, 6.0},
        Course{"slope_up", {FlatSection{8.0}, SlopeSection{20.0, 0.15, 0.5}}, 0.0, 0.8, 10.0},
        Course{"slope_down", {FlatSection{8.0}, SlopeSection{20.0, -0.15, 0.5}}, 0.0, 0.8, 10.0},
        Course{"stairs_up", {FlatSection{8.0}, StairsSection{0.17, 0.28, 8}}, 0.0, 0.8, 10.0, true},
        Course{
            "stairs_down", {FlatSection{8.0}, StairsSection{-0.17, 0.28, 8}}, 0.0, 0.8, 10.0, true},
        Course{"slow_up", {FlatSection{5.0}, StairsSection{0.17, 0.28, 8}}, 0.0, 0.3, 12.0}));

// --- The frame of a tick -------------------------------------------------------------------------

class Frames : public testing::TestWithParam<Course> {};

TEST_P(Frames, SayWhatTheOldWalksSay) {
  constexpr double kPlace_m = 2e-3, kSpeed_m_s = 5e-3, kTurn_rad = 1e-4, kMoved_m = 2e-4;
  const WalkModel model = model_on(ground_of(GetParam().sections));
  BothWalks walks(model, GetParam().x, GetParam().y);
  Report told;
  told.frame = walks.old().frame;
  told.step_ticks = walks.old().clock.last_step_ticks;
  double place_m = 0.0, root_m = 0.0, moved_m = 0.0, speed_m_s = 0.0, stride_m = 0.0,
         ground_m = 0.0;
  for (int tick = 0; tick < GetParam().seconds * kRate; ++tick) {
    walks.step();
    report(model, walks.tables(), walks.block(), walks.pose, told);
    const WalkFrame &is = told.frame, &old = walks.old().frame;
    ASSERT_EQ(is.stage, old.stage) << tick;
    ASSERT_EQ(is.swing, old.swing) << tick;
    ASSERT_EQ(is.heel_planted, old.heel_planted);
    ASSERT_EQ(is.toe_planted, old.toe_planted);
    ASSERT_EQ(is.steps, old.steps);
    EXPECT_EQ(is.overhangs, old.overhangs);
    EXPECT_NEAR(is.heading_rad, old.heading_rad, kTurn_rad);
    EXPECT_NEAR(is.turn_rate_rad_s, old.turn_rate_rad_s, kTurn_rad);
    EXPECT_NEAR(is.root_turned_rad, tick > 0 ? old.root_turned_rad : 0.0, kTurn_rad);
    const auto see = [](double off, double& most) { most = std::max(most, off); };
    see(glm::distance(is.pelvis_m, old.pelvis_m), place_m);
    see(glm::distance(is.root_m, old.root_m), root_m);
    if (tick > 0) see(glm::distance(is.root_moved_m, old.root_moved_m), moved_m);
    see(std::abs(is.speed_m_s - old.speed_m_s), speed_m_s);
    for (int side : {0, 1}) {
      see(std::abs(is.stride_m[side] - old.stride_m[side]), stride_m);
      see(glm::distance(is.heel_m[side], old.heel_m[side]), place_m);
      see(glm::distance(is.toe_m[side], old.toe_m[side]), place_m);
      // Not where the one is before a riser and the other behind it.
      const double heel = std::abs(is.heel_ground_m[side] - old.heel_ground_m[side]),
                   toe = std::abs(is.toe_ground_m[side] - old.toe_ground_m[side]);
      see(heel > 0.1 ? 0.0 : heel, ground_m);
      see(toe > 0.1 ? 0.0 : toe, ground_m);
    }
  }
  std::printf("places %.3f, root %.3f, moved %.4f, strides %.3f, ground %.3f mm; speed %.5f m/s\n",
              place_m * 1e3, root_m * 1e3, moved_m * 1e3, stride_m * 1e3, ground_m * 1e3,
              speed_m_s);
  for (const double off : {place_m, root_m, stride_m, ground_m}) EXPECT_LE(off, kPlace_m);
  EXPECT_LE(moved_m, kMoved_m);
  EXPECT_LE(speed_m_s, kSpeed_m_s);
}
INSTANTIATE_TEST_SUITE_P(
    OfTicks, Frames,
    testing::Values(
        Course{"level", {FlatSection{90.0}, SlopeSection{3.0, 0.1, 0.5}}, 0.0, 0.8, 6.0},
        Course{"turn", {FlatSection{90.0}, SlopeSection{3.0, 0.1, 0.5}}, 0.4, 0.7, 6.0},
        Course{"up", {FlatSection{8.0}, StairsSection{0.17, 0.28, 8}}, 0.0, 0.8, 10.0}));

// --- Grounds of games ----------------------------------------------------------------------------

class OnHills : public testing::TestWithParam<std::array<double, 3>> {};

TEST_P(OnHills, WalksAsTheOldWalkDoes) {
  const auto [slope_x, slope_z, wave_m] = GetParam();
  const Hills hills{slope_x, slope_z, wave_m};
  const WalkModel model = model_on(asked_of(hills));
  for (const double x : {0.0, 0.3}) {
    BothWalks walks(model, x, 0.8);
    const int ticks = 6 * kRate;
    std::array<double, 3> squares{}, most{};
    double root_m = 0.0;
    for (int tick = 0; tick < ticks; ++tick) {
      walks.step();
      root_m = std::max(root_m, glm::distance(walks.old_pose.root_m, walks.pose.root_m));
      for (const LegBuild& leg : model.leg) {
        for (int j : {0, 1, 2}) {
          const double off = turned_deg(walks.old_pose.local[leg.joint[j].joint],
                                        walks.pose.local[leg.joint[j].joint]);
          squares[j] += off * off / (2.0 * ticks);
          most[j] = std::max(most[j], off);
        }
      }
    }
    std::printf("hip %.3f most %.3f, knee %.3f most %.3f, ankle %.3f most %.3f deg; root %.3f mm\n",
                std::sqrt(squares[0]), most[0], std::sqrt(squares[1]), most[1],
                std::sqrt(squares[2]), most[2], root_m * 1e3);
    for (const double square : squares) EXPECT_LE(std::sqrt(square), kBound_deg);
  }
}

TEST_P(OnHills, PlantsSolesOnTheGroundWhereverItLeads) {
  constexpr double kOnGround_m = 1e-4;
  const auto [slope_x, slope_z, wave_m] = GetParam();
  const Hills hills{slope_x, slope_z, wave_m};
  const WalkModel model = model_on(asked_of(hills));
  double slid_m = 0.0, heel_off_m = 0.0, ball_off_m = 0.0, deep_m = 0.0;
  int steady_planning = 0, steady_ticks = 0, planning = 0, asked = 0, ticks = 0;
  for (const double heading : {0.0, 1.7}) {
    Hiker hiker(model, {0.4, -0.3, heading});
    vec3 was;
    Planted was_planted;
    for (int tick = 0; tick < 12 * kRate; ++tick, ++ticks) {
      const Planted planted = planted_of(hiker.block);
      const bool rolls = hiker.block.state.tick >= hiker.block.state.roll_ticks - 2.0f &&
                         hiker.block.state.flies == 0.0f && hiker.block.change.stands == 0.0f;
      const int before = hills.calls;
      GaitParams params = params_of(0.0, 0.8);
      if (tick % (4 * kRate) > 2 * kRate) params = params_of(0.4, 0.6);
      hiker.step(params);
      if (tick % (4 * kRate) > kRate && tick % (4 * kRate) < 2 * kRate)
        steady_planning += hills.calls > before, ++steady_ticks;
      planning += hills.calls > before;
      asked += hills.calls - before;
      const vec3 place = end_of(hiker.pose, planted.side, planted.toe);
      if (tick > 0 && planted == was_planted) slid_m = std::max(slid_m, glm::distance(place, was));
      was = place, was_planted = planted;
      const vec3 heel = end_of(hiker.pose, planted.side, false);
      const double under = Hills::ask(&hills, heel.x, heel.z).height_m;
      --const_cast<Hills&>(hills).calls;
      if (!planted.toe) heel_off_m = std::max(heel_off_m, std::abs(heel.y - under));
      if (rolls && tick > kRate) {
        // Flat on its sole: the ball lies on the ground, too.
        static JointFrames frames;
        forward_kinematics(model.cycle.skeleton, hiker.pose, frames);
        const LegBuild& leg = model.leg[planted.side];
        const vec3 ball = frames.position_m[leg.model.joints.ankle] +
                          frames.rotation[leg.model.joints.ankle] *
                              (glm::conjugate(leg.model.standing[2]) * leg.ball_m);
        ball_off_m =
            std::max(ball_off_m, std::abs(ball.y - Hills::ask(&hills, ball.x, ball.z).height_m));
        --const_cast<Hills&>(hills).calls;
      }
      deep_m = std::max(deep_m, under - heel.y);
    }
  }
  std::printf(
      "planted points move %.5f mm a tick; heels %.4f, balls %.3f mm off the ground; %d of %d "
      "ticks "
      "ask, %.1f calls each; heels %.2f mm deep\n",
      slid_m * 1e3, heel_off_m * 1e3, ball_off_m * 1e3, planning, ticks,
      static_cast<double>(asked) / planning, deep_m * 1e3);
  EXPECT_LE(slid_m, kPlanted_m);
  EXPECT_LE(steady_planning, steady_ticks / 5);  // the pace still settles
  EXPECT_LE(heel_off_m, kOnGround_m);
}
INSTANTIATE_TEST_SUITE_P(Asked, OnHills,
                         testing::Values(std::array<double, 3>{0.0, 0.15, 0.0},
                                         std::array<double, 3>{0.15, 0.0, 0.0},
                                         std::array<double, 3>{-0.1, -0.1, 0.0},
                                         std::array<double, 3>{0.05, 0.0, 0.15}));

class OnStairs : public testing::TestWithParam<double> {};

TEST_P(OnStairs, ClearsTheEdgesFromAStandToAStand) {
  constexpr double kDeepest_m = 0.006;
  const WalkModel model =
      model_on(ground_of({FlatSection{2.5}, StairsSection{GetParam(), 0.28, 6}, FlatSection{4.0}}));
  double deep_m = 0.0, at_m = 0.0, old_deep_m = 0.0;
  for (const double y : {0.3, 0.8, 1.0}) {
    for (int wait = 0; wait < 60; wait += 12) {
      Hiker hiker(model, {0.0, 0.01 * wait, 0.0});
      Pose old_pose;
      WalkState old = standing(model, vec3(0.0, 0.0, 0.01 * wait), old_pose);
      for (int tick = 0; tick < 14 * kRate; ++tick) {
        GaitParams params = params_of(0.0, y);
        if (tick < 20 || tick > 12 * kRate) params = GaitParams{};
        hiker.step(params);
        gaitpad::advance(model, params, IkMode::robust, kDt, old, old_pose);
        const double deep = deepest_m(model, hiker.pose);
        if (deep > deep_m) deep_m = deep, at_m = hiker.pose.root_m.z;
        const double old_deep = deepest_m(model, old_pose);
        old_deep_m = std::max(old_deep_m, old_deep);
      }
      EXPECT_EQ(hiker.block.change.stands, 1.0f);
      EXPECT_GT(hiker.pose.root_m.z, 3.0);
      // It stands upright again, on its ground.
      const double over_m =
          hiker.pose.root_m.y - ground_at(*model.terrain, 0.0, hiker.pose.root_m.z).height_m;
      EXPECT_NEAR(over_m, hiker.tables().stand_m, 0.03) << y << " " << wait;
    }
  }
  std::printf("soles %.1f mm deep with the hips at %.3f m, old %.1f mm\n", deep_m * 1e3, at_m,
              old_deep_m * 1e3);
  EXPECT_LE(deep_m, kDeepest_m);
}
INSTANTIATE_TEST_SUITE_P(UpAndDown, OnStairs, testing::Values(0.17, -0.17, 0.1, -0.1));

// Walks of different phases up stairs, in a block of that width and alone: the same bits.
template <int kWidth>
void expect_same_bits() {
  const WalkModel model =
      model_on(ground_of({SlopeSection{3.0, 0.12, 0.5}, StairsSection{-0.15, 0.3, 4},
                          StairsSection{0.17, 0.28, 5}, FlatSection{2.0}}));
  const auto tables = tables_of(model, kDt);
  std::vector<Block<1>> alone(kWidth);
  std::array<Pose, kWidth> pose;
  Pose one;
  Block<kWidth> block{};
  std::array<quat*, kWidth> local;
  std::array<vec3*, kWidth> root;
  for (int w = 0; w < kWidth; ++w) {
    stand(*tables, {0.1 * w, 0.2 * w + 0.8, 0.02 * w}, alone[w]);
    ask(params_of(w % 3 == 2 ? 0.1 : 0.0, 0.4 + 0.03 * w), alone[w].state.asked);
    copy_walk(alone[w], 0, block, w);
    local[w] = pose[w].local.data(), root[w] = &pose[w].root_m;
  }
  for (int tick = 0; tick < 8 * kRate; ++tick) {
    if (tick == 7 * kRate) {
      block.state.asked.walks = Floats<kWidth>{};
      for (Block<1>& walk : alone) walk.state.asked.walks = 0.0f;
    }
    advance(*tables, block, Poses{local.data(), root.data(), kWidth});
    for (int w = 0; w < kWidth; ++w) {
      quat* to = one.local.data();
      vec3* root_m = &one.root_m;
      advance(*tables, alone[w], Poses{&to, &root_m, 1});
      Block<1> lane_of;
      copy_walk(block, w, lane_of, 0);
      ASSERT_EQ(std::memcmp(&lane_of, &alone[w], kStateNumbers<float> * sizeof(float)), 0)
          << "tick " << tick << " walk " << w;
      ASSERT_EQ(one.root_m, pose[w].root_m);
      for (const LegBuild& leg : adult().leg)
        for (int j : {0, 1, 2})
          ASSERT_EQ(one.local[leg.joint[j].joint], pose[w].local[leg.joint[j].joint]);
    }
  }
  EXPECT_GT(alone[0].origin[0].z_m, 3.5);
}
TEST(GroundWidths, FourWalksHaveTheBitsOfOneAlone) { expect_same_bits<4>(); }
TEST(GroundWidths, EightWalksHaveTheBitsOfOneAlone) {
  if (!__builtin_cpu_supports("avx2")) GTEST_SKIP() << "this processor has no AVX2";
  expect_same_bits<8>();
}
TEST(GroundWidths, SixteenWalksHaveTheBitsOfOneAlone) {
  if (!__builtin_cpu_supports("avx512dq")) GTEST_SKIP() << "this processor has no AVX-512";
  expect_same_bits<16>();
}

// --- Moved walks ---------------------------------------------------------------------------------

TEST(Moved, WalkHasInItsOwnCoordinatesTheBitsOfOneThatIsNot) {
  const WalkModel model = model_on(ground_of({FlatSection{3.0}, StairsSection{0.17, 0.28, 5}}));
  Hiker stays(model), goes(model);
  Placement placed;
  for (int tick = 0; tick < 8 * kRate; ++tick) {
    const GaitParams params = params_of(tick > 5 * kRate ? 0.2 : 0.0, 0.7);
    if (tick % 37 == 5) {  // a platform, and now and then a teleport
      const Placement by{vec3(0.3, tick == 1189 ? 200.0 : 0.1, tick == 1226 ? -5e4 : 0.02),
                         0.1 * tick};
      move_walk(by, 0, goes.block);
      placed = moved(by, placed);
    }
    stays.step(params);
    goes.step(params);
    ASSERT_EQ(std::memcmp(&stays.block, &goes.block, kStateNumbers<float> * sizeof(float)), 0);
    ASSERT_EQ(goes.pose.root_m, to_world(placed, stays.pose.root_m));
    const int pelvis = stays.tables().pelvis;
    for (int j = 0; j < stays.pose.joint_count; ++j) {
      if (j == pelvis) continue;
      ASSERT_EQ(stays.pose.local[j], goes.pose.local[j]) << j;
    }
    ASSERT_EQ(goes.pose.local[pelvis], rotation_y(placed.heading_rad) * stays.pose.local[pelvis]);
  }
}

TEST(Stand, MayBeAnywhereAndFaceAnyWay) {
  Hiker here(adult());
  const Placement there{vec3(-7e5, 0.0, 3e5), 2.5};
  Hiker far(adult(), {there.place_m.x, there.place_m.z, there.heading_rad});
  for (int tick = 0; tick < 3 * kRate; ++tick) {
    here.step(params_of(0.2, 0.8));
    far.step(params_of(0.2, 0.8));
    EXPECT_LE(glm::distance(far.pose.root_m, to_world(there, here.pose.root_m)), 1e-6);
  }
}

// --- Aims and pushes -----------------------------------------------------------------------------

// Walks until the foot that swings has a step of so many ticks behind it.
void walk_to(Hiker& hiker, int tick, bool flies) {
  for (int n = 0; n < 4 * kRate; ++n) {
    hiker.step(params_of(0.0, 0.8));
    if (n > 3 * kRate && hiker.block.state.tick == static_cast<float>(tick) &&
        (hiker.block.state.flies != 0.0f) == flies)
      return;
  }
  FAIL();
}
// What is seen until so many strikes later: the footprints, and how far planted points stray.
struct Steps {
  std::vector<Placement> prints;
  double slid_m = 0.0, bend_m_s2 = 0.0;
};
Steps see_steps(Hiker& hiker, int strikes) {
  Steps seen;
  std::array<vec3, 3> hips;
  int ticks = 0;
  while (static_cast<int>(seen.prints.size()) < strikes) {
    const bool right = hiker.block.state.right_swings != 0.0f;
    const Planted planted = planted_of(hiker.block);
    const vec3 before = end_of(hiker.pose, planted.side, planted.toe);
    const bool begins = hiker.block.state.tick == 0.0f;
    hiker.step(params_of(0.0, 0.8));
    if (!begins)
      seen.slid_m = std::max(seen.slid_m,
                             glm::distance(end_of(hiker.pose, planted.side, planted.toe), before));
    hips = {hiker.pose.root_m, hips[0], hips[1]};
    if (++ticks > 3)
      seen.bend_m_s2 = std::max(
          seen.bend_m_s2, horizontal_length(hips[0] - 2.0 * hips[1] + hips[2]) * kRate * kRate);
    const Origin& origin = hiker.block.origin[0];
    if ((hiker.block.state.right_swings != 0.0f) != right)
      seen.prints.push_back({vec3(origin.x_m, 0.0, origin.z_m), origin.heading_rad});
  }
  return seen;
}

TEST(StepTo, PutsTheHeelThereOrSaysThatItCannot) {
  constexpr double kThere_m = 1e-5;
  for (const bool flies : {false, true}) {
    for (const double aside : {-0.01, 0.0, 0.1}) {
      for (const double on : {-0.2, 0.0, 0.12}) {
        Hiker plain(adult()), aimed(adult());
        walk_to(plain, 10, flies);
        walk_to(aimed, 10, flies);
        const Steps level = see_steps(plain, 4);
        Placement goal = level.prints[0];
        const double outwards = aimed.block.state.right_swings != 0.0f ? -1.0 : 1.0;
        goal.place_m += vec3(outwards * aside, 0.0, on);
        goal.heading_rad += 0.1;
        ASSERT_EQ(step_to(aimed.tables(), goal, false, aimed.block), Aim::taken);
        const Steps seen = see_steps(aimed, 4);
        EXPECT_LE(glm::distance(seen.prints[0].place_m, goal.place_m), kThere_m);
        EXPECT_NEAR(seen.prints[0].heading_rad, goal.heading_rad, 1e-5);
        EXPECT_LE(seen.slid_m, kPlanted_m);
        // The steps after it are as long as ever.
        EXPECT_NEAR(seen.prints[3].place_m.z - seen.prints[2].place_m.z,
                    level.prints[3].place_m.z - level.prints[2].place_m.z, 1e-3);
      }
    }
  }
  Hiker far(adult());
  walk_to(far, 10, false);
  const Placement beyond{vec3(0.0, 0.0, 40.0), 0.0};
  EXPECT_EQ(step_to(far.tables(), beyond, false, far.block), Aim::refused);
  EXPECT_EQ(step_to(far.tables(), beyond, true, far.block), Aim::nearest);
  EXPECT_LE(see_steps(far, 3).slid_m, kPlanted_m);
  walk_to(far, 60, true);
  EXPECT_EQ(step_to(far.tables(), beyond, true, far.block), Aim::refused);
  Hiker stands(adult());
  EXPECT_EQ(step_to(stands.tables(), beyond, true, stands.block), Aim::refused);
}

TEST(Push, MovesTheHipsAndTheNextFootprintCatchesThem) {
  constexpr double kPush_m_s = 0.5;
  for (const bool flies : {false, true}) {
    Hiker plain(adult()), pushed(adult());
    walk_to(plain, 10, flies);
    walk_to(pushed, 10, flies);
    ASSERT_TRUE(push(pushed.tables(), vec3(kPush_m_s, 0.0, 0.0), pushed.block));
    const double before = pushed.pose.root_m.x - plain.pose.root_m.x;
    for (int tick = 0; tick < 6; ++tick) {
      plain.step(params_of(0.0, 0.8));
      pushed.step(params_of(0.0, 0.8));
    }
    const double faster = (pushed.pose.root_m.x - plain.pose.root_m.x - before) / (6 * kDt);
    EXPECT_NEAR(faster, kPush_m_s, 0.15 * kPush_m_s);
    const Steps level = see_steps(plain, 4), seen = see_steps(pushed, 4);
    const double aside_m = seen.prints[0].place_m.x - level.prints[0].place_m.x;
    std::printf(
        "%.3f m/s more; prints %.3f %.3f %.3f m aside; hips bend by %.1f, else %.1f m/s^2\n",
        faster, aside_m, seen.prints[1].place_m.x - level.prints[1].place_m.x,
        seen.prints[3].place_m.x - level.prints[3].place_m.x, seen.bend_m_s2, level.bend_m_s2);
    EXPECT_NEAR(aside_m, kPush_m_s * std::sqrt(pushed.tables().leg_m / 9.81), 0.01);
    EXPECT_LE(seen.slid_m, kPlanted_m);
  }
  Hiker stands(adult());
  EXPECT_FALSE(push(stands.tables(), vec3(kPush_m_s, 0.0, 0.0), stands.block));
}

}  // namespace
}  // namespace gaitpad::anew

#include "paper/claims.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "motion/made_motion.h"
#include "paper/paper_fixture.h"
#include "paper/study.h"

namespace gaitpad {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Bound, SaysWhatItHolds) {
  EXPECT_TRUE(holds(at_most(2.0), 2.0));
  EXPECT_FALSE(holds(less_than(2.0), 2.0));
  EXPECT_TRUE(holds(at_least(2.0), 2.0));
  EXPECT_FALSE(holds(more_than(2.0), 2.0));
  EXPECT_TRUE(holds(within(1.0, 2.0), 1.0));
  EXPECT_FALSE(holds(within(1.0, 2.0), 2.1));
  EXPECT_FALSE(holds(equal_to(0.0), 1e-12));
  EXPECT_EQ(text_of(at_most(0.95)), "<= 0.95");
  EXPECT_EQ(text_of(within(0.44, 0.56)), "0.44 .. 0.56");
  for (const Bound& bound : {at_most(2.0), less_than(2.0), at_least(2.0), more_than(2.0),
                             within(1.0, 2.0), equal_to(0.0)}) {
    for (const double none : {kNan, kInfinity, -kInfinity}) EXPECT_FALSE(holds(bound, none));
  }
}

TEST(Claims, JsonHasTheContractsKeysAndNullsWithReasons) {
  ClaimList list("4", IkMode::paper);
  list.add("13 a ratio", 0.5, at_most(0.95), "measured");
  list.add("23 no number", kNan, at_most(1.0));
  list.add_untested("24 symmetry", equal_to(0), "a captured walk is not symmetric");
  const auto json = nlohmann::json::parse(claims_json("walk\xff.bvh", list.take_claims()));
  const auto& rows = json.at("claims");
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0], (nlohmann::json{{"name", "13 a ratio"},
                                     {"section", "4"},
                                     {"mode", "paper"},
                                     {"value", 0.5},
                                     {"bound", "<= 0.95"},
                                     {"pass", true},
                                     {"note", "measured"}}));
  EXPECT_TRUE(rows[1].at("value").is_null());
  EXPECT_EQ(rows[1].at("pass"), false);
  EXPECT_TRUE(rows[2].at("pass").is_null());
  EXPECT_EQ(rows[2].at("note"), "a captured walk is not symmetric");
}

// Each group of claims fails if its measurement is broken: a walk is damaged by hand and the claim
// about it must fail, while the undamaged walk passes.

using test::claim_of;
using test::even;
using test::passes;
using test::study;
constexpr IkMode kRobust = IkMode::robust;

std::size_t middle_of_flight(const Walk& walk, Side side) {
  const Ticks f = flights(walk, side, 4.0).front();
  return (f.begin + f.end) / 2;
}

TEST(PaperClaims, APlantedFootThatSlidesAWrongStageAndAWrongPlantAreSeen) {
  EXPECT_LT(planted_slide_mm(even()), 0.1);
  Walk broken = even();
  WalkFrame& flying = broken.samples[middle_of_flight(broken, kRightSide)].frame;
  flying.toe_m[kLeftSide].x += 0.0005;
  EXPECT_NEAR(planted_slide_mm(broken), 0.5, 0.01);
  const auto claims = table_1_claims(broken, 0.0, kRobust);
  EXPECT_FALSE(passes(claims, "7 support toe moves in stage a, mm"));
  EXPECT_TRUE(passes(claims, "7 landed heel and support toe move in stage b, mm"));
  EXPECT_TRUE(passes(claims, "7 stages out of order"));
  flying.heel_planted[kRightSide] = true;
  EXPECT_EQ(claim_of(table_1_claims(broken, 0.0, kRobust),
                     "7 ticks whose planted points are not table I's")
                .value,
            1.0);
  flying.swing = kLeftSide;
  EXPECT_FALSE(passes(table_1_claims(broken, 0.0, kRobust), "7 stages out of order"));
}

TEST(PaperClaims, AJumpAtAStagesBorderIsSeen) {
  const FootBuild build = foot_build(study().model());
  const char* name = "8 jump of a leg angle's rate at a stage's border, deg per 1/60 s";
  EXPECT_TRUE(passes(continuity_claims(even(), build, 3.5, kRobust), name));
  Walk broken = even();
  const Ticks flight = flights(broken, kRightSide, 4.0).front();
  broken.samples[flight.begin].angles_rad[kRightSide][kKneeX] += 2.0 * kDegree;
  EXPECT_FALSE(passes(continuity_claims(broken, build, 3.5, kRobust), name));
}

TEST(PaperClaims, HipsThatStandStillAndASunkToeAreSeen) {
  const FootBuild build = foot_build(study().model());
  Walk broken = even();
  const std::size_t k = middle_of_flight(broken, kRightSide);
  broken.samples[k].frame.pelvis_m = broken.samples[k - 1].frame.pelvis_m;
  broken.samples[k].frame.toe_m[kRightSide].y = build.toe_rest_m[kRightSide] - 0.002;
  const auto claims = continuity_claims(broken, build, 3.5, kRobust);
  EXPECT_FALSE(passes(claims, "8 least forward speed of the hips, m/s"));
  EXPECT_NEAR(*claim_of(claims, "8 heel or toe below its height of rest, mm").value, 2.0, 1e-6);
}

TEST(PaperClaims, WeightsThatDoNothingFail) {
  const Ticks stride = study().figure_stride(even());
  const auto claims = weight_claims({&even(), &even(), &even()}, stride, kRobust);
  EXPECT_FALSE(passes(claims, "13 RMS change of the hip of stiff_hip against even, deg"));
  EXPECT_FALSE(passes(claims, "14 RMS change of the hip of stiff_knee against even, deg"));
  EXPECT_EQ(claim_of(claims, "13 hip range of stiff_hip over even").value, 1.0);
  EXPECT_TRUE(passes(claims, "16 landing places of the heels differ, mm"));
}

TEST(PaperClaims, AFootThatLandsElsewhereIsSeen) {
  const Ticks stride = study().figure_stride(even());
  Walk moved = study().walk("stiff_hip", kRobust);
  for (std::size_t k = stride.begin; k < stride.begin + 5; ++k) {
    moved.samples[k].frame.heel_m[kRightSide].z += 0.0015;
  }
  const WeightWalks walks = {&even(), &moved, &study().walk("stiff_knee", kRobust)};
  EXPECT_NEAR(
      *claim_of(weight_claims(walks, stride, kRobust), "16 landing places of the heels differ, mm")
           .value,
      1.5, 0.01);
}

TEST(PaperClaims, MonotoneMeansEveryStepGrows) {
  EXPECT_EQ(monotone_claims({0.1, 0.2, 0.4, 0.8}, kRobust)[0].pass, true);
  EXPECT_EQ(monotone_claims({0.1, 0.4, 0.2, 0.8}, kRobust)[0].value, 1.0);
  EXPECT_EQ(monotone_claims({0.1, 0.1, 0.2, 0.8}, kRobust)[0].pass, false);
}

TEST(PaperClaims, AWalkThatDoesNotLimpFails) {
  const auto claims = limp_claims({&even(), &even(), &even(), &even()}, kRobust);
  EXPECT_NEAR(*claim_of(claims, "18 left heel's peak of the limp over even's").value, 1.0, 1e-12);
  EXPECT_FALSE(passes(claims, "18 left heel's peak of the limp over even's"));
  EXPECT_FALSE(passes(claims, "18 left step of the limp over its right step"));
  EXPECT_FALSE(passes(claims, "18 ticks of the left flight off even's / 1.3"));
  EXPECT_TRUE(passes(claims, "18 right step of the limp over even's"));
  EXPECT_FALSE(passes(claims, "19 right step over the left one"));
}

TEST(PaperClaims, WeightsOfTheLeftLegThatMoveTheRightOneAreSeen) {
  const Walk &limp = study().walk("limp_left", kRobust),
             &hip = study().walk("limp_left_hip", kRobust),
             &knee = study().walk("limp_left_knee", kRobust);
  const Ticks stride = study().figure_stride(limp);
  const char* name = "20 right leg's angles change by, deg";
  EXPECT_TRUE(passes(limp_weight_claims({&even(), &limp, &hip, &knee}, stride, kRobust), name));
  Walk broken = hip;
  broken.samples[stride.begin + 20].angles_rad[kRightSide][kAnkleZ] += 1.2 * kDegree;
  EXPECT_NEAR(
      *claim_of(limp_weight_claims({&even(), &limp, &broken, &knee}, stride, kRobust), name).value,
      1.2, 0.05);
}

TEST(PaperClaims, ADriftOverTwoHundredStridesIsSeen) {
  WalkCase what;
  what.model = &study().model();
  what.end_s = 250.0;
  Walk walk = walked(what);
  EXPECT_EQ(endurance_claims(walk, kRobust)[0].pass, true);
  const double n = static_cast<double>(walk.samples.size());
  for (std::size_t k = 0; k < walk.samples.size(); ++k) {
    walk.samples[k].angles_rad[kLeftSide][kKneeX] += 3.0 * kDegree * static_cast<double>(k) / n;
  }
  const auto claims = endurance_claims(walk, kRobust);
  EXPECT_EQ(claims[0].pass, false);
  EXPECT_EQ(claims[1].pass, false);
  walk.samples.resize(2000);
  EXPECT_FALSE(endurance_claims(walk, kRobust)[0].pass.has_value());
}

constexpr const char* kArmClaim = "28 hand against the opposite hip, correlation";

TEST(PaperClaims, WithoutNamesTheArmsAreFoundByTheSkeletonsShape) {
  PaperSource source = study().source();
  for (Joint& joint : source.cycle.skeleton.joints) joint.name = "joint";
  auto nameless = Study::of(std::move(source));
  ASSERT_TRUE(nameless);
  EXPECT_TRUE(passes(body_claims(*nameless), kArmClaim));
}

TEST(PaperClaims, OfAMotionWithoutHandsTheArmsAreNotJudged) {
  PaperSource source = study().source();
  GaitCycle& cycle = source.cycle;
  ASSERT_EQ(cycle.skeleton.joints[11].name, "Spine");
  keep_legs_alone(cycle);
  auto legs_alone = Study::of(std::move(source));
  ASSERT_TRUE(legs_alone);
  EXPECT_FALSE(claim_of(body_claims(*legs_alone), kArmClaim).pass.has_value());
}

}  // namespace

}  // namespace gaitpad

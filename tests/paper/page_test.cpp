#include "paper/page.h"

#include <gtest/gtest.h>

#include <limits>

#include "paper/paper_fixture.h"

namespace gaitpad {
namespace {

TEST(Page, CsvHasAColumnACurveAndGapsWhereThereIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(csv_text({{"time_s", {0.0, 0.5}}, {"even_left_hip_deg", {1.25}}, {"x_m", {nan, -3.0}}}),
            "time_s,even_left_hip_deg,x_m\n0,1.25,\n0.5,,-3\n");
}

TEST(Page, PlacesMapToPixels) {
  const SideView view{{10.0, 0.0, 300.0, 200.0}, 1.0, 190.0, 100.0};
  EXPECT_EQ(pixel_in(view, vec3(5.0, 0.5, 2.0)), vec2(110.0, 140.0));
}

TEST(Page, AStickFigureHasBothSolesAndTellsTheLegsApart) {
  const WalkSample& sample = test::even().samples.back();
  const GaitCycle& cycle = test::study().model().cycle;
  const auto points = figure_points(sample.joints_m, sample.frame.heel_m);
  int left = 0, right = 0, soles = 0;
  const int joints = static_cast<int>(cycle.skeleton.joints.size());
  for (const StickBone& bone : stick_bones(cycle, points)) {
    left += bone.part == StickBone::Part::left_leg;
    right += bone.part == StickBone::Part::right_leg;
    soles += bone.parent >= joints || bone.joint >= joints;
  }
  EXPECT_EQ(left, right);
  EXPECT_GE(left, 5);  // lines for thigh, shank and foot, and two for the sole
  EXPECT_EQ(soles, 4);
}

}  // namespace
}  // namespace gaitpad

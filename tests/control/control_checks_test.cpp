// Messages of check() for styles, parameters and limits: the field, its value, its range.
#include <gtest/gtest.h>

#include <limits>

#include "control/params_range.h"
#include "gaitpad/control.h"

namespace gaitpad {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

template <class T>
std::string said_of(const T& checked) {
  const auto problem = check(checked);
  return problem ? problem->message : "";
}

TEST(Check, TheDefaultsAreSound) {
  EXPECT_EQ(said_of(StyleValues{}), "");
  EXPECT_EQ(said_of(GaitParams{}), "");
  EXPECT_EQ(said_of(GaitLimits{}), "");
  EXPECT_EQ(said_of(gait_params({.left = vec2(1.0, 1.0)}, StyleValues{}, GaitLimits{})), "");
}

TEST(Check, ASentenceNamesFieldValueAndRange) {
  StyleValues style;
  style.stride[kLeftSide].length = kNaN;
  EXPECT_EQ(said_of(style), "StyleValues: left_leg.stride_length is nan, outside [0, 1.5]");
  style = {};
  style.weight[kRightSide].fill(0.0);
  EXPECT_EQ(said_of(style),
            "StyleValues: right_leg.weight: all are 0, one at least must be above 0");
  GaitParams params;
  params.stride[1].time_s = 0.0;
  EXPECT_EQ(said_of(params), "GaitParams: stride[1].time_s is 0, outside [0.05, 20]");
  params = {};
  params.body.hand[0].rail = 2.0;
  EXPECT_EQ(said_of(params), "GaitParams: left_hand.rail is 2, outside [0, 1]");
  params = {};
  params.body.head.z_m = 5000.0;  // a valid place in a large world
  EXPECT_EQ(said_of(params), "");
  GaitLimits limits;
  limits.max_step_time_s = -1.0;
  EXPECT_EQ(said_of(limits), "GaitLimits: max_step_time_s is -1, outside [0.05, 50]");
}

// The numbers have the order of the fields: a number that is set through a field appears at its
// index.
TEST(Check, TheNumbersOfParametersAreAllOfThem) {
  GaitParams params;
  EXPECT_EQ(numbers_of(params).size(), 67u);
  params.stride[0].length_m = 3.0;
  params.body.idle = 7.0;
  EXPECT_EQ(numbers_of(params).front(), 3.0);
  EXPECT_EQ(numbers_of(params).back(), 7.0);
  for (std::size_t k = 0; k < kParamsNumbers; ++k)
    EXPECT_LT(numbers_of(params_range().least)[k], numbers_of(params_range().most)[k]) << k;
}

}  // namespace
}  // namespace gaitpad

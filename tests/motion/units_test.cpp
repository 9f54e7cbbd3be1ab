#include <gtest/gtest.h>

#include "gaitpad/motion_file.h"

namespace gaitpad {
namespace {

TEST(Units, AnAdultsLegTellsTheUnit) {
  EXPECT_EQ(metres_per_unit(0.84), 1.0);
  EXPECT_EQ(metres_per_unit(8.4), 0.1);
  EXPECT_EQ(metres_per_unit(86.0), 0.01);
  EXPECT_EQ(metres_per_unit(840.0), 0.001);
  EXPECT_EQ(metres_per_unit(35.7), 0.0254);            // inches
  EXPECT_EQ(metres_per_unit(2.8), 0.3048);             // feet
  EXPECT_NEAR(metres_per_unit(14.8), 0.0564, 0.0001);  // CMU
}

TEST(Units, WhereNoUnitFitsTheLegBecomesAnAdults) {
  EXPECT_DOUBLE_EQ(metres_per_unit(50.0) * 50.0, kAdultLegM);
  EXPECT_DOUBLE_EQ(metres_per_unit(0.01) * 0.01, kAdultLegM);
}

TEST(Units, NoLegFitsTwoUnits) {
  constexpr double kUnits[] = {1.0, 0.1, 0.01, 0.001, 0.0254, 0.3048, 0.0254 / 0.45};
  for (double leg = 0.1; leg < 2000.0; leg *= 1.01) {
    int fits = 0;
    for (const double unit : kUnits) fits += leg * unit >= 0.65 && leg * unit <= 1.05;
    EXPECT_LE(fits, 1) << leg;
  }
}

}  // namespace
}  // namespace gaitpad

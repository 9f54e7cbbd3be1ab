#include "base/shown_number.h"

#include <gtest/gtest.h>

#include <limits>

namespace gaitpad {
namespace {

TEST(SignedNumber, HasItsSignAndZeroIsNeverNegative) {
  EXPECT_EQ(signed_number(0.25, 2), "+0.25");
  EXPECT_EQ(signed_number(-0.25, 2), "-0.25");
  EXPECT_EQ(signed_number(-0.0, 2), "+0.00");
  EXPECT_EQ(signed_number(-0.004, 2), "+0.00");
  EXPECT_EQ(signed_number(-0.004, 3), "-0.004");
  EXPECT_EQ(signed_number(-0.006, 2), "-0.01");
  EXPECT_EQ(signed_number(-12.3, 0), "-12");
}

TEST(ShownNumber, HasNoSignBeforeZeroAndNoneBeforePositiveNumbers) {
  EXPECT_EQ(shown_number(1.25, 1), "1.2");
  EXPECT_EQ(shown_number(-0.04, 1), "0.0");
  EXPECT_EQ(shown_number(-0.06, 1), "-0.1");
  EXPECT_EQ(shown_number(-0.4, 0), "0");
}

TEST(SignedNumber, ANumberThatIsNotFiniteIsADash) {
  EXPECT_EQ(signed_number(std::numeric_limits<double>::quiet_NaN(), 2), "-");
  EXPECT_EQ(signed_number(-std::numeric_limits<double>::infinity(), 2), "-");
}

}  // namespace
}  // namespace gaitpad

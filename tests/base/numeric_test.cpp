#include "base/numeric.h"

#include <gtest/gtest.h>

namespace gaitpad {
namespace {

TEST(Numeric, MediansAndPercentilesAreValues) {
  EXPECT_EQ(median({3.0, 1.0, 2.0}), 2.0);
  EXPECT_EQ(median({4.0, 1.0, 3.0, 2.0}), 3.0) << "the upper middle";
  EXPECT_EQ(percentile({5.0}, 95), 5.0);
  EXPECT_EQ(percentile({3.0, 1.0, 2.0}, 0), 1.0);
  EXPECT_EQ(percentile({3.0, 1.0, 2.0}, 50), 2.0);
  EXPECT_EQ(percentile({3.0, 1.0, 2.0}, 99), 2.0);
  EXPECT_EQ(percentile({3.0, 1.0, 2.0}, 100), 3.0);
  EXPECT_EQ(median({}), 0.0);
  EXPECT_EQ(percentile({}, 99), 0.0);
}

}  // namespace
}  // namespace gaitpad

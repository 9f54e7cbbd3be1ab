#include "paper/claims.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

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
}

TEST(Bound, NoNumberHoldsNothing) {
  for (const Bound& bound : {at_most(2.0), less_than(2.0), at_least(2.0), more_than(2.0),
                             within(1.0, 2.0), equal_to(0.0)}) {
    EXPECT_FALSE(holds(bound, kNan));
    EXPECT_FALSE(holds(bound, kInfinity));
    EXPECT_FALSE(holds(bound, -kInfinity));
  }
}

TEST(Claims, JsonHasTheContractsKeysAndNullsWithReasons) {
  ClaimList list("4", IkMode::paper);
  list.add("13 a ratio", 0.5, at_most(0.95), "measured");
  list.add("23 no number", kNan, at_most(1.0));
  list.add_untested("24 symmetry", equal_to(0), "a captured walk is not symmetric");
  const auto json = nlohmann::json::parse(claims_json("walk\xff.bvh", list.take()));
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

}  // namespace
}  // namespace gaitpad

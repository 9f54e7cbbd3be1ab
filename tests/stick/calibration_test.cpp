#include "gaitpad/calibration.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

namespace gaitpad {
namespace {

constexpr ZoneShape kShapes[] = {ZoneShape::radial, ZoneShape::axial, ZoneShape::both};

StickCalibration shaped(ZoneShape shape, double inner = 0.2, double outer = 0.95,
                        double curve = 0.0) {
  StickCalibration c;
  c.shape = shape;
  c.inner = inner;
  c.outer = outer;
  c.curve = curve;
  return c;
}
vec2 polar(double radius, double angle_rad) {
  return vec2(radius * std::cos(angle_rad), radius * std::sin(angle_rad));
}

TEST(StickPosition, InsideTheInnerZoneIsExactlyZero) {
  for (const ZoneShape shape : kShapes) {
    for (int i = 0; i < 360; ++i) {
      const vec2 p = stick_position(shaped(shape), polar(0.1999, i * kDegree));
      EXPECT_EQ(p, vec2(0.0));
      EXPECT_FALSE(std::signbit(p.x) || std::signbit(p.y));
    }
  }
}

TEST(StickPosition, OuterZoneHasLengthOne) {
  for (double radius : {0.9501, 1.0, 1.3}) {
    for (int i = 0; i < 360; ++i) {
      const vec2 raw = glm::clamp(polar(radius, i * kDegree), -1.0, 1.0);
      EXPECT_NEAR(glm::length(stick_position(shaped(ZoneShape::radial), raw)), 1.0, 4e-16);
    }
    EXPECT_EQ(stick_position(shaped(ZoneShape::both), {0.0, radius}), vec2(0.0, 1.0));
    EXPECT_EQ(stick_position(shaped(ZoneShape::both), {-radius, 0.0}), vec2(-1.0, 0.0));
  }
}

// The sideways zone shortens a full deflection by up to 3 %: the smallest length of (cos a, (sin a
// - 0.11) / 0.89).
TEST(StickPosition, SidewaysZoneTakesAtMostThreePercentOfTheLength) {
  double shortest = 1.0;
  for (int i = 0; i < 3600; ++i) {
    const vec2 p = stick_position(shaped(ZoneShape::both), polar(1.0, i * 0.1 * kDegree));
    shortest = std::min(shortest, glm::length(p));
  }
  EXPECT_GE(shortest, 1.0 - 0.0300);
  EXPECT_LE(shortest, 1.0 - 0.0290);
}

TEST(StickPosition, NearlyStraightIsExactlyStraightWithBothOnly) {
  for (double x : {-0.1, -1.0 / 255.0, 1.0 / 255.0, 0.1}) {
    EXPECT_EQ(stick_position(shaped(ZoneShape::both), {x, 0.9}).x, 0.0);
    EXPECT_NE(stick_position(shaped(ZoneShape::radial), {x, 0.9}).x, 0.0);
  }
}

TEST(StickPosition, ScaledLinearlyBetweenTheZones) {
  EXPECT_NEAR(stick_position(shaped(ZoneShape::both, 0.2, 0.8), {0.0, 0.5}).y, 0.5, 1e-15);
  EXPECT_NEAR(stick_position(shaped(ZoneShape::both, 0.2, 0.8), {0.0, 0.35}).y, 0.25, 1e-15);
  // To the side both zones apply: the radial zone gives 0.5, then the sideways zone gives (0.5 -
  // 0.11) / 0.89.
  EXPECT_NEAR(stick_position(shaped(ZoneShape::both, 0.2, 0.8), {0.5, 0.0}).x, 0.39 / 0.89, 1e-15);
  EXPECT_NEAR(stick_position(shaped(ZoneShape::axial, 0.2, 0.8), {0.5, 0.35}).y, 0.25, 1e-15);
}

TEST(StickPosition, CurveBlendsLinearAndCubic) {
  EXPECT_NEAR(stick_position(shaped(ZoneShape::radial, 0.2, 0.8, 1.0), {0.0, 0.5}).y, 0.125, 1e-15);
  EXPECT_NEAR(stick_position(shaped(ZoneShape::radial, 0.2, 0.8, 0.5), {0.0, 0.5}).y, 0.3125,
              1e-15);
  EXPECT_EQ(stick_position(shaped(ZoneShape::radial, 0.2, 0.8, 1.0), {0.0, 0.8}).y, 1.0);
}

TEST(StickPosition, ContinuousOverTheWholeGate) {
  constexpr double kStep = 4e-3;
  for (const ZoneShape shape : kShapes) {
    for (double curve : {0.0, 1.0}) {
      const StickCalibration c = shaped(shape, 0.12, 0.95, curve);
      for (double y = -1.0; y <= 1.0; y += 0.04) {
        vec2 before = stick_position(c, {-1.0, y});
        for (double x = -1.0; x <= 1.0; x += kStep) {
          const vec2 now = stick_position(c, {x, y});
          // The slope is at most 3 (cubic) / 0.83 (range between the zones) / 0.89 (sideways),
          // doubled for the change of direction.
          ASSERT_LE(glm::length(now - before), 8.0 * kStep) << x << " " << y;
          before = now;
        }
      }
    }
  }
}

TEST(StickPosition, OddAboutTheCentre) {
  for (const ZoneShape shape : kShapes) {
    for (double x = -1.0; x <= 1.0; x += 0.037) {
      for (double y = -1.0; y <= 1.0; y += 0.041) {
        const StickCalibration c = shaped(shape, 0.12, 0.95, 0.3);
        EXPECT_EQ(stick_position(c, {-x, -y}), -stick_position(c, {x, y}));
        EXPECT_EQ(stick_position(c, {-x, y}).y, stick_position(c, {x, y}).y);
        EXPECT_EQ(stick_position(c, {-x, y}).x, -stick_position(c, {x, y}).x);
      }
    }
  }
}

TEST(StickPosition, MonotoneAlongEveryDirection) {
  for (const ZoneShape shape : kShapes) {
    for (int i = 0; i < 91; i += 3) {
      vec2 before(0.0);
      for (double radius = 0.0; radius <= 1.0; radius += 0.01) {
        const vec2 now = stick_position(shaped(shape, 0.12, 0.95, 0.7), polar(radius, i * kDegree));
        ASSERT_GE(glm::length(now), glm::length(before) - 1e-15);
        // With the axial shape the limit to the unit disc changes the direction once an axis is
        // full.
        if (shape != ZoneShape::axial) {
          ASSERT_GE(now.x, before.x - 1e-15);
          ASSERT_GE(now.y, before.y - 1e-15);
        }
        before = now;
      }
    }
  }
}

TEST(StickPosition, StaysInTheUnitDiscForAnyInput) {
  for (const ZoneShape shape : kShapes) {
    for (double x = -1.5; x <= 1.5; x += 0.05) {
      for (double y = -1.5; y <= 1.5; y += 0.05) {
        StickCalibration c = shaped(shape);
        c.x = {-0.3, 0.2, 0.4};
        ASSERT_LE(glm::length(stick_position(c, {x, y})), 1.0 + 4e-16);
      }
    }
  }
}

TEST(StickPosition, CentreAndUnequalRangesAreCorrected) {
  StickCalibration c = shaped(ZoneShape::radial, 0.1, 0.9);
  c.x = {-0.8, 0.06, 0.96};
  c.y = {-1.0, -0.04, 0.6};
  EXPECT_EQ(stick_position(c, {0.06, -0.04}), vec2(0.0));
  EXPECT_NEAR(stick_position(c, {0.51, -0.04}).x, 0.5, 1e-15);
  EXPECT_NEAR(stick_position(c, {-0.37, -0.04}).x, -0.5, 1e-15);
  EXPECT_NEAR(stick_position(c, {0.06, 0.28}).y, 0.5, 1e-15);
  EXPECT_EQ(stick_position(c, {0.06, 0.6}).y, 1.0);
}

TEST(StickPosition, NotANumberCountsAsTheCentre) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(stick_position(shaped(ZoneShape::both), {nan, 1.0}), vec2(0.0, 1.0));
  EXPECT_EQ(stick_position(shaped(ZoneShape::both), {inf, nan}), vec2(0.0));
  StickCalibration turned = shaped(ZoneShape::both);
  turned.frame = {RawDirection::minus_y, RawDirection::minus_x};
  EXPECT_EQ(stick_position(turned, {-1.0, nan}), vec2(0.0, 1.0));
}

TEST(StickPosition, BothSticksHaveTheirOwnCalibration) {
  Calibration c;
  c.left.inner = 0.5;
  PadState pad;
  pad.axis[kLeftY] = pad.axis[kRightY] = 0.4f;
  const Stick stick = stick_position(c, pad);
  EXPECT_EQ(stick.left.y, 0.0);
  EXPECT_GT(stick.right.y, 0.0);
  static_assert(std::is_trivially_copyable_v<Calibration>);
}

TEST(Calibration, OneThatWouldDivideByZeroIsNamedByItsField) {
  const auto said_of = [](const auto& spoil) {
    Calibration c;
    spoil(c);
    const auto problem = check(c);
    return problem ? problem->message : "";
  };
  using C = Calibration;
  EXPECT_EQ(said_of([](C&) {}), "");
  EXPECT_EQ(said_of([](C& c) { c.left.inner = std::nan(""); }),
            "Calibration: left.inner is nan, outside [0, 0.9]");
  EXPECT_EQ(said_of([](C& c) { c.left.inner = c.left.outer = 0.5; }),
            "Calibration: left.outer - inner is 0, outside [0.05, 1]");
  EXPECT_EQ(said_of([](C& c) { c.right.x.min = c.right.x.centre; }),
            "Calibration: right.x.centre - min is 0, outside [0.1, 2]");
  EXPECT_EQ(said_of([](C& c) { c.right.y.max = 0.05; }),
            "Calibration: right.y.max - centre is 0.05, outside [0.1, 2]");
  EXPECT_EQ(said_of([](C& c) { c.left.sideways = 1.0; }),
            "Calibration: left.sideways is 1, outside [0, 0.5]");
  EXPECT_EQ(said_of([](C& c) { c.right_trigger.pressed = 0.0; }),
            "Calibration: right_trigger.pressed - released is 0, outside [0.1, 1]");
}

TEST(Calibration, CanonicalHasNoNegativeZeroAndKeepsEveryOtherNumber) {
  Calibration c;
  c.left.x = {-0.9, -0.0, 0.8};
  c.right.curve = -0.0;
  c.right_trigger.released = -0.0;
  const Calibration same = canonical(c);
  EXPECT_EQ(same, c);
  EXPECT_FALSE(std::signbit(same.left.x.centre));
  EXPECT_FALSE(std::signbit(same.right.curve));
  EXPECT_FALSE(std::signbit(same.right_trigger.released));
  EXPECT_TRUE(std::signbit(same.left.x.min));
}

constexpr RawDirection kXs[] = {RawDirection::plus_x, RawDirection::minus_x};
constexpr RawDirection kYs[] = {RawDirection::plus_y, RawDirection::minus_y};

// The raw stick position whose component along `direction` is `value`.
vec2 shown_along(RawDirection direction, double value) {
  switch (direction) {
    case RawDirection::plus_x:
      return {value, 0.0};
    case RawDirection::minus_x:
      return {-value, 0.0};
    case RawDirection::plus_y:
      return {0.0, value};
    case RawDirection::minus_y:
      return {0.0, -value};
  }
  return vec2(0.0);
}
std::vector<StickFrame> all_frames() {
  std::vector<StickFrame> frames;
  for (const RawDirection x : kXs) {
    for (const RawDirection y : kYs) {
      frames.push_back({x, y});
      frames.push_back({y, x});
    }
  }
  return frames;
}

TEST(StickFrame, EveryFrameGivesThePositionOfTheUprightFrame) {
  ASSERT_EQ(all_frames().size(), 8u);
  StickCalibration straight = shaped(ZoneShape::both, 0.1, 0.9, 0.2);
  straight.x = {-0.8, 0.06, 0.96};
  straight.y = {-1.0, -0.04, 0.6};
  for (const StickFrame& frame : all_frames()) {
    StickCalibration turned = straight;
    turned.frame = frame;
    for (double x = -1.0; x <= 1.0; x += 0.03) {
      for (double y = -1.0; y <= 1.0; y += 0.07) {
        const vec2 raw = shown_along(frame.right, x) + shown_along(frame.forward, y);
        ASSERT_EQ(in_frame(frame, raw), vec2(x, y));
        ASSERT_EQ(stick_position(turned, raw), stick_position(straight, {x, y}));
        if (glm::length(vec2(x, y) - vec2(0.06, -0.04)) > 0.09) continue;
        // Neutral has one bit pattern in every frame, because poses are compared bit by bit.
        ASSERT_EQ(std::bit_cast<std::uint64_t>(stick_position(turned, raw).x), 0u);
        ASSERT_EQ(std::bit_cast<std::uint64_t>(stick_position(turned, raw).y), 0u);
      }
    }
  }
}

TEST(TriggerPosition, GoesFromReleasedToPressedAndNotBeyond) {
  const TriggerCalibration c{0.125, 0.625};
  EXPECT_EQ(trigger_position(c, 0.0), 0.0);
  EXPECT_EQ(trigger_position(c, 0.125), 0.0);
  EXPECT_EQ(trigger_position(c, 0.25), 0.25);
  EXPECT_EQ(trigger_position(c, 0.625), 1.0);
  EXPECT_EQ(trigger_position(c, 1.0), 1.0);
  EXPECT_EQ(trigger_position(c, std::numeric_limits<double>::infinity()), 1.0);
  EXPECT_EQ(trigger_position(c, std::numeric_limits<double>::quiet_NaN()), 0.0);
}

TEST(TriggerPosition, AnUncalibratedTriggerPassesUnchanged) {
  for (double raw = 0.0; raw <= 1.0; raw += 1.0 / 255) EXPECT_EQ(trigger_position({}, raw), raw);
}

PadState pad_at(double left_x, double left_y, double right_x) {
  PadState pad;
  pad.axis[kLeftX] = static_cast<float>(left_x);
  pad.axis[kLeftY] = static_cast<float>(left_y);
  pad.axis[kRightX] = static_cast<float>(right_x);
  return pad;
}

TEST(JumpFilter, TakesOutASingleReportOfTheSticksThatAskForIt) {
  Calibration c;
  c.left.filters_jumps = true;
  JumpFilter filter;
  for (const double x : {0.1, 0.9, 0.1, -0.8, 0.1}) {
    const PadState state = pad_at(x, -x, x);
    filter.take(state);
    const PadState filtered = filter.filtered(c, state);
    EXPECT_EQ(filtered.axis[kLeftX], 0.1f);
    EXPECT_EQ(filtered.axis[kLeftY], -0.1f);
    EXPECT_EQ(filtered.axis[kRightX], state.axis[kRightX]);
  }
}

TEST(JumpFilter, AMovementIsOneReportLateAndCatchesUpInSilence) {
  Calibration c;
  c.left.filters_jumps = true;
  JumpFilter filter;
  double before = 0.6;  // the filter passes the first report at once
  for (const double x : {0.6, 0.7, 0.8, 0.9, 1.0}) {
    filter.take(pad_at(x, 0.0, 0.0));
    EXPECT_EQ(filter.filtered(c, pad_at(x, 0.0, 0.0)).axis[kLeftX], static_cast<float>(before));
    before = x;
  }
  filter.settle();
  EXPECT_EQ(filter.filtered(c, pad_at(1.0, 0.0, 0.0)).axis[kLeftX], 1.0f);
}

}  // namespace
}  // namespace gaitpad

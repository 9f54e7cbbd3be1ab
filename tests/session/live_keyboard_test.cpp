// The keyboard as a pad of a live session.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>

#include "gaitpad/decode.h"
#include "gaitpad/live.h"
#include "gaitpad/pad_setup.h"
#include "tests/session/live_fixture.h"

namespace gaitpad {
namespace {

class LiveKeyboard : public Live {
 protected:
  void SetUp() override {
    Live::SetUp();
    options_.live.keyboard = true;
    options_.pad.wish.pad = "0001:fffe";  // nobody has one
  }
  static double distance_m(LiveSession& session) {
    bool is_new = false;
    const SessionFrame& frame = session.latest(is_new);
    return frame.tick < 0 ? 0.0 : frame.walkers[0].pose.root_m.z;
  }
  // Left stick after each input report of the device in the recording that has this driver.
  std::vector<vec2> recorded_stick(const std::string& driver) {
    const Trace trace = value_of(read_trace(options_.live.record));
    std::vector<vec2> all;
    for (std::size_t d = 0; d < trace.devices.size(); ++d) {
      if (trace.devices[d].info.driver != driver) continue;
      const PadLayout layout = value_of(pad_layout(trace.devices[d].info, {}));
      PadState state;
      for (const TraceEvent& e : trace.events) {
        if (e.device != d || e.kind != ReportKind::input) continue;
        EXPECT_TRUE(decode(layout, report_of(trace, e), state));
        all.emplace_back(state.axis[kLeftX], state.axis[kLeftY]);
      }
    }
    return all;
  }
};

TEST_F(LiveKeyboard, WalksAndItsRecordingReplaysToTheSamePoses) {
  auto session = started();
  EXPECT_TRUE(comes_true([&] { return session->pad_name(0) == "Keyboard"; }));
  session->steer(vec2(0.0, 1.0));
  EXPECT_TRUE(comes_true([&] { return distance_m(*session) > 1.0; }));
  session->steer(vec2(1.0, 1.0));
  sleep_for(400);
  session->steer(vec2(0.0));
  sleep_for(400);
  bool is_new = false;
  EXPECT_EQ(session->latest(is_new).stick.left, vec2(0.0)) << "at rest exactly";
  const auto run = session->stop();
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(*run, replayed());
  EXPECT_EQ(run->bad_reports, 0);
  EXPECT_EQ(session->status().pads.plugged, 0) << "it is no pad that was plugged in";
  const std::vector<vec2> stick = recorded_stick("keyboard");
  ASSERT_GT(stick.size(), 20u);
  EXPECT_EQ(stick.front(), vec2(0.0));
  EXPECT_EQ(stick.back(), vec2(0.0));
  const auto y = [](const vec2& s) { return s.y; };
  EXPECT_EQ(std::ranges::max(stick, {}, y).y, 1.0);
}

TEST_F(LiveKeyboard, TheSmallestDeflectionCountsAndTheLargestIsOne) {
  options_.live.clock = SessionSpec::Live::Clock::by_hand;
  auto session = started();
  bool is_new = false;
  double least = 1.0, most = 0.0;
  EXPECT_TRUE(comes_true([&] {
    session->steer(vec2(0.0, 1.0));
    session->advance(1);
    const double y = session->latest(is_new).stick.left.y;
    if (y > 0.0) least = std::min(least, y);
    most = std::max(most, y);
    return most == 1.0;
  }));
  EXPECT_LT(least, 0.12) << "a first step of 4 to 16 ms of 150";
  session->steer(vec2(0.002, 0.0));
  EXPECT_TRUE(comes_true([&] {
    session->advance(1);
    return session->latest(is_new).stick.left.y == 0.0;
  }));
  EXPECT_NEAR(session->latest(is_new).stick.left.x, 0.002, 1e-4);
}

// A calibration that was made for somebody's pad is none for the keyboard.
TEST_F(LiveKeyboard, TheUsersCalibrationIsNotForIt) {
  options_.pad.calibration = (folder_ / "pad.toml").string();
  std::ofstream(options_.pad.calibration) << "[left]\ninner = 0.5\nouter = 0.9\n";
  auto session = started();
  session->steer(vec2(0.0, 0.3));
  bool is_new = false;
  EXPECT_TRUE(comes_true([&] { return session->latest(is_new).stick.left.y > 0.29; }));
  const auto run = session->stop();
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(*run, replayed());
}

TEST_F(LiveKeyboard, ARecordingAsPadEndsTheSessionAsEver) {
  options_.pad.wish.pad = (folder_ / "pads.hid").string();
  auto session = started();
  session->steer(vec2(1.0, 0.0));
  EXPECT_TRUE(comes_true([&] { return session->has_ended(); }));
  const auto run = session->stop();
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(*run, replayed());
  EXPECT_EQ(session->status().pads.plugged, 4) << "two pads, each twice";
}

// A pad that rests for three seconds and is held to the right from the second one on.
Trace late_pad_trace() {
  Trace trace;
  trace.devices.emplace_back().info = made_pad();
  for (int ms = 0; ms <= 3000; ms += 8) {
    add_event(trace, ms * 1000, made_report(ms < 2000 ? 0x80 : 0xff, 0x80));
  }
  return trace;
}

TEST_F(LiveKeyboard, CountsWhileThePadRests) {
  options_.pad.wish.pad = (folder_ / "late.hid").string();
  ASSERT_TRUE(write_trace(late_pad_trace(), options_.pad.wish.pad));
  auto session = started();
  session->steer(vec2(0.0, 1.0));
  vec2 stick(0.0);
  std::string driving;
  const auto look = [&] {
    bool is_new = false;
    const SessionFrame& frame = session->latest(is_new);
    stick = frame.stick.left;
    driving = session->pad_name(frame.pad.device);
  };
  EXPECT_TRUE(comes_true([&] { return look(), stick == vec2(0.0, 1.0); }));
  EXPECT_TRUE(comes_true([&] { return look(), stick.x > 0.99; }));
  EXPECT_EQ(driving, "Example Walk Pad");
  const auto run = session->stop();
  ASSERT_TRUE(run) << run.error().message;
  EXPECT_EQ(*run, replayed());
}

TEST_F(LiveKeyboard, WithoutOneSteeringDoesNothing) {
  options_.live.keyboard = false;
  options_.live.record.clear();
  options_.live.clock = SessionSpec::Live::Clock::by_hand;
  auto session = started();
  session->steer(vec2(0.0, 1.0));
  sleep_for(50);
  session->advance(10);
  bool is_new = false;
  EXPECT_EQ(session->latest(is_new).stick.left, vec2(0.0));
}

}  // namespace
}  // namespace gaitpad

#include <gtest/gtest.h>

#include "session/live_loop.h"
#include "tests/comes_true.h"
#include "tests/session/fake_drivers.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kNow_ns = std::int64_t{1} << 60;
constexpr std::uint8_t kHatAtRest = 0x08, kFirstButton = 0x10;  // of made_pad()'s fifth byte

// A pad on a real stream, reports gathered or taken as the loop does.
class LiveTickReports : public testing::Test {
 protected:
  void SetUp() override {
    pad_ = bus_.plug(kHidraw, "A", "port1");
    PadStreamOptions options;
    options.drivers = FakeBus::table();
    options.changes_fd = bus_.changes_fd();
    options.ring_reports = 64;
    stream_ = value_of(PadStream::start(std::move(options)));
    SimulationConfig config = made_config(1);
    config.pads = unknown_pads(kMaxPads);
    simulation_.emplace(made_simulation(config));
    reports_.emplace(*stream_, *simulation_);
    gather_until(1);
    step();
  }
  // Until so many have come from the pads, those that were left out too.
  void gather_until(std::int64_t reports) {
    comes_true([&] {
      reports_->gather(kNow_ns);
      return stream_->counts().reports >= reports;
    });
    reports_->gather(kNow_ns);
    EXPECT_EQ(stream_->counts().reports, reports);
  }
  std::vector<int> step() {  // X, or -kind, of each report that the tick uses
    std::vector<int> used;
    const auto reports = reports_->take_reports(kNow_ns);
    for (const Report& r : reports)
      used.push_back(r.kind == ReportKind::input ? r.bytes[0] : -static_cast<int>(r.kind));
    simulation_->step(reports);
    return used;
  }
  void send(int x, bool is_pressed = false) {
    pad_->send({static_cast<std::uint8_t>(x), 0x80, 0x80, 0x80,
                static_cast<std::uint8_t>(kHatAtRest | (is_pressed ? kFirstButton : 0)), 0});
  }
  SessionFrame shown() {
    SessionFrame frame;
    copy_frame(*simulation_, frame);
    reports_->show(frame);
    return frame;
  }
  static std::uint32_t presses(const SessionFrame& frame) {
    std::uint32_t all = 0;
    for (const std::uint32_t n : frame.presses) all += n;
    return all;
  }

  FakeBus bus_;
  FakeBus::Pad pad_;
  std::unique_ptr<PadStream> stream_;
  std::optional<Simulation> simulation_;
  std::optional<TickReports> reports_;
};

constexpr int kAdded = -static_cast<int>(ReportKind::added),
              kRemoved = -static_cast<int>(ReportKind::removed),
              kCommand = -static_cast<int>(ReportKind::command);

TEST_F(LiveTickReports, ATickUsesAllThatHasComeSinceTheLastOne) {
  for (int x = 1; x <= 5; ++x) send(x);
  ASSERT_TRUE(comes_true([&] { return stream_->counts().reports >= 6; }));
  EXPECT_EQ(step(), (std::vector<int>{1, 2, 3, 4, 5}));
  EXPECT_EQ(step(), std::vector<int>());
}

TEST_F(LiveTickReports, OfMovesTheNewestIsKeptAndNothingIsLostInALongStandstill) {
  for (int i = 0; i < 2000; ++i) {
    send(i % 200);
    if (i % 32 == 31) gather_until(i + 2);
  }
  gather_until(2001);
  EXPECT_EQ(shown().pad.state.axis[kLeftX], (2.0f * 199 - 255) / 255);
  EXPECT_EQ(step(), (std::vector<int>{199}));
  EXPECT_EQ(stream_->counts().lost, 0);
  EXPECT_EQ(step(), std::vector<int>());
}

TEST_F(LiveTickReports, NoPressIsLeftOutAndEachShowsAtOnce) {
  for (int i = 0; i < 6; ++i) {
    send(10 * i + 1, i % 2 == 1);
    send(10 * i + 2, i % 2 == 1);
    send(10 * i + 3, i % 2 == 1);
  }
  const std::uint32_t before = presses(shown());
  gather_until(19);
  EXPECT_EQ(presses(shown()), before + 3);
  EXPECT_NE(shown().pad.state.buttons, 0u);
  EXPECT_EQ(step(), (std::vector<int>{3, 13, 23, 33, 43, 53}));
}

// Counted once: as gathered, then as the simulation counts them.
TEST_F(LiveTickReports, PressesNeverCountBackwards) {
  std::uint32_t before = presses(shown());
  std::int64_t sent = 1;
  for (int i = 0; i < 20; ++i) {
    send(0x80, i % 2 == 0);
    gather_until(++sent);
    EXPECT_GE(presses(shown()), before);
    before = presses(shown());
    if (i % 3 == 0) step();
    EXPECT_GE(presses(shown()), before);
    before = presses(shown());
  }
}

TEST_F(LiveTickReports, PluggingAndCommandsKeepTheirPlace) {
  send(1);
  send(2);
  gather_until(3);
  stream_->command("style limp");
  gather_until(4);
  bus_.unplug(pad_);
  gather_until(5);
  EXPECT_EQ(shown().pad.state, PadState());
  pad_ = bus_.plug(kHidraw, "A", "port1");
  gather_until(6);
  send(3);
  send(4);
  gather_until(8);
  EXPECT_EQ(step(), (std::vector<int>{2, kCommand, kRemoved, kAdded, 4}));
}

TEST_F(LiveTickReports, WhatFindsNoRoomWaitsInOrderForTheNextTick) {
  const int kMost = TickReports::kMaxInTick;
  for (int i = 0; i < kMost + 20; ++i) {
    send(i % 200, i % 2 == 0);
    if (i % 16 == 15) gather_until(i + 2);
  }
  gather_until(kMost + 21);
  EXPECT_EQ(static_cast<int>(step().size()), kMost);
  const std::vector<int> rest = step();
  ASSERT_EQ(rest.size(), 20u);
  for (int i = 0; i < 20; ++i) EXPECT_EQ(rest[i], (kMost + i) % 200);
}

TEST_F(LiveTickReports, ADeviceIsKnownOnceItWasAdded) {
  EXPECT_TRUE(reports_->is_known(0));
  EXPECT_FALSE(reports_->is_known(1));
  EXPECT_FALSE(reports_->is_known(kNoDevice));
}

}  // namespace
}  // namespace gaitpad

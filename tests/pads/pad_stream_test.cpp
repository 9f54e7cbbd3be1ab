// A stream with plugged pads: order, losses, time stamps, motors, commands, its end.
#include "gaitpad/pad_stream.h"

#include <gtest/gtest.h>

#include <thread>

#include "tests/pads/pad_stream_fixture.h"

namespace gaitpad {
namespace {

using namespace std::chrono_literals;

TEST_F(PadStreamTest, PadsFromTheStartAndLaterOnesAreAnnouncedBeforeTheyReport) {
  auto first = bus_.plug(kHidraw, "A", "port1");
  first->send_axes(1, 0);
  start();
  expect(ReportKind::added, 0);
  EXPECT_EQ(stream_->device(0).info.unique_id, "A");
  const PadConfig config = stream_->take_config(0);
  EXPECT_TRUE(config.is_usable);
  EXPECT_FALSE(config.is_present);
  expect_x(0, 1);
  auto second = bus_.plug(kHidraw, "B", "port2");
  second->send_axes(2, 0);
  expect(ReportKind::added, 1);
  EXPECT_EQ(stream_->device(1).info.unique_id, "B");
  EXPECT_EQ(stream_->device(1).index, 1);
  expect_x(1, 2);
  EXPECT_EQ(stream_->counts().plugged, 2);
  EXPECT_FALSE(stream_->has_ended());
}

TEST_F(PadStreamTest, UnpluggingComesBehindWhatWasSentBeforeAndIsToldOnce) {
  auto pad = bus_.plug(kHidraw, "A", "port1");
  start();
  expect(ReportKind::added, 0);
  pad->send_axes(1, 0);
  pad->send_axes(2, 0);
  bus_.unplug(pad);
  expect_x(0, 1);
  expect_x(0, 2);
  expect(ReportKind::removed, 0);
  EXPECT_TRUE(is_told("\"Example Walk Pad\" (hidraw, /dev/hidraw-port1): unplugged"));
  stream_->wait(20ms);
  EXPECT_EQ(stream_->front(), nullptr);
  EXPECT_EQ(stream_->counts().unplugged, 1);
  EXPECT_TRUE(comes_true([&] { return pad->closings == 1; }));
}

TEST_F(PadStreamTest, APadThatTakesItsTimeToCloseDoesNotKeepTheOthersFromBeingRead) {
  auto slow = bus_.plug(kHidraw, "A", "port1");
  start();
  expect(ReportKind::added, 0);
  auto other = plugged("B", "port2", 1);
  slow->keeps_closing = true;
  take_away(slow, 0);
  for (int i = 0; i < 100; ++i) {
    other->send_axes(i, 0);
    expect_x(1, i);
  }
  EXPECT_EQ(slow->closings, 0);
  slow->keeps_closing = false;
  EXPECT_TRUE(comes_true([&] { return slow->closings == 1; }));
}

TEST_F(PadStreamTest, WhatIsOnItsWayToBeClosedIsClosedAtTheEnd) {
  auto first = bus_.plug(kHidraw, "A", "port1"), second = bus_.plug(kHidraw, "B", "port2");
  start();
  expect(ReportKind::added, 0);
  expect(ReportKind::added, 1);
  first->keeps_closing = true;
  take_away(first, 0);
  take_away(second, 1);
  std::thread later([&first] {
    std::this_thread::sleep_for(20ms);
    first->keeps_closing = false;
  });
  stream_.reset();
  EXPECT_EQ(first->closings + second->closings, 2);
  later.join();
}

TEST_F(PadStreamTest, AFullRingKeepsTheLastStateAndCountsTheRestExactly) {
  auto pad = bus_.plug(kHidraw, "A", "port1");
  start_with_ring(4);
  constexpr int kSent = 1000;
  for (int i = 1; i <= kSent; ++i) ASSERT_TRUE(pad->send_axes(i % 251, i / 251));
  // `added` and three reports fill the ring; the newest report waits, and the others are lost.
  EXPECT_TRUE(comes_true([&] { return stream_->counts().lost == kSent - 4; }));
  expect(ReportKind::added, 0);
  for (int i = 1; i <= 3; ++i) expect_x(0, i);
  const Report newest = next();
  EXPECT_EQ(newest.bytes[0], kSent % 251);
  EXPECT_EQ(newest.bytes[1], kSent / 251);
  EXPECT_EQ(stream_->counts().lost, kSent - 4);
  EXPECT_EQ(stream_->counts().reports, 5);
}

TEST_F(PadStreamTest, AFullRingLosesNoPluggingAndNoCommandAndKeepsTheirOrder) {
  auto pad = bus_.plug(kHidraw, "A", "port1");
  start_with_ring(1);
  pad->send_axes(1, 0);
  pad->send_axes(2, 0);
  EXPECT_TRUE(comes_true([&] { return stream_->counts().lost == 1; }));
  bus_.unplug(pad);
  EXPECT_TRUE(comes_true([&] { return pad->closings == 1; }));
  stream_->command("style even");
  pad = bus_.plug(kHidraw, "A", "port1");
  pad->send_axes(3, 0);
  pad->send_axes(4, 0);
  EXPECT_TRUE(comes_true([&] { return stream_->counts().lost == 2; }));
  expect(ReportKind::added, 0);
  expect_x(0, 2);
  expect(ReportKind::removed, 0);
  EXPECT_EQ(text_of(next()), "style even");
  expect(ReportKind::added, 0);
  expect_x(0, 4);
}

TEST_F(PadStreamTest, TheSourcesOwnLossesAreCountedWithTheRings) {
  auto pad = bus_.plug(kHidraw, "A", "port1");
  start();
  expect(ReportKind::added, 0);
  pad->lost = 7;
  pad->send_axes(1, 0);
  EXPECT_TRUE(comes_true([&] { return stream_->counts().lost == 7; }));
  pad->lost = 9;
  bus_.unplug(pad);
  EXPECT_TRUE(comes_true([&] { return stream_->counts().lost == 9; }));
}

TEST_F(PadStreamTest, ADriverThatIsReadyForEverButHasNothingIsClosed) {
  for (const FakeKind kind : {FakeKind::always_ready, FakeKind::closed_descriptor}) {
    auto pad = bus_.make(kHidraw, "A", "port1");
    pad->kind = kind;
    bus_.show(kHidraw, pad);
    start();
    expect(ReportKind::added, 0);
    expect(ReportKind::removed, 0);
    EXPECT_TRUE(is_told("closed, it only reports errors"));
    stream_.reset();
    bus_.unplug(pad);
    told_.clear();
  }
}

TEST_F(PadStreamTest, AFloodingPadDoesNotStarveTheOthers) {
  auto flood = bus_.plug(kHidraw, "A", "port1");
  auto calm = bus_.plug(kHidraw, "B", "port2");
  start();
  std::atomic<bool> is_over{false};
  std::thread source([&] {
    while (!is_over) flood->send_axes(1, 0);
  });
  calm->send_axes(2, 0);
  Report report = next();
  while (report.kind != ReportKind::input || report.bytes[0] != 2) report = next();
  is_over = true;
  source.join();
}

TEST_F(PadStreamTest, EndsWhileAPadFloods) {
  for (int i = 0; i < 10; ++i) {
    auto pad = bus_.plug(kHidraw, "A", "port1");
    start_with_ring(16);
    std::thread source([&] {
      while (pad->send_axes(1, 0)) {
      }
    });
    for (int k = 0; k < 100; ++k) next();
    stream_.reset();
    EXPECT_EQ(pad->openings, pad->closings);
    bus_.unplug(pad);
    ::shutdown(pad->sockets[1], SHUT_RDWR);
    source.join();
  }
}

TEST_F(PadStreamTest, StampsOfADeviceNeverGoBackAndAreOfTheMonotonicClock) {
  auto pad = bus_.make(kHidraw, "A", "port1");
  start();
  for (const std::int64_t stamp_ns : {std::int64_t{0}, std::int64_t{1} << 60}) {
    pad = bus_.make(kHidraw, "A", "port1");
    pad->stamp_ns = stamp_ns;
    bus_.show(kHidraw, pad);
    const Report added = next();
    pad->send_axes(1, 0);
    const Report report = next();
    EXPECT_GE(report.time_ns, added.time_ns);
    EXPECT_LE(
        report.time_ns,
        std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count());
    bus_.unplug(pad);
    EXPECT_GE(next().time_ns, report.time_ns);
  }
}

TEST_F(PadStreamTest, MotorsStopWhenTheirTimeIsOverAndAtTheEnd) {
  auto pad = bus_.plug(kHidraw, "A", "port1");
  start();
  expect(ReportKind::added, 0);
  stream_->rumble(0, {30000, 10000}, 30ms);
  stream_->rumble(9, {30000, 10000}, 30ms);  // device 9 does not exist
  EXPECT_TRUE(comes_true([&] { return pad->all_rumbles().size() == 2; }));
  EXPECT_EQ(pad->all_rumbles()[0].strong, 30000);
  EXPECT_EQ(pad->all_rumbles()[0].weak, 10000);
  EXPECT_EQ(pad->all_rumbles()[1].strong, 0);
  stream_->rumble(0, {1, 2}, 10s);
  EXPECT_TRUE(comes_true([&] { return pad->all_rumbles().size() == 3; }));
  stream_.reset();
  ASSERT_EQ(pad->all_rumbles().size(), 4u);
  EXPECT_EQ(pad->all_rumbles()[3].weak, 0);
}

TEST_F(PadStreamTest, CommandsComeFromAnyThreadAsARecordingCanHoldThem) {
  start();
  std::vector<std::thread> threads;
  for (int i = 0; i < 4; ++i) {
    threads.emplace_back([this] {
      for (int k = 0; k < 50; ++k) stream_->command("style\neven");
      stream_->command(" \n");
      stream_->command(std::string(kMaxReportBytes + 1, 'x'));
    });
  }
  for (int i = 0; i < 200; ++i) {
    const Report report = next();
    EXPECT_EQ(report.kind, ReportKind::command);
    EXPECT_EQ(report.device, kNoDevice);
    EXPECT_EQ(text_of(report), "style even");
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_TRUE(is_told("a command of 1025 bytes was left out, 1024 can be taken"));
  stream_->wait(20ms);
  EXPECT_EQ(stream_->front(), nullptr);
}

TEST_F(PadStreamTest, ASleepingReaderIsWokenByAReport) {
  auto pad = bus_.plug(kHidraw, "A", "port1");
  start();
  expect(ReportKind::added, 0);
  std::thread source([&] {
    std::this_thread::sleep_for(20ms);
    pad->send_axes(5, 0);
  });
  const auto begin = std::chrono::steady_clock::now();
  while (stream_->front() == nullptr)
    stream_->wait(std::chrono::duration_cast<std::chrono::milliseconds>(kPatience));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, kPatience);
  expect_x(0, 5);
  source.join();
}

TEST_F(PadStreamTest, PluggingInAndOutAtRandomEndsInTheRightState) {
  start();
  std::vector<FakeBus::Pad> pads(4);
  std::uint32_t random = 1;
  for (int i = 0; i < 400; ++i) {
    random = random * 1664525u + 1013904223u;
    FakeBus::Pad& pad = pads[random >> 30];
    const std::string name = std::to_string(random >> 30);
    if (pad)
      bus_.unplug(std::exchange(pad, nullptr));
    else
      (pad = bus_.plug(kHidraw, name, "port" + name))->send_axes(i % 256, 0);
    if ((random >> 16) % 8 == 0) std::this_thread::sleep_for(10ms);
    while (stream_->front() != nullptr) stream_->pop();
  }
  int present = 0;
  for (const FakeBus::Pad& pad : pads) present += pad != nullptr;
  EXPECT_TRUE(comes_true([&] {
    while (stream_->front() != nullptr) stream_->pop();
    const PadStreamCounts counts = stream_->counts();
    bool are_open = counts.plugged - counts.unplugged == present;
    for (const FakeBus::Pad& pad : pads)
      are_open = are_open && (!pad || pad->openings > pad->closings);
    return are_open;
  }));
  EXPECT_EQ(stream_->counts().lost, 0);
}

}  // namespace
}  // namespace gaitpad

#include "session/pad_stream.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <thread>

#include "tests/session/fake_drivers.h"

namespace gaitpad {
namespace {

using namespace std::chrono_literals;

enum : int { kHidraw, kEvdev, kUsb };
constexpr auto kPatience = 60s;  // never reached on a machine that works, however busy it is

class PadStreamTest : public testing::Test {
 protected:
  void start(PadStreamOptions options = {}) {
    options.drivers = FakeBus::table();
    options.changes_fd = bus_.changes_fd();
    auto started = PadStream::start(std::move(options));
    ASSERT_TRUE(started) << started.error().message;
    stream_ = std::move(*started);
  }
  static bool comes_true(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (!condition()) {
      if (std::chrono::steady_clock::now() > end) return false;
      std::this_thread::sleep_for(1ms);
    }
    return true;
  }
  // The next report; one of kind command and without text where none came in time.
  Report next() {
    const auto end = std::chrono::steady_clock::now() + kPatience;
    while (stream_->front() == nullptr) {
      if (std::chrono::steady_clock::now() > end) {
        ADD_FAILURE() << "no report came";
        return made_command("");
      }
      stream_->wait(1000ms);
    }
    const Report report = *stream_->front();
    stream_->pop();
    return report;
  }
  void expect(ReportKind kind, int device) {
    const Report report = next();
    EXPECT_EQ(report.kind, kind);
    EXPECT_EQ(report.device, device);
  }
  void expect_x(int device, int x) {
    const Report report = next();
    EXPECT_EQ(report.kind, ReportKind::input);
    EXPECT_EQ(report.device, device);
    EXPECT_EQ(report.bytes[0], x);
  }
  bool is_told(const std::string& part) {
    return comes_true([&] {
      for (std::string& remark : stream_->take_remarks()) told_ += remark + "\n";
      return told_.find(part) != std::string::npos;
    });
  }

  FakeBus bus_;
  std::unique_ptr<PadStream> stream_;
  std::string told_;
};

TEST_F(PadStreamTest, PadsFromTheStartAndLaterOnesAreAnnouncedBeforeTheyReport) {
  auto first = bus_.plug(kHidraw, "A", "port1");
  first->send_axes(1, 0);
  start();
  expect(ReportKind::added, 0);
  EXPECT_EQ(stream_->device(0).info.unique_id, "A");
  EXPECT_TRUE(stream_->config(0).is_usable);
  EXPECT_FALSE(stream_->config(0).is_present);
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
  auto other = bus_.plug(kHidraw, "B", "port2");
  expect(ReportKind::added, 1);
  slow->keeps_closing = true;
  bus_.unplug(slow);
  expect(ReportKind::removed, 0);
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
  bus_.unplug(first);
  expect(ReportKind::removed, 0);
  bus_.unplug(second);
  expect(ReportKind::removed, 1);
  std::thread later([&first] {
    std::this_thread::sleep_for(20ms);
    first->keeps_closing = false;
  });
  stream_.reset();
  EXPECT_EQ(first->closings + second->closings, 2);
  later.join();
}

TEST_F(PadStreamTest, APadThatComesBackHasItsOldIndexOnAnyPort) {
  auto pad = bus_.plug(kHidraw, "A", "port1");
  start();
  expect(ReportKind::added, 0);
  for (int i = 0; i < 5; ++i) {
    bus_.unplug(pad);
    expect(ReportKind::removed, 0);
    pad = bus_.plug(kHidraw, "A", i % 2 == 0 ? "port2" : "port1");
    expect(ReportKind::added, 0);
    pad->send_axes(i, 0);
    expect_x(0, i);
  }
}

TEST_F(PadStreamTest, AnUnplugThatNobodyHadTimeToNoticeKeepsTheIndexToo) {
  auto pad = bus_.plug(kHidraw, "A", "port1");
  start();
  expect(ReportKind::added, 0);
  for (int i = 0; i < 5; ++i) {
    bus_.unplug(pad);
    pad = bus_.plug(kHidraw, "A", i % 2 == 0 ? "port2" : "port1");
  }
  // However many of them were noticed: the last one is open in the end, as device 0.
  EXPECT_TRUE(comes_true([&] { return pad->openings > 0; }));
  pad->send_axes(77, 0);
  Report report = next();
  while (report.kind != ReportKind::input) {
    EXPECT_EQ(report.device, 0);
    report = next();
  }
  EXPECT_EQ(report.device, 0);
  EXPECT_EQ(report.bytes[0], 77);
}

TEST_F(PadStreamTest, APadWhoseUniqueIdComesLateIsOpenedOnceAndWithIt) {
  start();
  auto pad = bus_.make(kHidraw, "", "port1");
  pad->listing.kernel_driver = "playstation";
  const auto shown = std::chrono::steady_clock::now();
  bus_.show(kHidraw, pad);
  bus_.plug(kHidraw, "B", "port2");
  expect(ReportKind::added, 0);  // the other one: both have been seen
  EXPECT_EQ(stream_->device(0).info.unique_id, "B");
  bus_.name_id(pad, "A");
  const bool is_in_time = std::chrono::steady_clock::now() - shown < 900ms;
  expect(ReportKind::added, 1);
  if (is_in_time) {
    EXPECT_EQ(stream_->device(1).info.unique_id, "A");
  }
  bus_.plug(kHidraw, "C", "port3");
  expect(ReportKind::added, 2);
  EXPECT_EQ(pad->openings, 1);
  EXPECT_EQ(stream_->counts().plugged, 3);
}

TEST_F(PadStreamTest, APadThatNeverTellsItsUniqueIdIsOpenedAllTheSame) {
  auto pad = bus_.make(kHidraw, "", "port1");
  pad->listing.kernel_driver = "sony";
  bus_.show(kHidraw, pad);
  const auto before = std::chrono::steady_clock::now();
  start();
  expect(ReportKind::added, 0);
  EXPECT_GE(std::chrono::steady_clock::now() - before, 900ms);
  EXPECT_EQ(pad->openings, 1);
}

TEST_F(PadStreamTest, ANodeWhoseUniqueIdChangesWhileItIsOpenIsNotOpenedAgain) {
  auto pad = bus_.plug(kHidraw, "", "port1");
  start();
  expect(ReportKind::added, 0);
  bus_.name_id(pad, "A");
  auto other = bus_.plug(kHidraw, "B", "port2");
  expect(ReportKind::added, 1);
  EXPECT_EQ(pad->openings, 1);
  pad->send_axes(7, 0);
  expect_x(0, 7);
  bus_.unplug(pad);
  expect(ReportKind::removed, 0);
  EXPECT_EQ(stream_->counts().plugged, 2);
}

TEST_F(PadStreamTest, TwoEqualPadsAreKeptApartByTheirUniqueIds) {
  auto a = bus_.plug(kHidraw, "A", "port1");
  auto b = bus_.plug(kHidraw, "B", "port2");
  start();
  expect(ReportKind::added, 0);
  expect(ReportKind::added, 1);
  const bool a_is_first = stream_->device(0).info.unique_id == "A";
  const int index_a = a_is_first ? 0 : 1, index_b = 1 - index_a;
  bus_.unplug(a);
  expect(ReportKind::removed, index_a);
  bus_.unplug(b);
  expect(ReportKind::removed, index_b);
  b = bus_.plug(kHidraw, "B", "port1");  // each where the other one was
  expect(ReportKind::added, index_b);
  a = bus_.plug(kHidraw, "A", "port2");
  expect(ReportKind::added, index_a);
}

TEST_F(PadStreamTest, WithoutUniqueIdsTwoEqualPadsAreKeptApartByTheirPorts) {
  auto a = bus_.plug(kHidraw, "", "port1");
  start();
  expect(ReportKind::added, 0);
  auto b = bus_.plug(kHidraw, "", "port2");
  expect(ReportKind::added, 1);
  bus_.unplug(a);
  expect(ReportKind::removed, 0);
  bus_.unplug(b);
  expect(ReportKind::removed, 1);
  b = bus_.plug(kHidraw, "", "port2");
  expect(ReportKind::added, 1);
  a = bus_.plug(kHidraw, "", "port1");
  expect(ReportKind::added, 0);
}

TEST_F(PadStreamTest, ClonesThatShareTheirUniqueIdAreStillTwo) {
  auto a = bus_.plug(kHidraw, "123456", "port1");
  start();
  expect(ReportKind::added, 0);
  auto b = bus_.plug(kHidraw, "123456", "port2");
  expect(ReportKind::added, 1);
  bus_.unplug(a);
  expect(ReportKind::removed, 0);
  bus_.unplug(b);
  expect(ReportKind::removed, 1);
  b = bus_.plug(kHidraw, "123456", "port2");
  expect(ReportKind::added, 1);
}

TEST_F(PadStreamTest, AFullRingKeepsTheLastStateAndCountsTheRestExactly) {
  auto pad = bus_.plug(kHidraw, "A", "port1");
  PadStreamOptions options;
  options.ring_reports = 4;
  start(std::move(options));
  constexpr int kSent = 1000;
  for (int i = 1; i <= kSent; ++i) ASSERT_TRUE(pad->send_axes(i % 251, i / 251));
  // `added` and three reports fill the ring, the newest is kept, the others are lost.
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
  PadStreamOptions options;
  options.ring_reports = 1;
  start(std::move(options));
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

TEST_F(PadStreamTest, AnOpeningThatFailsIsTriedAgainWithoutAnyEvent) {
  auto pad = bus_.make(kHidraw, "A", "port1");
  pad->failing_openings = 3;
  start();
  bus_.show(kHidraw, pad);
  expect(ReportKind::added, 0);
  EXPECT_EQ(pad->openings, 4);
  EXPECT_TRUE(stream_->take_remarks().empty());
}

TEST_F(PadStreamTest, APadThatTheFirstDriverCannotOpenIsServedByTheNext) {
  auto raw = bus_.make(kHidraw, "A", "port1");
  raw->failing_openings = 1 << 20;
  auto cooked = bus_.make(kEvdev, "A", "port1");
  bus_.show(kHidraw, raw);
  bus_.show(kEvdev, cooked);
  start();
  expect(ReportKind::added, 0);
  EXPECT_EQ(stream_->device(0).info.driver, "evdev");
  EXPECT_EQ(raw->openings, 4);
}

TEST_F(PadStreamTest, WhatNoDriverCanOpenIsToldWithItsCause) {
  auto pad = bus_.make(kHidraw, "A", "port1");
  pad->listing.problem = "/dev/hidraw-port1: permission denied";
  bus_.show(kHidraw, pad);
  start();
  EXPECT_TRUE(is_told("/dev/hidraw-port1: permission denied\n"));
  EXPECT_EQ(pad->openings, 0);
  bus_.unplug(pad);
  pad->listing.problem.clear();
  bus_.show(kHidraw, pad = bus_.make(kHidraw, "A", "port1"));
  expect(ReportKind::added, 0);
}

TEST_F(PadStreamTest, APadIsOpenedThroughOneDriverAlone) {
  auto raw = bus_.make(kHidraw, "A", "port1");
  auto cooked = bus_.make(kEvdev, "A", "port1");
  start();
  bus_.show(kEvdev, cooked);  // as on a real kernel: the preferred node comes a moment later
  bus_.show(kHidraw, raw);
  expect(ReportKind::added, 0);
  for (int i = 0; i < 3; ++i) bus_.tell();
  auto other = bus_.plug(kHidraw, "B", "port2");
  expect(ReportKind::added, 1);
  EXPECT_EQ(raw->openings + cooked->openings, 1);
}

// An adapter for two pads: one USB interface with an input node for each of its plugs.
TEST_F(PadStreamTest, TwoNodesOfOneAdapterAreTwoPadsAndKeepTheirIndexes) {
  const auto plug = [this](const char* node) {
    auto pad = bus_.make(kEvdev, "", "port1");
    pad->listing.node = node;
    bus_.show(kEvdev, pad);
    return pad;
  };
  auto first = plug("/dev/input/event5"), second = plug("/dev/input/event6");
  start();
  for (int i = 0; i < 3; ++i) {
    expect(ReportKind::added, 0);
    expect(ReportKind::added, 1);
    first->send_axes(1, 0);
    expect_x(0, 1);
    second->send_axes(2, 0);
    expect_x(1, 2);
    bus_.unplug(first);
    expect(ReportKind::removed, 0);
    bus_.unplug(second);
    expect(ReportKind::removed, 1);
    first = plug("/dev/input/event5");
    second = plug("/dev/input/event6");
  }
}

TEST_F(PadStreamTest, WhatHasNoStickIsNotAnnounced) {
  auto keyboard = bus_.make(kHidraw, "K", "port1");
  keyboard->listing.info.descriptor = {0x05, 0x01, 0x09, 0x06, 0xa1, 0x01, 0xc0};
  bus_.show(kHidraw, keyboard);
  start();
  auto pad = bus_.plug(kHidraw, "A", "port2");
  expect(ReportKind::added, 0);
  EXPECT_EQ(stream_->device(0).info.unique_id, "A");
  EXPECT_EQ(keyboard->openings, 0);
}

std::string user_folder(const std::string& text) {
  const auto folder = std::filesystem::path(testing::TempDir()) /
                      ("gaitpad_user_calibrations." + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "a.toml") << text;
  return folder.string();
}

TEST_F(PadStreamTest, APadHasItsUsersCalibrationAndSaysWhetherItBringsItsOwn) {
  PadStreamOptions options;
  options.files.user_calibrations = user_folder("unique_id = 'A'\n[left]\ninner = 0.31\n");
  auto own = bus_.make(kHidraw, "A", "port1");
  own->factory_sticks = FactorySticks();
  bus_.show(kHidraw, own);
  start(options);
  expect(ReportKind::added, 0);
  EXPECT_EQ(stream_->config(0).calibration.left.inner, 0.31);
  EXPECT_TRUE(stream_->config(0).has_factory_sticks);
  auto other = bus_.plug(kHidraw, "B", "port2");
  expect(ReportKind::added, 1);
  EXPECT_EQ(stream_->config(1).calibration.left.inner, kInnerZoneUnknown);
  EXPECT_FALSE(stream_->config(1).has_factory_sticks);
  std::filesystem::remove_all(options.files.user_calibrations);
}

TEST_F(PadStreamTest, ADamagedCalibrationIsToldAndThePadPlays) {
  PadStreamOptions options;
  options.files.user_calibrations = user_folder("[left]\ninner = 7\n");
  bus_.plug(kHidraw, "A", "port1");
  start(options);
  expect(ReportKind::added, 0);
  EXPECT_TRUE(is_told("a.toml:2: \"inner\" is 7, outside [0, 0.9]; pads go on without"));
  std::filesystem::remove_all(options.files.user_calibrations);
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
    PadStreamOptions options;
    options.ring_reports = 16;
    start(std::move(options));
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
  stream_->rumble(9, {30000, 10000}, 30ms);  // no such device
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

TEST_F(PadStreamTest, AWishThatMakesNoSenseIsAnErrorAtOnceAndOneThatNothingFitsWaits) {
  bus_.plug(kHidraw, "A", "port1");
  bus_.plug(kHidraw, "B", "port2");
  const auto error_of = [this](PadWish wish) -> std::string {
    PadStreamOptions options;
    options.wish = std::move(wish);
    options.drivers = FakeBus::table();
    options.changes_fd = bus_.changes_fd();
    auto stream = PadStream::start(std::move(options));
    return stream ? "" : stream.error().message;
  };
  EXPECT_EQ(error_of({"", "sdl"}), "there is no driver \"sdl\" (known: hidraw, evdev, usb)");
  EXPECT_NE(error_of({"walk", ""}).find("\"walk\" fits 2 pads"), std::string::npos);
  EXPECT_EQ(error_of({"/nonexistent.hid", ""}),
            "there is no driver \"trace\" (known: hidraw, evdev, usb)");
  EXPECT_EQ(error_of({"A", ""}), "");
  EXPECT_EQ(error_of({"ffff:ffff", ""}), "");
}

// A recording through the real driver.
class RecordingAsPad : public PadStreamTest {
 protected:
  void SetUp() override {
    path_ = (std::filesystem::temp_directory_path() /
             ("gaitpad_pad_stream_" + std::to_string(::getpid()) + ".hid"))
                .string();
  }
  void TearDown() override {
    stream_.reset();
    std::filesystem::remove(path_);
  }
  void write(const Trace& trace) { ASSERT_TRUE(write_trace(trace, path_)); }
  static Trace made_trace() {
    Trace trace;
    trace.devices.resize(1);
    trace.devices[0].info = made_pad();
    for (int i = 0; i < 3; ++i) {
      const Report report = made_report(10 + i, 0);
      TraceEvent event;
      event.device = 0;
      event.time_us = 5'000'000 + i * 10'000;
      event.first_byte = static_cast<std::uint32_t>(trace.bytes.size());
      event.size = report.size;
      trace.bytes.insert(trace.bytes.end(), report.bytes.begin(),
                         report.bytes.begin() + report.size);
      trace.events.push_back(event);
    }
    trace.end_time_us = 5'030'000;
    trace.end_ticks = 8;
    return trace;
  }
  Result<std::unique_ptr<PadStream>> started() {
    PadStreamOptions options;
    options.wish.pad = path_;
    return PadStream::start(std::move(options));
  }
  std::string path_;
};

TEST_F(RecordingAsPad, IsAddedReportsEndsAndIsNotOpenedAgain) {
  write(made_trace());
  auto started_stream = started();
  ASSERT_TRUE(started_stream) << started_stream.error().message;
  stream_ = std::move(*started_stream);
  EXPECT_FALSE(stream_->has_ended());
  expect(ReportKind::added, 0);
  EXPECT_EQ(stream_->device(0).info, made_pad());
  for (int i = 0; i < 3; ++i) expect_x(0, 10 + i);
  expect(ReportKind::removed, 0);
  EXPECT_TRUE(comes_true([&] { return stream_->has_ended(); }));
  EXPECT_TRUE(stream_->take_remarks().empty());
  EXPECT_EQ(stream_->counts().plugged, 1);
}

TEST_F(RecordingAsPad, KeepsItsOwnCalibration) {
  Trace trace = made_trace();
  trace.devices[0].calibration = "[left]\ninner = 0.31\n";
  write(trace);
  auto started_stream = started();
  ASSERT_TRUE(started_stream) << started_stream.error().message;
  stream_ = std::move(*started_stream);
  expect(ReportKind::added, 0);
  EXPECT_EQ(stream_->config(0).calibration.left.inner, 0.31);
  EXPECT_EQ(stream_->device(0).calibration, trace.devices[0].calibration);
}

// It plays as it replays, on every machine.
TEST_F(RecordingAsPad, IsCalibratedByTheUsersFileAsAnyPad) {
  write(made_trace());
  PadStreamOptions options;
  options.files.user_calibrations = user_folder("devices = ['*:*']\n[left]\ninner = 0.31\n");
  options.wish.pad = path_;
  auto started_stream = PadStream::start(options);
  ASSERT_TRUE(started_stream) << started_stream.error().message;
  stream_ = std::move(*started_stream);
  expect(ReportKind::added, 0);
  EXPECT_EQ(stream_->config(0).calibration.left.inner, 0.31);
  std::filesystem::remove_all(options.files.user_calibrations);
}

TEST_F(RecordingAsPad, WithoutAnyStickIsAnError) {
  Trace trace = made_trace();
  trace.devices[0].info.descriptor = {0x05, 0x01, 0x09, 0x06, 0xa1, 0x01, 0xc0};
  write(trace);
  auto started_stream = started();
  ASSERT_FALSE(started_stream);
  EXPECT_EQ(started_stream.error().message, path_ + ": none of its devices is a pad with a stick");
}

}  // namespace
}  // namespace gaitpad

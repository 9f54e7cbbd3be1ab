// Live sessions in real time; a trace is the pad.
#include "session/live.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <spawn.h>
#include <sys/eventfd.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>

#include "drivers/posix.h"
#include "session/live_loop.h"
#include "session/realtime.h"
#include "session/replay.h"
#include "tests/session/heap_use.h"
#include "tests/session/made_session.h"

namespace gaitpad {
namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

void sleep_for(int ms) { std::this_thread::sleep_for(milliseconds(ms)); }

// Until it is so; false after half a minute.
bool comes_true(const std::function<bool()>& condition) {
  for (int i = 0; i < 6000 && !condition(); ++i) sleep_for(5);
  return condition();
}

// Two equal pads, 125 reports a second each, for 2.4 s. The first walks ahead and in a curve, is
// lost while it is held and comes back; the second rests, takes over, is lost, comes back held.
Trace two_pads_trace() {
  Trace trace;
  for (int i : {0, 1}) {
    TraceDevice& device = trace.devices.emplace_back();
    device.index = i;
    device.info = made_pad();
    device.info.unique_id = i == 0 ? "one" : "two";
  }
  const auto add = [&trace](int ms, std::uint16_t device, ReportKind kind, int x, int y) {
    TraceEvent event;
    event.time_us = ms * 1000;
    event.device = device;
    event.kind = kind;
    event.first_byte = static_cast<std::uint32_t>(trace.bytes.size());
    if (kind == ReportKind::input) {
      const Report report = made_report(x, y);
      trace.bytes.insert(trace.bytes.end(), report.bytes.begin(), report.bytes.begin() + 6);
      event.size = 6;
    }
    trace.events.push_back(event);
  };
  for (int ms = 0; ms <= 2400; ms += 8) {
    const bool first_is_there = ms < 900 || ms >= 1400, second_is_there = ms < 1700 || ms >= 1900;
    if (ms == 904) add(ms, 0, ReportKind::removed, 0, 0);
    if (ms == 1400) add(ms, 0, ReportKind::added, 0, 0);
    if (ms == 1704) add(ms, 1, ReportKind::removed, 0, 0);
    if (ms == 1904) add(ms, 1, ReportKind::added, 0, 0);
    const int y = ms < 80 ? 0x80 : 0x10 + ms % 23;
    if (first_is_there) add(ms, 0, ReportKind::input, ms < 500 ? 0x80 : 0xb0, y);
    if (second_is_there) add(ms, 1, ReportKind::input, 0x80, ms < 1000 || ms >= 1700 ? 0x80 : 0x20);
    if (ms >= 1600 && ms < 1700) add(ms, 0, ReportKind::input, 0x80, 0x80);
  }
  trace.end_time_us = 2'400'000;
  trace.end_ticks = 576;
  return trace;
}

class Live : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(folder_);
    fs::create_directories(folder_);
    options_.session.config_folders = {GAITPAD_SOURCE_DIR "/config"};
    options_.session.styles = {"even", "limp_left"};
    options_.wish.pad = (folder_ / "pads.hid").string();
    options_.record = (folder_ / "session.hid").string();
    ASSERT_TRUE(write_trace(two_pads_trace(), options_.wish.pad));
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::unique_ptr<LiveSession> started() {
    auto session = LiveSession::start(options_);
    EXPECT_TRUE(session) << session.error().message;
    return session ? std::move(*session) : nullptr;
  }
  // What a replay of the recording comes to.
  std::vector<nlohmann::ordered_json> replayed() const {
    ReplayOptions options;
    options.session = options_.session;
    options.trace = options_.record;
    auto result = replay(options);
    EXPECT_TRUE(result) << result.error().message;
    return result ? result->summaries : std::vector<nlohmann::ordered_json>();
  }

  fs::path folder_ =
      fs::path(testing::TempDir()) / ("gaitpad_live_test." + std::to_string(::getpid()));
  LiveOptions options_;
};

TEST_F(Live, ReplaysToTheSamePoses) {
  auto session = started();
  sleep_for(700);
  session->command("style tired");
  sleep_for(500);
  session->command("style 2 stiff_hip\n");
  session->command("   ");
  session->command("no such command");
  EXPECT_TRUE(comes_true([&] { return session->has_ended(); }));
  const auto summaries = session->stop();
  ASSERT_TRUE(summaries) << summaries.error().message;
  ASSERT_EQ(summaries->size(), 2u);
  const nlohmann::ordered_json& first = summaries->front();
  EXPECT_EQ(*summaries, replayed());
  EXPECT_EQ(first["style"], "tired");
  EXPECT_GT(first["ticks"], 3 * 240) << "2.4 s and a second more";
  EXPECT_GT(first["reports"], 400);
  EXPECT_EQ(first["bad_reports"], 0);
  EXPECT_GT(first["steps_left"].get<int>() + first["steps_right"].get<int>(), 1);
  EXPECT_EQ(session->status().recording_lost, 0);
  EXPECT_EQ(session->status().pads.lost, 0);
}

TEST_F(Live, TellsTheNewestTickAndHowItGoes) {
  options_.record.clear();
  auto session = started();
  std::int64_t tick = -1;
  std::uint16_t driving = kNoDevice;
  float forward = 0.0f;
  ASSERT_TRUE(comes_true([&] {
    bool is_new = false;
    const SessionFrame& frame = session->latest(is_new);
    EXPECT_GE(frame.tick, tick);
    tick = frame.tick;
    driving = frame.pad.device;
    forward = std::max(forward, frame.pad.state.axis[kLeftY]);
    return tick >= 150;
  }));
  EXPECT_EQ(driving, 0);
  EXPECT_GT(forward, 0.5f);
  const LiveStatus status = session->status();
  EXPECT_GE(status.ticks, 150);
  EXPECT_GT(status.tick_us_median, 0.0);
  EXPECT_GE(status.tick_us_max, 0.99 * status.tick_us_median);
  EXPECT_GT(status.wait_us_median, 0.0);
  EXPECT_EQ(status.pads.plugged, 2);
  ASSERT_TRUE(session->stop());
  EXPECT_FALSE(session->stop()) << "once";
}

TEST_F(Live, TicksAreTheTimeTimesTheRate) {
  options_.record.clear();
  options_.rate_hz = 500;
  auto session = started();
  ASSERT_TRUE(comes_true([&] { return session->status().ticks > 0; }));
  const std::int64_t before = session->status().ticks;
  const std::int64_t begin_ns = now_ns();
  sleep_for(1000);
  const std::int64_t ticks = session->status().ticks - before;
  const double seconds = static_cast<double>(now_ns() - begin_ns) * 1e-9;
  EXPECT_NEAR(static_cast<double>(ticks), 500.0 * seconds, 100.0);
}

TEST_F(Live, AfterAStandstillTheSessionGoesOnWhereItStood) {
  auto session = started();
  sleep_for(600);
  const std::int64_t before = session->status().ticks;
  const std::string wake = "sleep 1.6; kill -CONT " + std::to_string(::getpid());
  const char* const words[] = {"sh", "-c", wake.c_str(), nullptr};
  pid_t sleeper = 0;
  ASSERT_EQ(::posix_spawn(&sleeper, "/bin/sh", nullptr, nullptr, const_cast<char* const*>(words),
                          environ),
            0);
  ::kill(::getpid(), SIGSTOP);
  ::waitpid(sleeper, nullptr, 0);
  sleep_for(300);
  const LiveStatus status = session->status();
  EXPECT_GE(status.standstills, 1);
  EXPECT_EQ(status.overloads, 0);
  EXPECT_GT(status.skipped_s, 1.3);
  EXPECT_LT(status.ticks - before, 240) << "nothing is made up for";
  const auto remarks = session->take_remarks();
  EXPECT_EQ(std::ranges::count_if(
                remarks, [](const std::string& s) { return s.find("stood still") != s.npos; }),
            1);
  EXPECT_TRUE(comes_true([&] { return session->has_ended(); }));
  const auto summaries = session->stop();
  ASSERT_TRUE(summaries);
  EXPECT_EQ(*summaries, replayed());
}

TEST_F(Live, WithoutAPadItStandsAndRecordsNothing) {
  options_.wish.pad = "0001:fffe";
  auto session = started();
  sleep_for(200);
  const auto summaries = session->stop();
  ASSERT_TRUE(summaries);
  EXPECT_EQ(summaries->front()["steps_left"], 0);
  EXPECT_FALSE(fs::exists(options_.record));
}

TEST_F(Live, EndsWithItsRecordingWhereItIsNotStopped) {
  {
    auto session = started();
    sleep_for(300);
  }
  EXPECT_TRUE(read_trace(options_.record));
}

TEST_F(Live, WrongWishesAreRefused) {
  options_.rate_hz = 0;
  EXPECT_EQ(LiveSession::start(options_).error().message,
            "a rate of 0 Hz is not within 1 .. 10000");
  options_.rate_hz = 240;
  options_.record = (folder_ / "none" / "x.hid").string();
  EXPECT_FALSE(LiveSession::start(options_));
  options_.record.clear();
  options_.session.styles = {"no_such_style"};
  EXPECT_FALSE(LiveSession::start(options_));
}

// --- the loop alone, so that the test can look into its thread -----------------------------------

struct LoopParts {
  std::unique_ptr<PadStream> pads;
  std::optional<Simulation> simulation;
  std::unique_ptr<Recording> recording;
  std::unique_ptr<LiveLoop> loop;
};

LoopParts made_loop(PadStreamOptions options, const std::string& record) {
  LoopParts parts;
  SimulationConfig config = made_config(2);
  config.pads = unknown_pads(kMaxPads);
  parts.simulation.emplace(std::move(*Simulation::create(config)));
  auto pads = PadStream::start(std::move(options));
  EXPECT_TRUE(pads) << pads.error().message;
  parts.pads = std::move(*pads);
  if (!record.empty()) {
    auto recording = Recording::start(
        {record, kDefaultRateHz, {}},
        [p = parts.pads.get()](std::uint16_t i) -> const TraceDevice& { return p->device(i); });
    EXPECT_TRUE(recording);
    parts.recording = std::move(*recording);
  }
  parts.loop = std::make_unique<LiveLoop>(LiveLoop::Options{}, *parts.simulation, *parts.pads,
                                          parts.recording.get());
  return parts;
}

TEST_F(Live, TheLoopThreadUsesNoHeap) {
  PadStreamOptions options;
  options.wish = options_.wish;
  LoopParts parts = made_loop(std::move(options), options_.record);
  int uses = -1;
  std::thread loop([&] {
    begin_counting_heap_use();
    parts.loop->run();
    uses = heap_uses();
  });
  sleep_for(300);
  parts.pads->command("style limp");
  EXPECT_TRUE(comes_true([&] { return parts.loop->has_ended(); }));
  parts.loop->stop();
  loop.join();
  EXPECT_EQ(uses, 0);
  EXPECT_GT(parts.simulation->counts().reports, 400);
  EXPECT_EQ(parts.simulation->counts().commands, 1);
  EXPECT_GT(parts.simulation->walkers()[0].state.frame.steps[kRightSide], 0);
}

// A pad that is held forward and notes what its motors are told.
struct MotorLog {
  std::mutex mutex;
  std::vector<std::pair<std::int64_t, Rumble>> calls;
};
MotorLog motor_log;

class HeldPad final : public Device {
 public:
  HeldPad() : info_(made_pad()) {
    info_.driver = "held";
    const std::uint64_t one = 1;
    static_cast<void>(!::write(fd_.fd, &one, sizeof one));
  }
  ~HeldPad() override { ::close(fd_.fd); }
  const DeviceInfo& info() const noexcept override { return info_; }
  std::span<const pollfd> poll_fds() const noexcept override { return {&fd_, 1}; }
  Status read(Report& report) noexcept override {
    std::uint64_t value = 0;
    if (::read(fd_.fd, &value, sizeof value) <= 0) return Status::nothing;
    report = made_report(0x80, 0x00);
    report.time_ns = now_ns();
    return Status::report;
  }
  bool rumble(const Rumble& rumble) noexcept override {
    const std::lock_guard lock(motor_log.mutex);
    motor_log.calls.emplace_back(now_ns(), rumble);
    return true;
  }

 private:
  DeviceInfo info_;
  pollfd fd_{::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC), POLLIN, 0};
};

constexpr DriverEntry kHeldPadDriver = {
    .name = "held",
    .library = "",
    .find =
        [] {
          DeviceListing listing;
          listing.info = made_pad();
          listing.info.driver = "held";
          listing.node = listing.pad_path = "held";
          return std::vector<DeviceListing>{listing};
        },
    .open = [](const DeviceListing&, Detach) -> Result<std::unique_ptr<Device>> {
      return std::unique_ptr<Device>(std::make_unique<HeldPad>());
    }};

TEST_F(Live, EveryHeelStrikeIsABeatOf80MsThatGrowsWithTheSpeed) {
  motor_log.calls.clear();
  const int eventfd = ::eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC);
  PadStreamOptions options;
  options.drivers = std::span(&kHeldPadDriver, 1);
  options.changes_fd = eventfd;
  LoopParts parts = made_loop(std::move(options), "");
  std::thread loop([&] { parts.loop->run(); });
  const auto strikes = [] {
    const std::lock_guard lock(motor_log.mutex);
    return std::ranges::count_if(motor_log.calls,
                                 [](const auto& call) { return call.second.strong > 0; });
  };
  EXPECT_TRUE(comes_true([&] { return strikes() >= 5; }));
  sleep_for(200);
  parts.loop->stop();
  loop.join();
  const auto& steps = parts.simulation->walkers()[0].state.frame.steps;
  EXPECT_EQ(strikes(), steps[kLeftSide] + steps[kRightSide]);
  const std::lock_guard lock(motor_log.mutex);
  ASSERT_GE(motor_log.calls.size(), 10u);
  std::uint16_t before = 0;
  for (std::size_t i = 0; i + 1 < motor_log.calls.size(); i += 2) {
    const auto& [start_ns, beat] = motor_log.calls[i];
    const auto& [end_ns, rest] = motor_log.calls[i + 1];
    EXPECT_GE(beat.strong, before) << "it walks faster and faster";
    EXPECT_EQ(rest.strong, 0);
    const double lasted_ms = static_cast<double>(end_ns - start_ns) * 1e-6;
    EXPECT_GT(lasted_ms, 75.0);
    EXPECT_LT(lasted_ms, 300.0) << "much later only where the computer is busy";
    before = beat.strong;
  }
  parts = {};
  ::close(eventfd);
}

TEST(HeelBeat, IsAlwaysFeltAndFullFromOnePointFiveMetresASecondOn) {
  EXPECT_GT(heel_beat(0.0).strong, 0.2 * 65535);
  EXPECT_EQ(heel_beat(1.5).strong, 65535);
  EXPECT_EQ(heel_beat(9.0).strong, 65535);
  for (int i = 1; i <= 15; ++i) {
    EXPECT_GT(heel_beat(0.1 * i).strong, heel_beat(0.1 * (i - 1)).strong);
    EXPECT_GT(heel_beat(0.1 * i).weak, heel_beat(0.1 * (i - 1)).weak);
  }
}

TEST(Realtime, WhatWasRefusedIsSaidInOneSentenceWithItsRemedy) {
  EXPECT_FALSE(realtime_remark(std::nullopt, std::nullopt));
  const auto both = realtime_remark("SCHED_FIFO: no", "mlockall: no");
  ASSERT_TRUE(both);
  for (const char* piece : {"(SCHED_FIFO: no, mlockall: no)", "- rtprio 20` and `",
                            "- memlock unlimited`", "/etc/security/limits.d/"}) {
    EXPECT_NE(both->find(piece), std::string::npos) << *both;
  }
  EXPECT_EQ(realtime_remark("SCHED_FIFO: no", std::nullopt)->find("memlock"), std::string::npos);
  EXPECT_EQ(realtime_remark(std::nullopt, "mlockall: no")->find("rtprio"), std::string::npos);
}

}  // namespace
}  // namespace gaitpad

#include "session/live_loop.h"

#include <gtest/gtest.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "system/clock.h"
#include "tests/comes_true.h"
#include "tests/pads/fake_drivers.h"
#include "tests/session/heap_use.h"
#include "tests/session/live_fixture.h"

namespace gaitpad {
namespace {

// --- TickClock

constexpr std::int64_t kStart_ns = 123'456'789'012'345;

TEST(TickClock, TicksAreDueAtWholeFractionsOfASecondForEver) {
  const TickClock clock(240, kStart_ns);
  EXPECT_EQ(clock.due_ns(0), kStart_ns);
  EXPECT_EQ(clock.due_ns(1), kStart_ns + 4'166'666);
  EXPECT_EQ(clock.due_ns(2), kStart_ns + 8'333'333);
  EXPECT_EQ(clock.due_ns(240), kStart_ns + kSecond_ns);
  // A year at 10 kHz has 3.2e11 ticks; times 1e9 they would overflow 64 bits.
  const TickClock fast(10'000, kStart_ns);
  const std::int64_t year_s = 31'536'000;
  EXPECT_EQ(fast.due_ns(year_s * 10'000 + 1), kStart_ns + year_s * kSecond_ns + 100'000);
}

TEST(TickClock, ALateTickDoesNotShiftTheFollowingOnes) {
  TickClock clock(100, kStart_ns);
  const std::int64_t period_ns = 10'000'000;
  EXPECT_EQ(clock.begin(5, clock.due_ns(5)), TickClock::Begin::on_time);
  EXPECT_EQ(clock.begin(6, clock.due_ns(6) + period_ns), TickClock::Begin::on_time);
  EXPECT_EQ(clock.begin(7, clock.due_ns(7) + period_ns + 1), TickClock::Begin::late);
  EXPECT_EQ(clock.begin(8, clock.due_ns(8) + kSecond_ns), TickClock::Begin::late);
  EXPECT_EQ(clock.due_ns(9), kStart_ns + 9 * period_ns);
}

TEST(TickClock, AfterMoreThanASecondItIsSetForward) {
  TickClock clock(100, kStart_ns);
  const std::int64_t now_ns = clock.due_ns(50) + kSecond_ns + 1;
  EXPECT_EQ(clock.begin(50, now_ns), TickClock::Begin::after_standstill);
  EXPECT_EQ(clock.skipped_ns(), kSecond_ns + 1);
  EXPECT_EQ(clock.due_ns(50), now_ns);
  EXPECT_EQ(clock.due_ns(51), now_ns + 10'000'000);
  EXPECT_EQ(clock.begin(51, clock.due_ns(51)), TickClock::Begin::on_time);
}

TEST(TickClock, APaceStretchesTheTimeBetweenTicks) {
  TickClock clock(100, kStart_ns);
  clock.set_pace(0.25, 10, clock.due_ns(9));
  EXPECT_EQ(clock.due_ns(10), kStart_ns + 100'000'000) << "tick 10 stays where it was";
  EXPECT_EQ(clock.due_ns(11), kStart_ns + 140'000'000);
  EXPECT_EQ(clock.due_ns(10 + 1'000'000), kStart_ns + 100'000'000 + 40'000'000'000'000);
  EXPECT_EQ(clock.begin(11, clock.due_ns(11) + 39'000'000), TickClock::Begin::on_time);
  EXPECT_EQ(clock.begin(12, clock.due_ns(12) + 41'000'000), TickClock::Begin::late);
  // At pace 1 the next tick is due sooner than at the old pace.
  clock.set_pace(1.0, 13, clock.due_ns(12) + 1'000'000);
  EXPECT_EQ(clock.due_ns(13), kStart_ns + 100'000'000 + 2 * 40'000'000 + 11'000'000);
}

TEST(TickClock, ALateTickStaysLateAtAnotherPace) {
  TickClock clock(100, kStart_ns);
  const std::int64_t now_ns = clock.due_ns(20);
  clock.set_pace(0.5, 15, now_ns);
  EXPECT_EQ(clock.due_ns(15), now_ns - 50'000'000);
  EXPECT_EQ(clock.begin(15, now_ns), TickClock::Begin::late);
}

TEST(TickClock, StandingStillIsNeitherLateNorSkipped) {
  TickClock clock(100, kStart_ns);
  clock.set_pace(0.0, 7, clock.due_ns(7));
  EXPECT_EQ(clock.due_ns(7), TickClock::kNever_ns);
  const std::int64_t now_ns = kStart_ns + 3600 * kSecond_ns;
  clock.set_pace(1.0, 9, now_ns);  // two ticks ran while the clock stood still
  EXPECT_EQ(clock.due_ns(9), now_ns);
  EXPECT_EQ(clock.begin(9, now_ns), TickClock::Begin::on_time);
  EXPECT_EQ(clock.skipped_ns(), 0);
}

TEST(TickClock, PacesAreLimitedToTheUsableRange) {
  EXPECT_EQ(TickClock::usable_pace(0.25), 0.25);
  EXPECT_EQ(TickClock::usable_pace(-1.0), 0.0);
  EXPECT_EQ(TickClock::usable_pace(std::nan("")), 0.0);
  EXPECT_EQ(TickClock::usable_pace(1e-9), 0.0);
  EXPECT_EQ(TickClock::usable_pace(1e300), TickClock::kMaxPace);
}

TEST(TickClock, TicksThatTakeTooLongAreNotAStandstill) {
  TickClock clock(100, kStart_ns);
  std::int64_t now_ns = kStart_ns;
  int set_forward = 0;
  // Ticks of 10 ms, calls every 15 ms.
  for (int tick = 0; tick < 400; ++tick, now_ns += 15'000'000) {
    const TickClock::Begin begin = clock.begin(tick, now_ns);
    EXPECT_NE(begin, TickClock::Begin::after_standstill);
    set_forward += begin == TickClock::Begin::after_overload;
  }
  EXPECT_EQ(set_forward, 1) << "after 201 ticks it is a second late, after 402 again";
}

// --- TimeHistogram

TEST(TimeHistogram, IsZeroWhenEmpty) {
  const auto times = std::make_unique<TimeHistogram>();
  EXPECT_EQ(times->median_us(), 0.0);
  EXPECT_EQ(times->max_us(), 0.0);
}

TEST(TimeHistogram, MedianOfOneValueIsThatValueWithinOnePercent) {
  for (std::int64_t ns = 1; ns < std::int64_t{1} << 39; ns += ns / 3 + 1) {
    const auto times = std::make_unique<TimeHistogram>();
    times->add(ns);
    const double us = static_cast<double>(ns) / 1000.0;
    ASSERT_NEAR(times->median_us(), us, 0.01 * us) << ns;
    ASSERT_EQ(times->max_us(), us);
  }
}

TEST(TimeHistogram, HalfOfTheValuesLieBelowTheMedian) {
  const auto times = std::make_unique<TimeHistogram>();
  // The numbers 1 to 1001, once each.
  for (int i = 1; i <= 1001; ++i) times->add((i * 7919 % 1001 + 1) * 1000);
  EXPECT_NEAR(times->median_us(), 501.0, 5.1);
  EXPECT_NEAR(times->percentile_us(0.99), 991.0, 10.0);
  EXPECT_NEAR(times->percentile_us(0.01), 11.0, 0.2);
  EXPECT_EQ(times->percentile_us(1.0), 1001.0);
  EXPECT_EQ(times->max_us(), 1001.0);
}

TEST(TimeHistogram, ValuesOutsideTheRangeCountAtTheEnds) {
  const auto times = std::make_unique<TimeHistogram>();
  times->add(-5);
  EXPECT_EQ(times->median_us(), 0.0);
  for (int i = 0; i < 3; ++i) times->add(std::int64_t{1} << 62);
  EXPECT_GT(times->median_us(), 1e9);
  EXPECT_EQ(times->max_us(), static_cast<double>(std::int64_t{1} << 62) / 1000.0);
}

// --- TickReports

constexpr std::int64_t kNow_ns = std::int64_t{1} << 60;
constexpr std::uint8_t kHatAtRest = 0x08, kFirstButton = 0x10;  // values of made_pad()'s fifth byte

// A pad on a real stream; its reports are gathered and taken as in the loop.
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
  // Gathers until the pads have sent `reports` reports, including those that were left out.
  void gather_until(std::int64_t reports) {
    comes_true([&] {
      reports_->gather(kNow_ns);
      return stream_->counts().reports >= reports;
    });
    reports_->gather(kNow_ns);
    EXPECT_EQ(stream_->counts().reports, reports);
  }
  // Runs a tick and returns X of each report that it used, or -kind for other kinds.
  std::vector<int> step() {
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

TEST_F(LiveTickReports, ATickUsesAllReportsSinceThePreviousOne) {
  for (int x = 1; x <= 5; ++x) send(x);
  ASSERT_TRUE(comes_true([&] { return stream_->counts().reports >= 6; }));
  EXPECT_EQ(step(), (std::vector<int>{1, 2, 3, 4, 5}));
  EXPECT_EQ(step(), std::vector<int>());
}

TEST_F(LiveTickReports, ALongStandstillKeepsTheNewestMoveAndLosesNoReport) {
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

TEST_F(LiveTickReports, EveryPressIsKeptAndShowsAtOnce) {
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

// A press is counted once, first when it is gathered and then by the simulation.
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

TEST_F(LiveTickReports, PluggingAndCommandsKeepTheirOrder) {
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

TEST_F(LiveTickReports, ReportsBeyondTheLimitWaitForTheNextTick) {
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

TEST_F(LiveTickReports, ADeviceIsKnownAfterItWasAdded) {
  EXPECT_TRUE(reports_->is_known(0));
  EXPECT_FALSE(reports_->is_known(1));
  EXPECT_FALSE(reports_->is_known(kNoDevice));
}

// --- the loop alone, so that the test can count what its thread allocates

struct LoopParts {
  std::unique_ptr<PadStream> pads;
  std::optional<Simulation> simulation;
  std::unique_ptr<Recording> recording;
  Script script;
  // Receives the ticks that are streamed to other programs.
  std::unique_ptr<Latest<StreamedTick>> stream = std::make_unique<Latest<StreamedTick>>();
  std::unique_ptr<ForwardMail> forward = std::make_unique<ForwardMail>();
  std::unique_ptr<LiveLoop> loop;
};

using LiveLoopTest = Live;

LoopParts made_loop(PadStreamOptions options, const std::string& record) {
  LoopParts parts;
  SimulationConfig config = made_config(2);
  config.pads = unknown_pads(kMaxPads);
  parts.simulation.emplace(made_simulation(config));
  parts.pads = value_of(PadStream::start(std::move(options)));
  if (!record.empty()) {
    auto recording = Recording::start(
        {record, kDefaultRateHz, {}},
        [p = parts.pads.get()](std::uint16_t i) -> const TraceDevice& { return p->device(i); });
    EXPECT_TRUE(recording);
    parts.recording = std::move(*recording);
  }
  parts.script.events.push_back({200'000, "mark", ""});
  const LiveLoop::Options loop = {.stream = parts.stream.get(), .forward = parts.forward.get()};
  parts.loop = std::make_unique<LiveLoop>(loop, parts.script, *parts.simulation, *parts.pads,
                                          parts.recording.get());
  return parts;
}

TEST_F(LiveLoopTest, TheLoopThreadUsesNoHeap) {
  PadStreamOptions options;
  options.selector = options_.pad.selector;
  LoopParts parts = made_loop(std::move(options), options_.live.record);
  int uses = -1;
  std::thread loop([&] {
    begin_counting_heap_use();
    parts.loop->run();
    uses = heap_uses();
  });
  sleep_for(300);
  parts.pads->command("style limp");
  for (const double pace : {0.0, 0.5, 0.0, 2.0}) {
    parts.loop->set_pace(pace);
    parts.loop->step(3);
    sleep_for(60);
  }
  parts.loop->set_pace(1.0);
  EXPECT_TRUE(comes_true([&] { return parts.loop->has_ended(); }));
  parts.loop->stop();
  loop.join();
  EXPECT_EQ(uses, 0);
  bool is_new = false;
  const StreamedTick& streamed = parts.stream->read(is_new);
  EXPECT_EQ(streamed.tick, parts.simulation->counts().ticks - 1);
  EXPECT_EQ(streamed.walkers[1].pose.root_m, parts.simulation->walkers()[1].pose.root_m);
  EXPECT_EQ(parts.forward->read(is_new).state.stick.left, parts.simulation->stick().left);
  EXPECT_TRUE(is_new);
  EXPECT_GT(parts.simulation->counts().reports, 100);
  EXPECT_EQ(parts.simulation->counts().commands, 2);  // the command of the script and the one above
  EXPECT_GT(walk_steps(parts.simulation->walkers()[0].state).steps[kRightSide], 0);
}

// A pad that is held forward; it logs each command to its motors.
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

TEST_F(LiveLoopTest, EveryHeelStrikeIsABeatOf80MsThatGrowsWithTheSpeed) {
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
  const auto steps = walk_steps(parts.simulation->walkers()[0].state).steps;
  EXPECT_EQ(strikes(), steps[kLeftSide] + steps[kRightSide]);
  const std::lock_guard lock(motor_log.mutex);
  ASSERT_GE(motor_log.calls.size(), 10u);
  std::uint16_t before = 0;
  std::vector<double> lasted_ms;
  for (std::size_t i = 0; i + 1 < motor_log.calls.size(); i += 2) {
    const auto& [start_ns, beat] = motor_log.calls[i];
    const auto& [end_ns, rest] = motor_log.calls[i + 1];
    EXPECT_GE(beat.strong, before) << "the walk accelerates";
    EXPECT_EQ(rest.strong, 0);
    lasted_ms.push_back(static_cast<double>(end_ns - start_ns) * 1e-6);
    before = beat.strong;
  }
  // On a busy computer a beat may begin or end late, so only the median is judged.
  std::ranges::sort(lasted_ms);
  EXPECT_GT(lasted_ms[lasted_ms.size() / 2], 70.0);
  EXPECT_LT(lasted_ms[lasted_ms.size() / 2], 160.0);
  parts = {};
  ::close(eventfd);
}

TEST(HeelBeat, IsNeverZeroAndFullFromOnePointFiveMetresASecond) {
  EXPECT_GT(heel_beat(0.0).strong, 0.2 * 65535);
  EXPECT_EQ(heel_beat(1.5).strong, 65535);
  EXPECT_EQ(heel_beat(9.0).strong, 65535);
  for (int i = 1; i <= 15; ++i) {
    EXPECT_GT(heel_beat(0.1 * i).strong, heel_beat(0.1 * (i - 1)).strong);
    EXPECT_GT(heel_beat(0.1 * i).weak, heel_beat(0.1 * (i - 1)).weak);
  }
}

}  // namespace
}  // namespace gaitpad

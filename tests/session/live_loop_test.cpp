// The loop alone, so that the test can look into its thread.
#include "session/live_loop.h"

#include <gtest/gtest.h>
#include <sys/eventfd.h>

#include <algorithm>
#include <mutex>
#include <optional>
#include <thread>

#include "drivers/posix.h"
#include "tests/session/heap_use.h"
#include "tests/session/live_fixture.h"

namespace gaitpad {
namespace {

struct LoopParts {
  std::unique_ptr<PadStream> pads;
  std::optional<Simulation> simulation;
  std::unique_ptr<Recording> recording;
  Script script;
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
  parts.loop = std::make_unique<LiveLoop>(LiveLoop::Options{}, parts.script, *parts.simulation,
                                          *parts.pads, parts.recording.get());
  return parts;
}

TEST_F(LiveLoopTest, TheLoopThreadUsesNoHeap) {
  PadStreamOptions options;
  options.wish = options_.pad.wish;
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
  EXPECT_GT(parts.simulation->counts().reports, 400);
  EXPECT_EQ(parts.simulation->counts().commands, 2);  // the script's and the one above
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

}  // namespace
}  // namespace gaitpad

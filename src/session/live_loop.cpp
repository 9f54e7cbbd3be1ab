#include "session/live_loop.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

#include "drivers/posix.h"
#include "session/realtime.h"

namespace gaitpad {
namespace {

constexpr std::size_t kMaxReportsInTick = 256;  // what is more waits for the next tick
constexpr std::int64_t kNap_ns = 100'000'000;   // a sleep's longest piece: stop() waits for it
constexpr std::chrono::milliseconds kBeat{80};
constexpr double kFullBeatSpeed_m_s = 1.5;
constexpr double kFeltBeat = 0.25;  // of full strength; much less does not turn a motor in 80 ms
constexpr auto kRelaxed = std::memory_order_relaxed;

void copy(const Report& from, std::int64_t now_ns, Report& to) noexcept {
  to.time_ns = std::min(from.time_ns, now_ns);
  to.device = from.device;
  to.kind = from.kind;
  to.size = std::min<std::uint16_t>(from.size, kMaxReportBytes);
  std::memcpy(to.bytes.data(), from.bytes.data(), to.size);
}

}  // namespace

Rumble heel_beat(double speed_m_s) noexcept {
  const double pace = std::clamp(speed_m_s / kFullBeatSpeed_m_s, 0.0, 1.0);
  const auto strength =
      static_cast<std::uint16_t>(65535.0 * (kFeltBeat + (1.0 - kFeltBeat) * pace));
  // The heavy motor alone would start too slowly to be felt as a strike.
  return {strength, static_cast<std::uint16_t>(strength / 2)};
}

LiveLoop::LiveLoop(const Options& options, Simulation& simulation, PadStream& pads,
                   Recording* recording)
    : options_(options),
      simulation_(simulation),
      pads_(pads),
      recording_(recording),
      clock_(options.rate_hz, 0),
      reports_(kMaxReportsInTick) {}

void LiveLoop::run() noexcept {
  const std::int64_t start_ns = now_ns();
  clock_ = TickClock(options_.rate_hz, start_ns);
  if (recording_ != nullptr) recording_->clock(0, start_ns);
  for (std::int64_t tick = 0; sleep_until(clock_.due_ns(tick)); ++tick) {
    const std::int64_t begin_ns = now_ns();
    keep_time(tick, begin_ns);
    run_tick(tick, begin_ns);
    tick_times_.add(now_ns() - begin_ns);
    ticks_.store(tick + 1, kRelaxed);
  }
}

// False: to be stopped.
bool LiveLoop::sleep_until(std::int64_t due_ns) const noexcept {
  while (!is_stopping_.load(kRelaxed)) {
    const std::int64_t time_ns = now_ns();
    if (time_ns >= due_ns) return true;
    const std::int64_t until_ns = std::min(due_ns, time_ns + kNap_ns);
    const timespec until = {until_ns / kSecond_ns, until_ns % kSecond_ns};
    ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);  // EINTR: once more
  }
  return false;
}

void LiveLoop::keep_time(std::int64_t tick, std::int64_t now_ns) noexcept {
  const auto count = [](std::atomic<std::int64_t>& n) { n.store(n.load(kRelaxed) + 1, kRelaxed); };
  const TickClock::Begin begin = clock_.begin(tick, now_ns);
  if (begin == TickClock::Begin::on_time) return;
  count(overruns_);
  if (begin == TickClock::Begin::late) return;
  if (recording_ != nullptr) recording_->clock(tick, now_ns);
  skipped_ns_.store(clock_.skipped_ns(), kRelaxed);
  if (begin == TickClock::Begin::after_standstill) {
    count(standstills_);
  } else {
    count(overloads_);
    give_up_priority();  // a loop that never sleeps would leave no time for anybody else
  }
}

void LiveLoop::run_tick(std::int64_t tick, std::int64_t now_ns) noexcept {
  take_reports(tick, now_ns);
  simulation_.step(std::span(reports_.data(), report_count_));
  publish(tick);
  if (options_.rumble && simulation_.heel_struck()) beat();
  look_for_the_end();
}

void LiveLoop::take_reports(std::int64_t tick, std::int64_t now_ns) noexcept {
  report_count_ = 0;
  while (report_count_ < kMaxReportsInTick) {
    const Report* oldest = pads_.front();
    if (oldest == nullptr) return;
    Report& report = reports_[report_count_];
    copy(*oldest, now_ns, report);
    pads_.pop();
    if (!is_known(report)) continue;
    if (report.kind == ReportKind::input) wait_times_.add(now_ns - report.time_ns);
    if (recording_ != nullptr) recording_->add(tick, report);
    ++report_count_;
  }
}

// A device becomes known when it is added for the first time; nothing else of it counts before.
bool LiveLoop::is_known(const Report& report) noexcept {
  if (report.kind == ReportKind::command) return true;
  if (report.device >= is_known_.size()) return false;
  bool& is_known = is_known_[report.device];
  if (!is_known && report.kind == ReportKind::added) {
    simulation_.set_pad(report.device, std::move(pads_.config(report.device)));
    is_known = true;
  }
  return is_known;
}

void LiveLoop::publish(std::int64_t tick) noexcept {
  SessionFrame& frame = frames_.writable();
  copy_frame(simulation_, frame);
  frame.time_ns = clock_.due_ns(tick);
  frames_.publish();
}

void LiveLoop::beat() noexcept {
  const std::uint16_t device = simulation_.pads().driving();
  if (device == kNoDevice) return;
  const double speed_m_s = simulation_.walkers().front().state.frame.speed_m_s;
  pads_.rumble(device, heel_beat(speed_m_s), kBeat);
}

// A recording as a pad: a second behind its end, as a replay without an end line.
void LiveLoop::look_for_the_end() noexcept {
  const bool is_over = pads_.has_ended() && report_count_ == 0;
  if (is_over || ticks_behind_end_ > 0) ++ticks_behind_end_;
  if (ticks_behind_end_ >= options_.rate_hz) has_ended_.store(true, kRelaxed);
}

LiveStatus LiveLoop::status() const noexcept {
  LiveStatus status;
  status.ticks = ticks_.load(kRelaxed);
  status.overruns = overruns_.load(kRelaxed);
  status.standstills = standstills_.load(kRelaxed);
  status.overloads = overloads_.load(kRelaxed);
  status.skipped_s = static_cast<double>(skipped_ns_.load(kRelaxed)) * 1e-9;
  status.tick_us_median = tick_times_.median_us();
  status.tick_us_max = tick_times_.max_us();
  status.wait_us_median = wait_times_.median_us();
  status.wait_us_max = wait_times_.max_us();
  return status;
}

}  // namespace gaitpad

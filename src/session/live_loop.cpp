#include "session/live_loop.h"

#include <time.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "drivers/posix.h"
#include "session/realtime.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kNap_ns = 20'000'000;  // a sleep's longest piece: orders wait for its end
constexpr std::size_t kSamples = 1024;        // that nobody took yet, four seconds
constexpr std::chrono::milliseconds kBeat{80};
constexpr double kFullBeatSpeed_m_s = 1.5;
constexpr double kFeltBeat = 0.25;  // of full strength; much less does not turn a motor in 80 ms
constexpr auto kRelaxed = std::memory_order_relaxed;

static_assert(std::atomic<double>::is_always_lock_free);

// By the one thread that counts.
void count(std::atomic<std::int64_t>& n) noexcept { n.store(n.load(kRelaxed) + 1, kRelaxed); }

void sleep_until(std::int64_t time_ns) noexcept {
  const timespec until = {time_ns / kSecond_ns, time_ns % kSecond_ns};
  ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);  // EINTR: the caller looks
}

}  // namespace

Rumble heel_beat(double speed_m_s) noexcept {
  const double pace = std::clamp(speed_m_s / kFullBeatSpeed_m_s, 0.0, 1.0);
  const auto strength =
      static_cast<std::uint16_t>(65535.0 * (kFeltBeat + (1.0 - kFeltBeat) * pace));
  // The heavy motor alone would start too slowly to be felt as a strike.
  return {strength, static_cast<std::uint16_t>(strength / 2)};
}

LiveLoop::LiveLoop(const Options& options, const Script& script, Simulation& simulation,
                   PadStream& pads, Recording* recording)
    : options_(options),
      script_(script),
      simulation_(simulation),
      pads_(pads),
      recording_(recording),
      clock_(options.rate_hz, 0),
      reports_(pads, simulation),
      samples_(kSamples) {}

void LiveLoop::begin() noexcept {
  const std::int64_t start_ns = now_ns();
  clock_ = TickClock(options_.rate_hz, start_ns);
  if (recording_ != nullptr) recording_->clock(0, start_ns);
}

void LiveLoop::run() noexcept {
  begin();
  start_ns_.store(clock_.due_ns(0), kRelaxed);
  while (wait_for_tick()) {
    const std::int64_t begin_ns = now_ns();
    const bool has_steps = clock_.pace() == 0.0;
    if (has_steps) {
      --steps_left_;
    } else {
      keep_time(begin_ns);
    }
    run_tick(begin_ns, has_steps ? begin_ns : clock_.due_ns(tick_));
  }
  end_ns_.store(now_ns(), kRelaxed);
}

void LiveLoop::advance(int ticks) noexcept {
  for (int i = 0; i < ticks; ++i) run_tick(now_ns(), 0);
}

// False: to be stopped.
bool LiveLoop::wait_for_tick() noexcept {
  while (!is_stopping_.load(kRelaxed)) {
    follow_orders();
    const std::int64_t due = due_ns(), time_ns = now_ns();
    if (time_ns >= due) return true;
    if (clock_.pace() == 0.0) look_at_pads(time_ns);
    sleep_until(std::min(due, time_ns + kNap_ns));
  }
  return false;
}

void LiveLoop::set_pace(double pace) noexcept {
  wanted_pace_.store(TickClock::usable_pace(pace), std::memory_order_release);
}

void LiveLoop::step(int ticks) noexcept {
  if (ticks > 0) wanted_steps_.fetch_add(ticks, std::memory_order_release);
}

// Steps first: whoever sees them sees the pace that was set before they were asked for, too.
void LiveLoop::follow_orders() noexcept {
  const std::int64_t steps = wanted_steps_.exchange(0, std::memory_order_acquire);
  const double pace = wanted_pace_.load(std::memory_order_acquire);
  if (pace != clock_.pace()) {
    const std::int64_t time_ns = now_ns();
    clock_.set_pace(pace, tick_, time_ns);
    real_time_ns_ = time_ns;
    if (recording_ != nullptr)
      recording_->clock(tick_, pace > 0.0 ? clock_.due_ns(tick_) : time_ns, pace);
  }
  steps_left_ = pace > 0.0 ? 0 : steps_left_ + steps;
}

std::int64_t LiveLoop::due_ns() const noexcept {
  if (clock_.pace() > 0.0) return clock_.due_ns(tick_);
  if (steps_left_ == 0) return TickClock::kNever_ns;
  const double step_ns = kSecond_ns / (options_.rate_hz * TickClock::kMaxPace);
  return last_begin_ns_ + static_cast<std::int64_t>(step_ns);
}

// What comes while ticks stand still is seen, though no tick uses it yet.
void LiveLoop::look_at_pads(std::int64_t now_ns) noexcept {
  if (reports_.gather(now_ns)) publish(shown_ns_);
}

void LiveLoop::keep_time(std::int64_t now_ns) noexcept {
  late_times_.add(now_ns - clock_.due_ns(tick_));
  const TickClock::Begin begin = clock_.begin(tick_, now_ns);
  if (begin == TickClock::Begin::on_time) return;
  count(overruns_);
  if (begin == TickClock::Begin::late) return;
  if (recording_ != nullptr) recording_->clock(tick_, now_ns, clock_.pace());
  skipped_ns_.store(clock_.skipped_ns(), kRelaxed);
  if (begin == TickClock::Begin::after_standstill) {
    count(standstills_);
  } else {
    count(overloads_);
    give_up_priority();  // a loop that never sleeps would leave no time for anybody else
  }
}

void LiveLoop::run_tick(std::int64_t now_ns, std::int64_t shown_ns) noexcept {
  follow_script(now_ns);
  const std::span<const Report> reports = reports_.take(now_ns);
  use(reports, now_ns);
  simulation_.step(reports);
  publish(shown_ns);
  if (options_.rumble && simulation_.heel_struck()) beat();
  look_for_the_end(!reports.empty());
  last_begin_ns_ = now_ns;
  ++tick_;
  sample(gaitpad::now_ns() - now_ns);
  ticks_.store(tick_, kRelaxed);
}

// Ahead of what else belongs to the tick, and recorded like it: a replay needs no script.
void LiveLoop::follow_script(std::int64_t now_ns) noexcept {
  for (; next_event_ < script_.events.size() &&
         tick_of(script_.events[next_event_], options_.rate_hz) <= tick_;
       ++next_event_) {
    Report report = report_of(script_.events[next_event_]);
    report.time_ns = now_ns;
    if (recording_ != nullptr) recording_->add(tick_, report);
    simulation_.take(report);
  }
}

void LiveLoop::use(std::span<const Report> reports, std::int64_t now_ns) noexcept {
  const bool is_real_time = clock_.pace() == 1.0;
  for (const Report& report : reports) {
    if (recording_ != nullptr) recording_->add(tick_, report);
    if (report.kind != ReportKind::input) continue;
    if (is_real_time && report.time_ns >= real_time_ns_) count_wait(now_ns - report.time_ns);
  }
}

void LiveLoop::count_wait(std::int64_t wait_ns) noexcept {
  wait_times_.add(wait_ns);
  const std::int64_t last = static_cast<std::int64_t>(wait_counts_.size()) - 1;
  const std::int64_t place = std::clamp<std::int64_t>(wait_ns / LiveStatus::kWaitClass_ns, 0, last);
  count(wait_counts_[static_cast<std::size_t>(place)]);
}

void LiveLoop::publish(std::int64_t shown_ns) noexcept {
  shown_ns_ = shown_ns;
  SessionFrame& frame = frames_.writable();
  copy_frame(simulation_, frame);
  frame.time_ns = shown_ns;
  reports_.show(frame);
  frames_.publish();
}

// A full ring: nobody takes them, or not fast enough.
void LiveLoop::sample(std::int64_t took_ns) noexcept {
  tick_times_.add(took_ns);
  copy_sample(simulation_, sample_);
  sample_.step_us = static_cast<float>(took_ns) / 1000.0f;
  static_cast<void>(samples_.push(sample_));
}

void LiveLoop::beat() noexcept {
  const std::uint16_t device = simulation_.pads().driving();
  if (device == kNoDevice) return;
  const double speed_m_s = simulation_.walkers().front().state.frame.speed_m_s;
  pads_.rumble(device, heel_beat(speed_m_s), kBeat);
}

// A recording as a pad: a second behind its end, as a replay without an end line.
void LiveLoop::look_for_the_end(bool has_reports) noexcept {
  const bool is_over = pads_.has_ended() && !has_reports;
  if (is_over || ticks_behind_end_ > 0) ++ticks_behind_end_;
  if (ticks_behind_end_ >= options_.rate_hz) has_ended_.store(true, kRelaxed);
}

LiveStatus LiveLoop::status() const noexcept {
  LiveStatus status;
  status.ticks = ticks_.load(kRelaxed);
  const std::int64_t start_ns = start_ns_.load(kRelaxed), end_ns = end_ns_.load(kRelaxed);
  if (start_ns != 0)
    status.time_s = static_cast<double>((end_ns != 0 ? end_ns : now_ns()) - start_ns) * 1e-9;
  status.overruns = overruns_.load(kRelaxed);
  status.standstills = standstills_.load(kRelaxed);
  status.overloads = overloads_.load(kRelaxed);
  status.skipped_s = static_cast<double>(skipped_ns_.load(kRelaxed)) * 1e-9;
  status.late_us_median = late_times_.median_us();
  status.late_us_max = late_times_.max_us();
  status.tick_us_median = tick_times_.median_us();
  status.tick_us_max = tick_times_.max_us();
  status.wait_us_median = wait_times_.median_us();
  status.wait_us_max = wait_times_.max_us();
  for (std::size_t i = 0; i < wait_counts_.size(); ++i)
    status.wait_counts[i] = wait_counts_[i].load(kRelaxed);
  return status;
}

}  // namespace gaitpad

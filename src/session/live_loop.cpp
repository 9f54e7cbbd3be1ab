#include "session/live_loop.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <utility>

#include "drivers/realtime.h"
#include "gaitpad/decode.h"
#include "system/clock.h"

namespace gaitpad {

// --- TickClock

double TickClock::usable_pace(double pace) noexcept {
  if (!(pace >= kMinPace)) return 0.0;
  return std::min(pace, kMaxPace);
}

std::int64_t TickClock::due_ns(std::int64_t tick) const noexcept {
  if (pace_ == 0.0) return kNever_ns;
  const std::int64_t ticks = tick - base_tick_;
  if (pace_ != 1.0) {
    const double tick_ns =
        static_cast<double>(kSecond_ns) / (static_cast<double>(rate_hz_) * pace_);
    return base_ns_ + static_cast<std::int64_t>(std::round(static_cast<double>(ticks) * tick_ns));
  }
  return base_ns_ + ticks / rate_hz_ * kSecond_ns + ticks % rate_hz_ * kSecond_ns / rate_hz_;
}

void TickClock::run_anew(std::int64_t tick, std::int64_t due_ns) noexcept {
  base_tick_ = tick;
  base_ns_ = due_ns;
}

void TickClock::set_pace(double pace, std::int64_t tick, std::int64_t now_ns) noexcept {
  const bool stood_still = pace_ == 0.0;
  const std::int64_t before_ns = due_ns(tick);
  pace_ = pace;
  if (pace_ == 0.0) return;
  run_anew(tick, now_ns);
  if (stood_still) {
    last_late_ns_ = 0;
  } else {
    // The next tick is due at most one tick from now.
    run_anew(tick, std::min(before_ns, due_ns(tick + 1)));
  }
}

TickClock::Begin TickClock::begin(std::int64_t tick, std::int64_t now_ns) noexcept {
  const std::int64_t late_ns = now_ns - due_ns(tick);
  const std::int64_t before_ns = std::exchange(last_late_ns_, late_ns);
  if (late_ns <= kTooLate_ns) return now_ns > due_ns(tick + 1) ? Begin::late : Begin::on_time;
  run_anew(tick, now_ns);
  last_late_ns_ = 0;
  skipped_ns_ += late_ns;
  return late_ns - before_ns > kTooLate_ns / 2 ? Begin::after_standstill : Begin::after_overload;
}

// --- TimeHistogram

// Values below 128 have a class each; above that, the highest seven bits choose the class.
std::size_t TimeHistogram::class_of(std::uint64_t time_ns) noexcept {
  const int octave = std::max(0, static_cast<int>(std::bit_width(time_ns)) - kStepBits - 1);
  const std::size_t index =
      (static_cast<std::size_t>(octave) << kStepBits) + static_cast<std::size_t>(time_ns >> octave);
  return std::min(index, kClasses - 1);
}

double TimeHistogram::middle_ns(std::size_t index) noexcept {
  const std::size_t steps = std::size_t{1} << kStepBits;
  if (index < 2 * steps) return static_cast<double>(index);
  const std::size_t octave = index / steps - 1;
  const auto width = static_cast<double>(std::uint64_t{1} << octave);
  return (static_cast<double>(index - octave * steps) + 0.5) * width;
}

void TimeHistogram::add(std::int64_t time_ns) noexcept {
  const std::int64_t time = std::max<std::int64_t>(time_ns, 0);
  constexpr auto kRelaxed = std::memory_order_relaxed;
  std::atomic<std::uint64_t>& count = counts_[class_of(static_cast<std::uint64_t>(time))];
  count.store(count.load(kRelaxed) + 1, kRelaxed);  // only this thread writes
  if (time > max_ns_.load(kRelaxed)) max_ns_.store(time, kRelaxed);
}

double TimeHistogram::percentile_us(double share) const noexcept {
  std::array<std::uint64_t, kClasses> counts;
  std::uint64_t all = 0;
  for (std::size_t i = 0; i < kClasses; ++i) {
    all += counts[i] = counts_[i].load(std::memory_order_relaxed);
  }
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < kClasses; ++i) {
    below += counts[i];
    if (below > 0 && static_cast<double>(below) >= share * static_cast<double>(all))
      return std::min(middle_ns(i) / 1000.0, max_us());
  }
  return 0.0;
}

double TimeHistogram::max_us() const noexcept {
  return static_cast<double>(max_ns_.load(std::memory_order_relaxed)) / 1000.0;
}

void TimeHistogram::count_steps(std::int64_t width_ns,
                                std::span<std::int64_t> counts) const noexcept {
  for (std::size_t i = 0; i < kClasses; ++i) {
    const auto step = static_cast<std::size_t>(middle_ns(i) / static_cast<double>(width_ns));
    counts[std::min(step, counts.size() - 1)] +=
        static_cast<std::int64_t>(counts_[i].load(std::memory_order_relaxed));
  }
}

// --- TickReports

TickReports::TickReports(PadStream& pads, Simulation& simulation)
    : pads_(pads), simulation_(simulation), reports_(kMaxInTick) {}

void TickReports::begin_anew() noexcept {
  if (!std::exchange(is_used_, false)) return;
  count_ = 0;
  for (std::uint16_t i = 0; i < gathered_.size(); ++i) {
    if (!gathered_[i].has_state) continue;
    gathered_[i] = {};
    newest_.forget(i);
  }
}

std::span<const Report> TickReports::take_reports(std::int64_t now_ns) noexcept {
  begin_anew();
  while (count_ < kMaxInTick) {
    const Report* oldest = pads_.front();
    if (oldest == nullptr) break;
    copy_used_bytes(*oldest, now_ns, reports_[count_]);
    pads_.pop();
    if (is_of_known_device(reports_[count_])) ++count_;
  }
  is_used_ = true;
  return {reports_.data(), count_};
}

bool TickReports::gather(std::int64_t now_ns) noexcept {
  begin_anew();
  // Takes at most the reports of one tick at once, so that a flood of reports cannot hold the
  // thread.
  std::size_t seen = 0;
  for (; seen < kMaxInTick && count_ < kMaxInTick; ++seen) {
    const Report* oldest = pads_.front();
    if (oldest == nullptr) break;
    Report& report = reports_[count_];
    copy_used_bytes(*oldest, now_ns, report);
    pads_.pop();
    if (is_of_known_device(report) && !replaces_older(report)) ++count_;
  }
  return seen > 0;
}

// A device is known from its first `added` report; earlier reports are ignored.
bool TickReports::is_of_known_device(const Report& report) noexcept {
  if (report.kind == ReportKind::command) return true;
  if (report.device >= is_known_.size()) return false;
  std::atomic<bool>& is_known = is_known_[report.device];
  if (!is_known.load(std::memory_order_relaxed) && report.kind == ReportKind::added) {
    simulation_.set_pad(report.device, pads_.take_config(report.device));
    is_known.store(true, std::memory_order_release);
  }
  return is_known.load(std::memory_order_relaxed);
}

bool TickReports::replaces_older(Report& report) noexcept {
  if (report.kind == ReportKind::command) return false;
  Gathered& device = gathered_[report.device];
  if (!device.has_state && report.device == simulation_.pads().driving())
    device.state = simulation_.pads().driving_state();
  device.has_state = true;
  const PadLayout& layout = pads_.layout(report.device);
  const std::uint8_t id = report_id_of(layout, report);
  Report* const older = newest_.find(report.device, id);
  newest_.forget(report.device);
  if (report.kind != ReportKind::input) {
    device.state = PadState{};
    return false;
  }
  const std::uint32_t before = device.state.buttons;
  if (!decode(layout, report, device.state)) return false;
  count_presses(before, device.state.buttons, device.presses);
  const bool replaces =
      older != nullptr && device.state.buttons == before && older->size == report.size;
  newest_.set(report.device, id, replaces ? older : &report);
  if (replaces) copy_used_bytes(report, report.time_ns, *older);
  return replaces;
}

void TickReports::show(SessionFrame& frame) const noexcept {
  if (is_used_ || frame.pad.device >= gathered_.size()) return;
  const Gathered& device = gathered_[frame.pad.device];
  if (!device.has_state) return;
  frame.pad.state = device.state;
  for (int b = 0; b < kButtonCount; ++b) frame.presses[b] += device.presses[b];
}

bool TickReports::is_known(std::uint16_t device) const noexcept {
  return device < is_known_.size() && is_known_[device].load(std::memory_order_acquire);
}

// --- LiveLoop

namespace {

// Longest sleep: then pace, steps and stop are read again.
constexpr std::int64_t kNap_ns = 20'000'000;
constexpr std::size_t kSamples = 1024;  // samples that wait to be taken: 4 s
constexpr std::size_t kUsed = 4096;     // reports that wait for a frame: over 1 s
// latest_due(): the longest wait for a due tick, and its parts.
constexpr std::int64_t kDueWait_ns = 2'000'000, kDueNap_ns = 100'000;
constexpr std::chrono::milliseconds kBeat{80};
constexpr double kFullBeatSpeed_m_s = 1.5;
// Share of full strength; a weaker beat does not turn a motor in 80 ms.
constexpr double kFeltBeat = 0.25;
constexpr auto kRelaxed = std::memory_order_relaxed;

static_assert(std::atomic<double>::is_always_lock_free);

// Only for counters that a single thread writes.
void count(std::atomic<std::int64_t>& n) noexcept { n.store(n.load(kRelaxed) + 1, kRelaxed); }

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
      samples_(kSamples),
      used_(kUsed) {
  frames_.each([&](SessionFrame& frame) { frame.crowd = simulation.followers().shown(); });
}

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
      note_lateness(begin_ns);
    }
    run_tick(begin_ns, has_steps ? begin_ns : clock_.due_ns(tick_));
  }
  end_ns_.store(now_ns(), kRelaxed);
}

void LiveLoop::advance(int ticks) noexcept {
  drop_recording();
  for (int i = 0; i < ticks; ++i) run_tick(now_ns(), 0);
}

// Returns false if the loop must stop.
bool LiveLoop::wait_for_tick() noexcept {
  while (!is_stopping_.load(kRelaxed)) {
    read_pace_and_steps();
    drop_recording();
    const std::int64_t due = due_ns(), time_ns = now_ns();
    if (time_ns >= due) return true;
    if (clock_.pace() == 0.0) show_new_reports(time_ns);
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

// Reads the steps first: if a thread sets the pace to 0 and then asks for steps, they run at pace
// 0.
void LiveLoop::read_pace_and_steps() noexcept {
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

void LiveLoop::drop_recording() noexcept {
  if (recording_ == nullptr || !leaves_recording_.load(std::memory_order_acquire)) return;
  recording_ = nullptr;
  recorded_ticks_.store(tick_, std::memory_order_release);
}

std::int64_t LiveLoop::due_ns() const noexcept {
  if (clock_.pace() > 0.0) return clock_.due_ns(tick_);
  if (steps_left_ == 0) return TickClock::kNever_ns;
  const double step_ns = kSecond_ns / (options_.rate_hz * TickClock::kMaxPace);
  return last_begin_ns_ + static_cast<std::int64_t>(step_ns);
}

// While ticks stand still, the frame shows new reports although no tick has used them.
void LiveLoop::show_new_reports(std::int64_t now_ns) noexcept {
  if (reports_.gather(now_ns)) publish(shown_ns_);
}

void LiveLoop::note_lateness(std::int64_t now_ns) noexcept {
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
    give_up_priority();  // a loop that never sleeps would leave no time for other threads
  }
}

void LiveLoop::run_tick(std::int64_t now_ns, std::int64_t shown_ns) noexcept {
  if (auto* styles = new_styles_.exchange(nullptr, std::memory_order_acquire)) {
    const std::vector<Style>& before = simulation_.styles();
    simulation_.swap_styles(*styles);
    if (recording_ != nullptr) recording_->styles(tick_, before, simulation_.styles());
  }
  follow_script(now_ns);
  const std::span<const Report> reports = reports_.take_reports(now_ns);
  use(reports, now_ns);
  simulation_.step(reports);
  publish(shown_ns);
  const bool is_tried = wants_beat_.exchange(false, kRelaxed);
  if (is_tried || (options_.rumble && simulation_.heel_struck())) beat();
  look_for_the_end(!reports.empty());
  last_begin_ns_ = now_ns;
  ++tick_;
  sample(gaitpad::now_ns() - now_ns);
  ticks_.store(tick_, kRelaxed);
}

// Runs the script before the tick's other reports. Its commands are recorded, so that a replay
// needs no script.
void LiveLoop::follow_script(std::int64_t now_ns) noexcept {
  for (; next_event_ < script_.events.size() &&
         tick_of(script_.events[next_event_], options_.rate_hz) <= tick_;
       ++next_event_) {
    Report report = report_of(script_.events[next_event_]);
    report.time_ns = now_ns;
    if (recording_ != nullptr) recording_->add(tick_, report);
    simulation_.take_report(report);
  }
}

void LiveLoop::use(std::span<const Report> reports, std::int64_t now_ns) noexcept {
  for (const Report& report : reports) {
    if (recording_ != nullptr) recording_->add(tick_, report);
    if (report.kind != ReportKind::input) continue;
    const bool is_real_time = clock_.pace() == 1.0 && report.time_ns >= real_time_ns_;
    if (is_real_time) wait_times_.add(now_ns - report.time_ns);
    // The ring is full if no viewer shows frames: then the report is left out of the measurement.
    static_cast<void>(used_.push({{tick_, report.time_ns, now_ns, report.device}, is_real_time}));
  }
}

void LiveLoop::publish(std::int64_t shown_ns) noexcept {
  shown_ns_ = shown_ns;
  if (options_.frame_ticks > 0 && tick_ % options_.frame_ticks == 0) {
    SessionFrame& frame = frames_.writable();
    copy_frame(simulation_, frame);
    frame.time_ns = shown_ns;
    reports_.show(frame);
    frames_.publish();
  }
  if (options_.stream != nullptr) {
    copy_tick(simulation_, options_.stream->writable());
    options_.stream->publish();
  }
  if (options_.forward != nullptr)
    options_.forward->put(forwarded_tick(simulation_.pads(), simulation_.stick()));
}

// If the ring is full, no viewer takes samples fast enough: the sample is dropped.
void LiveLoop::sample(std::int64_t took_ns) noexcept {
  tick_times_.add(took_ns);
  copy_sample(simulation_, sample_);
  sample_.step_us = static_cast<float>(took_ns) / 1000.0f;
  static_cast<void>(samples_.push(sample_));
}

void LiveLoop::beat() noexcept {
  const std::uint16_t device = simulation_.pads().driving();
  if (device == kNoDevice) return;
  const double speed_m_s = walk_frame(simulation_.walkers().front()).speed_m_s;
  pads_.rumble(device, heel_beat(speed_m_s), kBeat);
}

// A pad that is a recording ends the session one second after its last report, as a replay of a
// recording without an end line does.
void LiveLoop::look_for_the_end(bool has_reports) noexcept {
  const bool is_over = pads_.has_ended() && !has_reports;
  if (is_over || ticks_behind_end_ > 0) ++ticks_behind_end_;
  if (ticks_behind_end_ >= options_.rate_hz) has_ended_.store(true, kRelaxed);
}

const SessionFrame& LiveLoop::latest(bool& is_new) noexcept {
  const SessionFrame& frame = frames_.read(is_new);
  viewed_tick_ = frame.tick;
  viewed_ns_ = frame.time_ns;
  return frame;
}

// Sleeps briefly so that a due tick runs first; otherwise, on a busy processor, the viewing thread
// draws an old pose.
const SessionFrame& LiveLoop::latest_due() noexcept {
  bool is_new = false;
  latest(is_new);
  const std::int64_t tick_ns = kSecond_ns / options_.rate_hz, start_ns = now_ns();
  const bool is_real_time = wanted_pace_.load(kRelaxed) == 1.0 && !is_stopping_.load(kRelaxed);
  for (std::int64_t time_ns = start_ns;
       is_real_time && viewed_ns_ != 0 && viewed_ns_ + tick_ns <= time_ns &&
       time_ns < start_ns + kDueWait_ns;
       time_ns = now_ns()) {
    sleep_until(time_ns + kDueNap_ns);
    latest(is_new);
  }
  return latest(is_new);
}

void LiveLoop::end_frame(FrameEnd end) noexcept {
  const std::int64_t time_ns = now_ns();
  for (const UsedReport* report = used_.front();
       report != nullptr && report->time.tick <= viewed_tick_; report = used_.front()) {
    if (end == FrameEnd::handed_over && report->is_real_time)
      frame_times_.add(time_ns - report->time.arrival_ns);
    used_.pop();
  }
}

bool LiveLoop::take_report_time(ReportTime& time) noexcept {
  UsedReport report;
  if (!used_.pop(report)) return false;
  time = report.time;
  return true;
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
  status.frame_us_p50 = frame_times_.median_us();
  status.frame_us_p99 = frame_times_.percentile_us(0.99);
  wait_times_.count_steps(LiveStatus::kWaitClass_ns, status.wait_counts);
  return status;
}

}  // namespace gaitpad

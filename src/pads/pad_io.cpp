#include "pads/pad_io.h"

#include <fmt/format.h>
#include <time.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "pads/realtime.h"

namespace gaitpad {

namespace {

using namespace std::chrono_literals;

constexpr int kReadsInRound = 64;  // of one device, then the others have their turn
// More wakes without a report than any sound source makes (SDL's: one each millisecond): they would
// keep the thread busy for ever.
constexpr int kMaxIdleWakes = 500;
constexpr auto kIdleWindow = 100ms;
constexpr int kMaxErrorWakes = 200;  // however slow
constexpr auto kRoomPoll = 2ms;      // how often a full ring is looked at
constexpr auto kMaxRumble = 10s;     // whoever asks for more has made a mistake
constexpr auto kStopRetry = 20ms;    // a motor that did not take its stop
constexpr auto kLookAfter = 500ms;
constexpr double kMaxBusy = 0.8;  // of a processor, with real-time priority
constexpr std::size_t kMaxCommands = 1024;
constexpr std::int64_t kClockSlack_ns = 1'000'000'000;

std::int64_t nanoseconds(std::chrono::steady_clock::time_point time) {
  return std::chrono::nanoseconds(time.time_since_epoch()).count();
}

// A report that holds nothing but its kind. Its bytes are left alone: there are many.
void make_event(Report& report, ReportKind kind, std::uint16_t device, std::int64_t time_ns) {
  report.time_ns = time_ns;
  report.device = device;
  report.kind = kind;
  report.size = 0;
}

std::chrono::nanoseconds processor_time() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

bool is_blank(std::string_view text) {
  return text.find_first_not_of(" \t\r\n") == std::string_view::npos;
}

}  // namespace

PadIo::PadIo(PadQueue& queue, PadCounters& counters, Remarks& remarks, Gone gone)
    : queue_(queue), counters_(counters), remarks_(remarks), gone_(std::move(gone)) {}

void PadIo::stop() {
  is_ending_ = true;
  bell_.ring();
  if (thread_.joinable()) thread_.join();
}

void PadIo::start() {
  thread_ = std::thread([this] { run(); });
}

void PadIo::take_over(OpenedPad pad) {
  {
    const std::lock_guard lock(mutex_);
    handed_.push_back(std::move(pad));
  }
  bell_.ring();
}

void PadIo::command(std::string_view text) {
  if (is_blank(text)) return;  // no line of a recording
  if (text.size() > kMaxReportBytes) {
    remarks_.add_once(fmt::format("a command of {} bytes was left out, {} can be taken",
                                  text.size(), kMaxReportBytes));
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    if (commands_.size() >= kMaxCommands) {
      remarks_.add_once("commands come faster than they are obeyed, some were left out");
      return;
    }
    commands_.emplace_back(text);
  }
  bell_.ring();
}

void PadIo::rumble(std::uint16_t device, const Rumble& rumble,
                   std::chrono::milliseconds duration) noexcept {
  const auto ms = std::clamp<std::chrono::milliseconds>(duration, 0ms, kMaxRumble).count();
  if (motor_wishes_.push({device, rumble, static_cast<std::int32_t>(ms)})) bell_.ring();
}

void PadIo::run() {
  // What is refused, the loop thread says too.
  static_cast<void>(take_priority(RealtimeRank::pads));
  while (!is_ending_) {
    wait_for_fds();
    if ((fds_[0].revents & POLLIN) != 0) {
      bell_.clear();
      take_pads();
      take_commands();
      take_motor_wishes();
    }
    if (!queue_.is_blocked()) read_all();
    queue_.flush();
    queue_.wake_reader();
    const Clock::time_point now = Clock::now();
    stop_motors(now);
    if (now - looked_after_ >= kLookAfter) look_after(now);
  }
  for (auto& pad : pads_) {
    if (pad->is_running) pad->opened.device->rumble({});
  }
  pads_.clear();
  const std::lock_guard lock(mutex_);
  handed_.clear();
}

// Until the next motor has to stop or the ring is to be looked at again; -1: for ever.
int PadIo::timeout_ms(Clock::time_point now) const {
  auto wait = std::chrono::milliseconds(-1);
  const auto at_most = [&wait](std::chrono::milliseconds time) {
    wait = wait < 0ms ? time : std::min(wait, time);
  };
  for (const auto& pad : pads_) {
    if (pad->is_ready && !queue_.is_blocked()) return 0;
    if (!pad->is_running) continue;
    at_most(std::max(std::chrono::ceil<std::chrono::milliseconds>(pad->motor_end - now), 0ms));
  }
  if (queue_.is_waiting()) at_most(kRoomPoll);
  return static_cast<int>(wait.count());
}

void PadIo::wait_for_fds() {
  fds_.assign(1, {bell_.fd(), POLLIN, 0});
  fd_owners_.clear();
  for (auto& pad : pads_) {
    if (queue_.is_blocked()) break;
    for (const pollfd& fd : pad->opened.device->poll_fds()) {
      fds_.push_back({fd.fd, fd.events, 0});
      fd_owners_.push_back(pad.get());
    }
  }
  const int ready = ::poll(fds_.data(), fds_.size(), timeout_ms(Clock::now()));
  now_ns_ = nanoseconds(Clock::now());
  if (ready < 0) {
    fds_[0].revents = 0;
    if (errno != EINTR) std::this_thread::sleep_for(1ms);
    return;
  }
  for (auto& pad : pads_) pad->has_error = false;
  for (std::size_t i = 0; i < fd_owners_.size(); ++i) {
    const short seen = fds_[i + 1].revents;
    if (seen != 0) fd_owners_[i]->is_ready = true;
    if ((seen & (POLLERR | POLLHUP | POLLNVAL)) != 0) fd_owners_[i]->has_error = true;
  }
}

void PadIo::take_pads() {
  std::vector<OpenedPad> handed;
  {
    const std::lock_guard lock(mutex_);
    handed.swap(handed_);
  }
  for (OpenedPad& opened : handed) {
    pads_.push_back(std::make_unique<Pad>());
    Pad& pad = *pads_.back();
    pad.opened = std::move(opened);
    announce(pad, ReportKind::added, now_ns_);
  }
}

void PadIo::take_commands() {
  std::deque<std::string> commands;
  {
    const std::lock_guard lock(mutex_);
    commands.swap(commands_);
  }
  for (const std::string& text : commands) {
    Report report;
    make_event(report, ReportKind::command, kNoDevice, now_ns_);
    report.size = static_cast<std::uint16_t>(text.size());
    // A recording holds it as one line; a replay must find the same text.
    std::ranges::replace_copy_if(
        text, report.bytes.begin(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    queue_.push(report, 0);
  }
}

void PadIo::take_motor_wishes() {
  MotorWish wish;
  while (motor_wishes_.pop(wish)) {
    for (auto& pad : pads_) {
      if (pad->opened.index != wish.device) continue;
      const bool is_start = wish.duration_ms > 0;
      if (is_start && !pad->opened.device->rumble(wish.rumble)) continue;
      pad->is_running = pad->is_running || is_start;
      pad->motor_end = Clock::now() + std::chrono::milliseconds(wish.duration_ms);
    }
  }
}

void PadIo::stop_motors(Clock::time_point now) {
  for (auto& pad : pads_) {
    if (!pad->is_running || now < pad->motor_end) continue;
    if (pad->opened.device->rumble({})) {
      pad->is_running = false;
    } else {
      pad->motor_end = now + kStopRetry;
    }
  }
}

void PadIo::read_all() {
  std::vector<std::pair<std::unique_ptr<Pad>, Reading>> ended;
  for (auto& pad : pads_) {
    const Reading how = pad->is_ready ? read(*pad) : Reading::goes_on;
    if (how != Reading::goes_on) ended.emplace_back(std::move(pad), how);
  }
  std::erase(pads_, nullptr);
  for (auto& [pad, how] : ended) end(*pad, how);
}

PadIo::Reading PadIo::read(Pad& pad) {
  Report report;
  for (int i = 0; i < kReadsInRound; ++i) {
    report.kind = ReportKind::input;
    report.size = 0;
    switch (pad.opened.device->read(report)) {
      case Device::Status::report:
        pad.error_wakes = 0;
        deliver(pad, report);
        continue;
      case Device::Status::gone:
        return Reading::unplugged;
      case Device::Status::nothing:
        pad.is_ready = false;
        count_lost(pad);
        return i > 0 ? Reading::goes_on : count_idle_wake(pad);
    }
  }
  count_lost(pad);
  return Reading::goes_on;
}

// A source that is ready all the time and has nothing: an error that it does not understand.
PadIo::Reading PadIo::count_idle_wake(Pad& pad) {
  const Clock::time_point now = Clock::now();
  if (now >= pad.window_end) {
    pad.window_end = now + kIdleWindow;
    pad.idle_wakes = 0;
  }
  ++pad.idle_wakes;
  if (pad.has_error) ++pad.error_wakes;
  if (pad.idle_wakes < kMaxIdleWakes && pad.error_wakes < kMaxErrorWakes) return Reading::goes_on;
  return Reading::failed;
}

void PadIo::deliver(Pad& pad, Report& report) {
  if (report.kind != ReportKind::input) {
    announce(pad, report.kind, report.time_ns);
    return;
  }
  if (report.size > kMaxReportBytes) {
    counters_.lost.fetch_add(1, std::memory_order_relaxed);
    return;
  }
  // A recording needs stamps in order, whatever clock a source may show.
  if (report.time_ns > now_ns_ + kClockSlack_ns) report.time_ns = now_ns_;
  report.time_ns = pad.last_ns = std::max(report.time_ns, pad.last_ns);
  report.device = pad.opened.index;
  const bool has_id = pad.opened.has_report_ids && report.size > 0;
  queue_.push(report, has_id ? report.bytes[0] : 0);
}

// Once each: a recording tells of plugging itself, before it ends.
void PadIo::announce(Pad& pad, ReportKind kind, std::int64_t time_ns) {
  const bool is_present = kind == ReportKind::added;
  if (kind == ReportKind::command || is_present == pad.is_present) return;
  pad.is_present = is_present;
  pad.last_ns = std::max(time_ns, pad.last_ns);
  if (!pad.opened.is_keyboard)
    (is_present ? counters_.plugged : counters_.unplugged).fetch_add(1, std::memory_order_relaxed);
  Report report;
  make_event(report, kind, pad.opened.index, pad.last_ns);
  queue_.push(report, 0);
}

void PadIo::count_lost(Pad& pad) {
  const std::int64_t lost = pad.opened.device->lost();
  counters_.lost.fetch_add(lost - pad.lost, std::memory_order_relaxed);
  pad.lost = lost;
}

void PadIo::end(Pad& pad, Reading how) {
  announce(pad, ReportKind::removed, now_ns_);
  count_lost(pad);
  take_remarks(pad);
  if (how == Reading::failed)
    remarks_.add(pad.opened.name + ": closed, it only reports errors");
  else if (!pad.opened.is_recording)
    remarks_.add(pad.opened.name + ": unplugged");
  gone_(pad.opened.id, std::move(pad.opened.device));
}

void PadIo::take_remarks(Pad& pad) {
  for (const std::string& sentence : pad.opened.device->take_remarks())
    remarks_.add_once(fmt::format("{}: {}", pad.opened.name, sentence));
}

// With real-time priority a thread that never sleeps would leave nothing for the others.
void PadIo::look_after(Clock::time_point now) {
  const std::chrono::nanoseconds busy = processor_time();
  if (busy - busy_ > kMaxBusy * (now - looked_after_)) give_up_priority();
  busy_ = busy;
  looked_after_ = now;
  for (auto& pad : pads_) take_remarks(*pad);
}

}  // namespace gaitpad

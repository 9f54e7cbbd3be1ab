#include "gaitpad/pad_stream.h"

#include <fmt/format.h>
#include <poll.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cerrno>
#include <deque>
#include <limits>
#include <utility>

#include "base/spsc_ring.h"
#include "base/text.h"
#include "drivers/realtime.h"
#include "gaitpad/keyboard.h"
#include "pads/newest_reports.h"
#include "pads/pad_finder.h"
#include "system/threads.h"

namespace gaitpad {
namespace {

using namespace std::chrono_literals;

// --- from the I/O thread to the reader

// The reports of all pads on their way to the one reader: a wait-free ring, and behind it a queue
// for reports that found no room.
//
// A reader that has fallen behind finds first what is in the ring, then the newest state of each
// device: the last input report of each report id. Reports that were left out are counted. Plugging
// and commands are never left out, and the reports of a device stay in their order.
class PadQueue {
 public:
  explicit PadQueue(std::size_t capacity) : ring_(capacity) {}  // a power of two
  bool is_open() const noexcept { return bell_.fd() >= 0; }

  // Called by the I/O thread. `report_id` is 0 if the device has none; device < kMaxPads or
  // kNoDevice.
  void push(const Report& report, std::uint8_t report_id);
  // Moves the waiting reports into the ring. True: none waits any more.
  bool flush();
  bool is_waiting() const noexcept { return !waiting_.empty(); }
  // True if the queue is full: sources must not be read until flush() has made room.
  bool is_blocked() const noexcept { return waiting_.size() >= kMaxWaiting; }
  // Wakes the reader if it sleeps in wait(); one call serves many reports.
  void wake_reader() noexcept;

  // Called by the reader: the oldest report in the ring.
  const Report* front() noexcept { return ring_.front(); }
  void pop() noexcept { ring_.pop(); }
  void wait(std::chrono::milliseconds timeout);

  // Any thread: numbers of reports written to the ring, and of input reports left out.
  std::int64_t written() const noexcept { return written_.load(std::memory_order_relaxed); }
  std::int64_t lost() const noexcept { return lost_.load(std::memory_order_relaxed); }

 private:
  static constexpr std::size_t kMaxWaiting = 8192;
  struct Waiting {
    Report report;
    std::uint8_t report_id;
  };

  bool put(const Report& report) noexcept;
  void hold(const Report& report, std::uint8_t report_id);

  SpscRing<Report> ring_;
  std::deque<Waiting> waiting_;  // its elements keep their addresses
  NewestReports newest_;         // the newest waiting input report of each device and id
  std::atomic<std::int64_t> written_{0}, lost_{0};
  std::atomic<bool> reader_sleeps_{false};
  Bell bell_;
};

bool PadQueue::put(const Report& report) noexcept {
  if (!ring_.push(report)) return false;
  written_.fetch_add(1, std::memory_order_relaxed);
  return true;
}

void PadQueue::push(const Report& report, std::uint8_t report_id) {
  assert(report.device < kMaxPads || report.device == kNoDevice);
  if (!flush() || !put(report)) hold(report, report_id);
}

void PadQueue::hold(const Report& report, std::uint8_t report_id) {
  const bool is_input = report.kind == ReportKind::input;
  const std::uint16_t device = report.device;
  if (is_input) {
    if (Report* older = newest_.find(device, report_id)) {
      *older = report;
      lost_.fetch_add(1, std::memory_order_relaxed);
      return;
    }
  }
  waiting_.push_back({report, report_id});
  if (device == kNoDevice) return;
  if (is_input) {
    newest_.set(device, report_id, &waiting_.back().report);
  } else {
    // Later reports stay behind the plugging, so they replace none before it.
    newest_.forget(device);
  }
}

bool PadQueue::flush() {
  while (!waiting_.empty()) {
    const auto& [report, id] = waiting_.front();
    if (!put(report)) return false;
    if (report.device != kNoDevice && newest_.find(report.device, id) == &report)
      newest_.set(report.device, id, nullptr);
    waiting_.pop_front();
  }
  return true;
}

// The second of two threads that change `reader_sleeps_` sees everything that the first wrote
// before its change, so no wake-up is missed.
void PadQueue::wake_reader() noexcept {
  if (reader_sleeps_.exchange(false, std::memory_order_acq_rel)) bell_.ring();
}

void PadQueue::wait(std::chrono::milliseconds timeout) {
  bell_.clear();
  reader_sleeps_.exchange(true, std::memory_order_acq_rel);
  if (ring_.front() == nullptr) {
    pollfd bell{bell_.fd(), POLLIN, 0};
    ::poll(&bell, 1, static_cast<int>(timeout.count()));
  }
  reader_sleeps_.exchange(false, std::memory_order_acq_rel);
}

// Pads that the reader does not know yet, each pushed before its first `added`. The receiver of a
// pointer owns it.
using Introductions = SpscRing<KnownPad*>;

struct PadCounters {
  std::atomic<std::int64_t> lost{0};  // reports that the sources have lost
  std::atomic<std::int64_t> plugged{0}, unplugged{0};
};

// --- the I/O thread

// Most reports that are read from one device before the others get their turn.
constexpr int kReadsInRound = 64;
// Close a device that wakes this thread more often without a report: it would keep the thread busy
// all the time. SDL wakes it once each millisecond.
constexpr int kMaxIdleWakes = 500;
constexpr auto kIdleWindow = 100ms;
constexpr int kMaxErrorWakes = 200;  // most wakes with an error between two reports
constexpr auto kRoomPoll = 2ms;      // wait between two attempts to write to a full ring
constexpr auto kMaxRumble = 10s;     // longest rumble; a longer request is a mistake of the caller
// Wait until the stop of a motor is sent again, if it could not be sent.
constexpr auto kStopRetry = 20ms;
// How often the thread measures its own processor time, and the share of the time above which it
// gives up its real-time priority.
constexpr auto kWatch = 500ms;
constexpr double kMaxBusy = 0.8;
constexpr std::size_t kMaxCommands = 1024;
constexpr std::int64_t kClockSlack_ns = 1'000'000'000;
// A pad counts as one without a stick after this time and this number of reports: a pad that
// reports changes only may send a few reports of other kinds before its stick is touched.
constexpr std::int64_t kStickWait_ns = 1'000'000'000;
constexpr int kMinStickless = 20;

std::int64_t nanoseconds(std::chrono::steady_clock::time_point time) {
  return std::chrono::nanoseconds(time.time_since_epoch()).count();
}

// Makes `report` one without content. Its bytes are not cleared, because they are many and are not
// read.
void make_event(Report& report, ReportKind kind, std::uint16_t device, std::int64_t time_ns) {
  report.time_ns = time_ns;
  report.device = device;
  report.kind = kind;
  report.size = 0;
}

// Reads all open devices, stamps and orders their reports, sets motors, and gives back the devices
// that are gone.
class PadIo {
 public:
  // Called on the I/O thread; closes the device on another one: giving a pad back to the kernel
  // takes up to half a second, in which the other pads must be read.
  using GiveBack = std::function<void(std::uint64_t id, std::unique_ptr<Device> device)>;
  using TellStickless = std::function<void(std::uint64_t id, const std::string& sentence)>;
  PadIo(PadQueue& queue, Introductions& introductions, PadCounters& counters, Remarks& remarks,
        GiveBack give_back, TellStickless tell_stickless)
      : queue_(queue),
        introductions_(introductions),
        counters_(counters),
        remarks_(remarks),
        give_back_(std::move(give_back)),
        tell_stickless_(std::move(tell_stickless)) {}
  ~PadIo() { stop(); }
  bool is_open() const noexcept { return bell_.fd() >= 0; }
  void start();
  void stop();  // Ends the thread and closes the devices that are still open.

  void take_over(OpenedPad pad);        // Any thread.
  void release(std::uint64_t id);       // Any thread. Gives this opening back, if it is still open.
  void command(std::string_view text);  // Any thread.
  std::int64_t commands_left_out() const noexcept {
    return commands_left_out_.load(std::memory_order_relaxed);
  }
  void rumble(std::uint16_t device, const Rumble& rumble,
              std::chrono::milliseconds duration) noexcept;  // Call it from one thread; it does not
                                                             // wait.

 private:
  using Clock = std::chrono::steady_clock;
  struct Pad {
    OpenedPad opened;
    bool is_ready = true;      // the device may have something to read
    bool is_present = false;   // the pad is plugged in, as was announced last
    std::int64_t last_ns = 0;  // stamp of the last report; stamps of one device never decrease
    std::int64_t lost = 0;     // the device's count of lost reports when it was read last
    bool is_running = false;   // the motors run
    Clock::time_point motor_end;
    // Counts of wakes with nothing to read: within the running window, and with an error since the
    // last report.
    int idle_wakes = 0, error_wakes = 0;
    bool has_error = false;  // the last poll() reported an error
    Clock::time_point window_end;
    // No report of the pad has contained a stick yet.
    bool is_stick_awaited = true;
    int stickless = 0;
    std::int64_t stickless_since_ns = 0;
  };
  struct MotorRequest {
    std::uint16_t device;
    Rumble rumble;
    std::int32_t duration_ms;
  };
  enum class Reading { goes_on, unplugged, failed, released };

  void run();
  int timeout_ms(Clock::time_point now) const;
  void wait_for_fds();
  void take_pads();
  void take_releases();
  void take_commands();
  void take_motor_requests();
  void stop_motors(Clock::time_point now);
  void read_all();
  Reading read(Pad& pad);
  Reading count_idle_wake(Pad& pad);
  void deliver(Pad& pad, Report& report);
  void await_stick(Pad& pad, const Report& report);
  void introduce(Pad& pad);
  void announce(Pad& pad, ReportKind kind, std::int64_t time_ns);
  void count_lost(Pad& pad);
  void end(Pad& pad, Reading how);
  void take_remarks(Pad& pad);
  void watch_itself(Clock::time_point now);

  PadQueue& queue_;
  Introductions& introductions_;
  PadCounters& counters_;
  Remarks& remarks_;
  const GiveBack give_back_;
  const TellStickless tell_stickless_;

  Bell bell_;
  std::atomic<bool> is_ending_{false};
  std::mutex mutex_;  // guards the three members below
  std::vector<OpenedPad> handed_;
  std::vector<std::uint64_t> released_;
  std::deque<std::string> commands_;
  std::atomic<std::int64_t> commands_left_out_{0};
  SpscRing<MotorRequest> motor_requests_{64};

  // Used by the I/O thread only.
  std::vector<std::unique_ptr<Pad>> pads_;
  std::vector<pollfd> fds_;
  std::vector<Pad*> fd_owners_;  // owners of fds_ from the second element on
  std::int64_t now_ns_ = 0;      // the time after the last wait
  Clock::time_point watched_;
  std::chrono::nanoseconds busy_{0};  // the thread's processor time at `watched_`
  std::thread thread_;
};

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

void PadIo::release(std::uint64_t id) {
  {
    const std::lock_guard lock(mutex_);
    released_.push_back(id);
  }
  bell_.ring();
}

void PadIo::command(std::string_view text) {
  // An empty command is left out, because a recording cannot hold it.
  if (trimmed(text, " \t\r\n").empty()) return;
  if (text.size() > kMaxReportBytes) {
    commands_left_out_.fetch_add(1, std::memory_order_relaxed);
    remarks_.add_once(fmt::format("a command of {} bytes was left out, {} can be taken",
                                  text.size(), kMaxReportBytes));
    return;
  }
  {
    const std::lock_guard lock(mutex_);
    if (commands_.size() >= kMaxCommands) {
      commands_left_out_.fetch_add(1, std::memory_order_relaxed);
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
  if (motor_requests_.push({device, rumble, static_cast<std::int32_t>(ms)})) bell_.ring();
}

void PadIo::run() {
  // If the priority is refused, the loop thread tells the user.
  static_cast<void>(take_priority(RealtimeRank::pads));
  while (!is_ending_) {
    wait_for_fds();
    if ((fds_[0].revents & POLLIN) != 0) {
      bell_.clear();
      take_pads();
      take_releases();
      take_commands();
      take_motor_requests();
    }
    if (!queue_.is_blocked()) read_all();
    queue_.flush();
    queue_.wake_reader();
    const Clock::time_point now = Clock::now();
    stop_motors(now);
    if (now - watched_ >= kWatch) watch_itself(now);
  }
  for (auto& pad : pads_) {
    if (pad->is_running) pad->opened.device->rumble({});
  }
  pads_.clear();
  const std::lock_guard lock(mutex_);
  handed_.clear();
}

// Time until the next motor must stop or the full ring is tried again; -1: no limit.
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
    pad.is_stick_awaited = !pad.opened.is_raw;
    introduce(pad);
    announce(pad, ReportKind::added, now_ns_);
  }
}

void PadIo::take_releases() {
  std::vector<std::uint64_t> released;
  {
    const std::lock_guard lock(mutex_);
    released.swap(released_);
  }
  for (const std::uint64_t id : released) {
    const auto at = std::ranges::find_if(pads_, [id](const auto& p) { return p->opened.id == id; });
    if (at == pads_.end()) continue;
    const std::unique_ptr<Pad> pad = std::move(*at);
    pads_.erase(at);
    end(*pad, Reading::released);
  }
}

// Called before the pad's first `added`, so that the reader finds the pad when it reads that.
void PadIo::introduce(Pad& pad) {
  if (!pad.opened.known) return;
  [[maybe_unused]] const bool has_room = introductions_.push(pad.opened.known.release());
  assert(has_room);  // there is room for one introduction of each index
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
    // A recording holds the text as one line, and a replay must find the same text.
    std::ranges::replace_copy_if(
        text, report.bytes.begin(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
    queue_.push(report, 0);
  }
}

void PadIo::take_motor_requests() {
  MotorRequest request;
  while (motor_requests_.pop(request)) {
    for (auto& pad : pads_) {
      if (pad->opened.index != request.device) continue;
      const bool is_start = request.duration_ms > 0;
      if (is_start && !pad->opened.device->rumble(request.rumble)) continue;
      pad->is_running = pad->is_running || is_start;
      pad->motor_end = Clock::now() + std::chrono::milliseconds(request.duration_ms);
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

// Counts wakes without a report. A source that is always ready but has nothing to read has an error
// that its driver does not know.
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
  // Recordings need stamps in order, even if a source has a wrong clock.
  if (report.time_ns > now_ns_ + kClockSlack_ns) report.time_ns = now_ns_;
  report.time_ns = pad.last_ns = std::max(report.time_ns, pad.last_ns);
  report.device = pad.opened.index;
  if (pad.is_stick_awaited) await_stick(pad, report);
  queue_.push(report, report_id_of(*pad.opened.layout, report));
}

// Warns about a pad whose reports never contain a stick: it would otherwise seem dead.
void PadIo::await_stick(Pad& pad, const Report& report) {
  const ReportLayout* layout = layout_of(*pad.opened.layout, report);
  if (layout != nullptr && tells_stick(*layout)) {
    pad.is_stick_awaited = false;
    return;
  }
  if (pad.stickless++ == 0) pad.stickless_since_ns = report.time_ns;
  if (pad.stickless < kMinStickless || report.time_ns - pad.stickless_since_ns < kStickWait_ns)
    return;
  pad.is_stick_awaited = false;
  const std::uint8_t id = report_id_of(*pad.opened.layout, report);
  tell_stickless_(
      pad.opened.id,
      id == 0 ? pad.opened.name + ": sends reports without a stick"
              : fmt::format("{}: sends reports without a stick (id {:#04x})", pad.opened.name, id));
}

// Announces each change once: a recording contains its own `added` and `removed`.
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
  else if (how == Reading::unplugged && !pad.opened.is_recording)
    remarks_.add(pad.opened.name + ": unplugged");
  give_back_(pad.opened.id, std::move(pad.opened.device));
}

void PadIo::take_remarks(Pad& pad) {
  for (const std::string& sentence : pad.opened.device->take_remarks())
    remarks_.add_once(fmt::format("{}: {}", pad.opened.name, sentence));
}

// Gives the priority up if the thread is too busy: a thread with real-time priority that never
// sleeps would leave no time for the others.
void PadIo::watch_itself(Clock::time_point now) {
  const std::chrono::nanoseconds busy(thread_time_ns());
  if (busy - busy_ > kMaxBusy * (now - watched_)) give_up_priority();
  busy_ = busy;
  watched_ = now;
  for (auto& pad : pads_) take_remarks(*pad);
}

// --- the stream

// A calibration without dead zones, because keys are exact.
CalibrationFile keyboard_calibration() {
  CalibrationFile file;
  file.name = "keyboard";
  for (StickCalibration* stick : {&file.calibration.left, &file.calibration.right}) {
    stick->shape = ZoneShape::radial;
    stick->inner = stick->sideways = 0.0;
    stick->outer = 1.0;
  }
  return file;
}

struct Keyboard {
  std::unique_ptr<Device> device;
  std::unique_ptr<KnownPad> known = std::make_unique<KnownPad>();
};

Result<std::optional<Keyboard>> opened_keyboard(const PadStreamOptions& options) {
  if (!options.keyboard) return std::optional<Keyboard>();
  auto device = open_keyboard(options.keyboard);
  if (!device) return device.error();
  const CalibrationFile calibration = keyboard_calibration();
  Keyboard keyboard;
  keyboard.device = std::move(*device);
  KnownPad& known = *keyboard.known;
  known.device.info = keyboard.device->info();
  known.device.calibration = calibration_text(calibration);
  auto config = pad_config(options.files, known.device.info, calibration, "keyboard");
  if (!config) return config.error();
  config->is_present = false;  // true as soon as the reader has taken `added`
  known.config = std::move(*config);
  known.layout = known.config.layout;
  return std::optional<Keyboard>(std::move(keyboard));
}

}  // namespace

// Members are destroyed from the last to the first: first the finder, so that nothing more is
// opened, then the I/O thread, which closes the open devices.
struct PadStream::Impl {
  Impl(PadStreamOptions options, const std::optional<Keyboard>& keyboard)
      : queue(options.ring_reports),
        io(
            queue, introductions, counters, remarks,
            [this](std::uint64_t id, std::unique_ptr<Device> device) {
              finder.take_back(id, std::move(device));
            },
            [this](std::uint64_t id, const std::string& sentence) {
              finder.tell_stickless(id, sentence);
            }),
        finder(
            {std::move(options.files), std::move(options.selector), options.drivers, options.is_raw,
             options.changes_fd,
             keyboard ? std::optional(keyboard->known->device.info) : std::nullopt},
            [this](OpenedPad pad) { io.take_over(std::move(pad)); },
            [this](std::uint64_t id) { io.release(id); }, remarks) {}
  ~Impl();
  void take_over(Keyboard keyboard);
  void take_introduction(std::uint16_t device) noexcept;

  PadQueue queue;
  Introductions introductions{kMaxPads};
  std::array<std::unique_ptr<KnownPad>, kMaxPads> known;  // used by the reader only
  PadCounters counters;
  Remarks remarks;
  PadIo io;
  PadFinder finder;
};

PadStream::Impl::~Impl() {
  finder.stop();
  io.stop();
  for (KnownPad* unread = nullptr; introductions.pop(unread);) delete unread;
}

// Called before the threads run, so that the keyboard is announced first.
void PadStream::Impl::take_over(Keyboard keyboard) {
  OpenedPad opened;
  opened.device = std::move(keyboard.device);
  opened.layout = keyboard.known->layout;
  opened.known = std::move(keyboard.known);
  opened.is_keyboard = true;
  opened.name = "keyboard";
  io.take_over(std::move(opened));
}

// Introductions are in the order of the first `added` reports.
void PadStream::Impl::take_introduction(std::uint16_t device) noexcept {
  KnownPad* pad = nullptr;
  [[maybe_unused]] const bool is_there = introductions.pop(pad);
  assert(is_there);
  known[device].reset(pad);
}

PadStream::PadStream() = default;
PadStream::~PadStream() = default;

std::optional<Error> check(const PadStreamOptions& options) {
  if (options.files.calibration) {
    if (auto problem = check(*options.files.calibration))
      return Error{"PadStreamOptions: files: " + problem->message};
  }
  if (options.changes_fd < -1) {
    return Error{fmt::format("PadStreamOptions: changes_fd is {}, outside [-1, {}]",
                             options.changes_fd, std::numeric_limits<int>::max())};
  }
  if (!std::has_single_bit(options.ring_reports) || options.ring_reports > kMostRingReports) {
    return Error{fmt::format("PadStreamOptions: ring_reports is {}, not a power of two in [1, {}]",
                             options.ring_reports, kMostRingReports)};
  }
  return std::nullopt;
}

Result<std::unique_ptr<PadStream>> PadStream::start(PadStreamOptions options) {
  if (auto problem = check(options)) return *problem;
  auto keyboard = opened_keyboard(options);
  if (!keyboard) return keyboard.error();
  std::unique_ptr<PadStream> stream(new PadStream());
  stream->impl_ = std::make_unique<Impl>(std::move(options), *keyboard);
  Impl& impl = *stream->impl_;
  if (!impl.queue.is_open() || !impl.io.is_open())
    return Error{"no file descriptors are left for pads"};
  if (*keyboard) impl.take_over(std::move(**keyboard));
  impl.io.start();
  if (auto problem = impl.finder.start()) return *problem;
  return stream;
}

const Report* PadStream::front() noexcept {
  const Report* oldest = impl_->queue.front();
  if (oldest != nullptr && oldest->kind == ReportKind::added && !impl_->known[oldest->device])
    impl_->take_introduction(oldest->device);
  return oldest;
}
void PadStream::pop() noexcept { impl_->queue.pop(); }
void PadStream::wait(std::chrono::milliseconds timeout) { impl_->queue.wait(timeout); }

const TraceDevice& PadStream::device(std::uint16_t index) const noexcept {
  assert(index < kMaxPads && impl_->known[index]);
  return impl_->known[index]->device;
}
const PadLayout& PadStream::layout(std::uint16_t index) const noexcept {
  assert(index < kMaxPads && impl_->known[index]);
  return *impl_->known[index]->layout;
}
PadConfig PadStream::take_config(std::uint16_t index) noexcept {
  assert(index < kMaxPads && impl_->known[index]);
  return std::move(impl_->known[index]->config);
}

void PadStream::rumble(std::uint16_t device, const Rumble& rumble,
                       std::chrono::milliseconds duration) noexcept {
  impl_->io.rumble(device, rumble, duration);
}
void PadStream::command(std::string_view text) { impl_->io.command(text); }

bool PadStream::has_ended() const noexcept { return impl_->finder.has_ended(); }

PadStreamCounts PadStream::counts() const noexcept {
  PadStreamCounts counts;
  counts.reports = impl_->queue.written();
  counts.lost = impl_->queue.lost() + impl_->counters.lost.load(std::memory_order_relaxed);
  counts.plugged = impl_->counters.plugged.load(std::memory_order_relaxed);
  counts.commands_left_out = impl_->io.commands_left_out();
  counts.unplugged = impl_->counters.unplugged.load(std::memory_order_relaxed);
  return counts;
}

std::vector<std::string> PadStream::take_remarks() { return impl_->remarks.take_all(); }

}  // namespace gaitpad

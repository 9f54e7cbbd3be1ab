#include "tools/gaitpad/replay_to.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "base/files.h"
#include "drivers/uhid_device.h"
#include "drivers/virtual_pad.h"
#include "gaitpad/pad_configuration.h"
#include "gaitpad/trace.h"
#include "hid/evemu.h"
#include "session/pad_forward.h"
#include "terminal/run_end.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

// Longest wait until the kernel's driver has begun.
constexpr std::int64_t kBinding_ns = 5'000'000'000;
// During the last 2 ms before an event the program only sleeps, so that it wakes on time.
constexpr std::int64_t kNear_ns = 2'000'000;

// Virtual devices with the recorded descriptors and ids.
class UhidDevices {
 public:
  explicit UhidDevices(const std::vector<TraceDevice>& recorded)
      : recorded_(recorded), devices_(recorded.size()) {}

  std::optional<Error> plug(std::size_t device) {
    if (devices_[device]) return std::nullopt;
    auto made = UhidDevice::create(recorded_[device].info);
    if (!made) return made.error();
    devices_[device].emplace(std::move(*made));
    return std::nullopt;
  }
  std::vector<pollfd> fds() const {
    std::vector<pollfd> fds;
    for (const auto& device : devices_) {
      if (device) fds.push_back(device->fd());
    }
    return fds;
  }
  void answer() {
    for (auto& device : devices_) {
      if (device) device->answer();
    }
  }
  bool are_bound() const {
    return std::ranges::all_of(devices_, [](const auto& d) { return !d || d->is_bound(); });
  }
  std::optional<Error> take(const Report& report) {
    if (report.kind == ReportKind::added) return plug(report.device);
    auto& device = devices_[report.device];
    if (report.kind == ReportKind::removed) device.reset();
    if (report.kind != ReportKind::input || !device) return std::nullopt;
    if (device->send({report.bytes.data(), report.size})) return std::nullopt;
    return Error{printable(recorded_[report.device].info.name) +
                 ": the kernel refuses its reports"};
  }

 private:
  const std::vector<TraceDevice>& recorded_;
  std::vector<std::optional<UhidDevice>> devices_;
};

// Waits until that time. False: the user ended it earlier.
bool wait_until(std::int64_t time_ns, RunEnd& end, UhidDevices* devices = nullptr) {
  while (!end.is_reached()) {
    const std::int64_t left_ns = time_ns - now_ns();
    if (left_ns <= 0) return true;
    if (left_ns > kNear_ns) {
      const std::chrono::nanoseconds left(left_ns - kNear_ns / 2);
      const std::vector<pollfd> fds = devices ? devices->fds() : std::vector<pollfd>();
      end.wait(std::chrono::duration_cast<std::chrono::milliseconds>(left), fds);
    } else {
      std::this_thread::sleep_for(std::chrono::nanoseconds(left_ns));
    }
    if (devices != nullptr) devices->answer();
  }
  return false;
}

std::int64_t nanoseconds(double seconds) { return static_cast<std::int64_t>(seconds * 1e9); }

// Plays to uhid and returns the number of played reports. Waits at the end, so that readers of the
// device see the last reports before it is removed.
Result<std::int64_t> play_to_uhid(const Trace& trace, double delay_s, RunEnd& end) {
  UhidDevices devices(trace.devices);
  for (std::size_t i = 0; i < trace.devices.size(); ++i) {
    if (auto problem = devices.plug(i)) return *problem;
  }
  for (const std::int64_t patience_ns = now_ns() + kBinding_ns;
       !devices.are_bound() && now_ns() < patience_ns;) {
    if (!wait_until(now_ns() + kNear_ns, end, &devices)) break;
  }
  const std::int64_t start_ns = now_ns() + nanoseconds(delay_s);
  std::int64_t reports = 0;
  Report report;
  for (const TraceEvent& event : trace.events) {
    if (event.device == kNoDevice) continue;  // the event is a command to gaitpad, not a report
    const std::int64_t time_ns = (event.time_us - trace.events.front().time_us) * 1000;
    if (!wait_until(start_ns + time_ns, end, &devices)) break;
    copy_report(trace, event, report);
    if (auto problem = devices.take(report)) return *problem;
    if (report.kind == ReportKind::input) ++reports;
  }
  wait_until(now_ns() + nanoseconds(delay_s), end, &devices);
  return reports;
}

// Plays to uinput, tick by tick as `play --forward` does.
Result<std::int64_t> play_to_uinput(const SessionSpec& spec, Trace trace, double delay_s,
                                    RunEnd& end) {
  const int rate_hz = replay_rate_hz(trace, spec.rate_hz);
  const auto files = load_pad_files(spec);
  if (!files) return files.error();
  auto configs = pad_configs(*files, trace.devices, trace.path);
  if (!configs) return configs.error();
  if (std::ranges::none_of(*configs, &PadConfig::is_usable))
    return Error{trace.path + ": none of its devices is a pad"};
  const auto ticks = assign_ticks(trace, rate_hz);
  if (!ticks) return ticks.error();
  auto pad = XboxPad::create();
  if (!pad) return pad.error();
  print_remarks(kReplayCommand, {"it plays to " + pad->node()});
  Pads pads(std::move(*configs), rate_hz);
  const std::int64_t start_ns = now_ns() + nanoseconds(delay_s);
  std::int64_t reports = 0;
  ForwardedTick sent;
  Report report;
  auto event = trace.events.begin();
  for (std::int64_t tick = 0; tick < *ticks; ++tick) {
    if (!wait_until(start_ns + tick * 1'000'000'000 / rate_hz, end)) break;
    for (; event != trace.events.end() && event->tick <= tick; ++event) {
      if (event->device == kNoDevice) continue;
      copy_report(trace, *event, report);
      if (report.kind == ReportKind::added) pads.add_pad(report.device);
      if (report.kind == ReportKind::removed) pads.remove_pad(report.device);
      if (report.kind != ReportKind::input) continue;
      pads.take_report(report);
      ++reports;
    }
    const ForwardedTick now = forwarded_tick(pads, pads.finish_tick());
    if (!pad->set(between(sent, now)) || !pad->set(now.state))
      return Error{pad->node() + ": the kernel refuses its events"};
    sent = now;
  }
  wait_until(now_ns() + nanoseconds(delay_s), end);
  return reports;
}

}  // namespace

std::string target_problem(const std::string& target) {
  if (target == "uinput" || target == "uhid" || target.ends_with(".evemu")) return {};
  return fmt::format("{}: uinput, uhid or a file that ends with .evemu was expected", target);
}

int replay_to(const SessionSpec& spec, const ReplayTo& to) {
  RunEnd end;
  const auto trace = read_trace(spec.replay.trace, spec.replay.damage);
  if (!trace) return fail(kReplayCommand, trace.error().message);
  if (to.target.ends_with(".evemu")) {
    const auto text = evemu_text(*trace);
    if (!text) return fail(kReplayCommand, text.error().message);
    if (const auto problem = write_file(to.target, *text))
      return fail(kReplayCommand, problem->message);
    fmt::print("{}\n", printable(to.target));
    return 0;
  }
  const auto reports = to.target == "uhid" ? play_to_uhid(*trace, to.delay_s, end)
                                           : play_to_uinput(spec, *trace, to.delay_s, end);
  if (!reports) return fail(kReplayCommand, reports.error().message);
  fmt::print("{}: {} reports to {}\n", printable(spec.replay.trace), *reports, to.target);
  return 0;
}

}  // namespace gaitpad

#include "tools/gaitpad/replay_to.h"

#include <fmt/format.h>

#include <chrono>
#include <thread>
#include <utility>
#include <vector>

#include "drivers/uhid_device.h"
#include "drivers/virtual_pad.h"
#include "gaitpad/trace.h"
#include "hid/evemu.h"
#include "session/timed_replay.h"
#include "system/whole_file.h"
#include "terminal/run_end.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

// Longest wait until the kernel's driver has begun.
constexpr std::int64_t kBinding_ns = 5'000'000'000;
// During the last 2 ms before an event the program only sleeps, so that it wakes on time.
constexpr std::int64_t kNear_ns = 2'000'000;

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
  if (auto problem = devices.plug_all()) return *problem;
  const auto wait = [&](std::int64_t time_ns) { return wait_until(time_ns, end, &devices); };
  for (const std::int64_t patience_ns = now_ns() + kBinding_ns;
       !devices.are_bound() && now_ns() < patience_ns;) {
    if (!wait(now_ns() + kNear_ns)) break;
  }
  const auto reports =
      play_reports(trace, now_ns() + nanoseconds(delay_s), wait,
                   [&devices](const Report& report) { return devices.take(report); });
  if (reports) wait(now_ns() + nanoseconds(delay_s));
  return reports;
}

// Plays to uinput, tick by tick as `play --forward` does.
Result<std::int64_t> play_to_uinput(const SessionSpec& spec, Trace trace, double delay_s,
                                    RunEnd& end) {
  auto replay = ticked_replay(spec, std::move(trace));
  if (!replay) return replay.error();
  auto pad = XboxPad::create();
  if (!pad) return pad.error();
  print_remarks(kReplayCommand, {"it plays to " + pad->node()});
  const auto wait = [&end](std::int64_t time_ns) { return wait_until(time_ns, end); };
  const auto reports = play_ticks(*replay, now_ns() + nanoseconds(delay_s), wait,
                                  [&pad](const VirtualPadState& state) { return pad->set(state); });
  if (!reports) return Error{pad->node() + ": the kernel refuses its events"};
  wait(now_ns() + nanoseconds(delay_s));
  return *reports;
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

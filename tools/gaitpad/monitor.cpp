// gaitpad monitor [PAD]: sticks, buttons, rate and latency of live pads in the terminal.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <future>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/numeric.h"
#include "gaitpad/calibration.h"
#include "gaitpad/pad_stream.h"
#include "stick/new_values.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"
#include "tools/gaitpad/run_end.h"
#include "tools/gaitpad/terminal.h"

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

// --- a pad as it is shown: position, buttons, and how regularly its reports come

// What came within one second.
struct Window {
  double duration_s = 1.0;
  std::int64_t reports = 0, bad_reports = 0;
  std::vector<double> interval_us, latency_us;
  std::vector<double> frame_us;  // from the report to the line that shows it, on a terminal
};

struct MonitoredPad {
  PadConfig config;
  PadState state;
  JumpFilter filter;
  NewValueCount new_values;
  std::array<UntouchedWatch, 2> watch;  // left, right
  int untouched = 0;                    // how often a stick moved by itself
  bool is_warned = false;               // of that
  bool is_plugged = true;
  std::optional<Battery> battery;
  std::future<std::optional<Battery>> asked_battery;  // the kernel may wait for the pad
  std::int64_t battery_ns = 0;                        // when it was asked last; 0: never
  std::int64_t last_ns = 0;              // stamp of the last report; 0: none since plugging in
  Window running, shown;                 // the present second, and the last full one
  std::vector<std::int64_t> unshown_ns;  // stamps of the reports since the last line
};
using MonitoredPads = std::map<std::uint16_t, MonitoredPad>;

constexpr std::size_t kMaxKept = 20000;  // times of one second that are looked at

template <class T>
void keep(std::vector<T>& values, T value) {
  if (values.size() < kMaxKept) values.push_back(value);
}
double greatest(const std::vector<double>& values) {
  return values.empty() ? 0.0 : *std::ranges::max_element(values);
}
// Standard deviation of the intervals.
double jitter(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  double sum = 0.0, squares = 0.0;
  for (double v : values) sum += v;
  const double mean = sum / static_cast<double>(values.size());
  for (double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

double rate_hz(const Window& window) {
  return static_cast<double>(window.reports) / window.duration_s;
}

Stick stick_of(const MonitoredPad& pad) {
  const Calibration& calibration = pad.config.calibration;
  return stick_position(calibration, pad.filter.filtered(calibration, pad.state));
}

struct Triggers {
  double left, right;
};
Triggers triggers_of(const MonitoredPad& pad) {
  const Calibration& c = pad.config.calibration;
  return {trigger_position(c.left_trigger, pad.state.axis[kLeftTrigger]),
          trigger_position(c.right_trigger, pad.state.axis[kRightTrigger])};
}

std::string pad_name(const DeviceInfo& info) {
  return fmt::format("{} ({})", printable(info.name),
                     info.driver.empty() ? "recording" : info.driver);
}

// Whose calibration is in force: `PAD (DRIVER): calibration "NAME"`.
std::string calibration_remark(const TraceDevice& device) {
  const auto file = parse_calibration(device.calibration, "");
  const std::string name = file ? printable(file->name) : "";
  return fmt::format("{}: calibration \"{}\"", pad_name(device.info),
                     name.empty() ? "without a name" : name);
}

void watch_sticks(MonitoredPad& pad, std::int64_t time_ns) {
  const Calibration& c = pad.config.calibration;
  const Stick stick = stick_of(pad);
  const auto& axis = pad.state.axis;
  pad.untouched += pad.watch[0].take(time_ns, c.left, {axis[kLeftX], axis[kLeftY]}, stick.left);
  pad.untouched += pad.watch[1].take(time_ns, c.right, {axis[kRightX], axis[kRightY]}, stick.right);
}

// Once a minute.
void look_at_battery(MonitoredPad& pad, const DeviceInfo& info, std::int64_t time_ns) {
  constexpr std::int64_t kMinuteNs = 60'000'000'000;
  if (pad.battery_ns == 0 || time_ns >= pad.battery_ns + kMinuteNs) {
    pad.battery_ns = time_ns;
    pad.asked_battery = std::async(std::launch::async, [info] { return battery_of(info); });
  }
  using namespace std::chrono_literals;
  if (pad.asked_battery.valid() && pad.asked_battery.wait_for(0s) == std::future_status::ready)
    pad.battery = pad.asked_battery.get();
}

// A pad that reports changes only is silent while its sticks stand still.
void take_silence(MonitoredPad& pad) {
  const std::int64_t time_ns = now_ns();
  const double silent_s = 1e-9 * static_cast<double>(time_ns - pad.last_ns);
  if (pad.last_ns == 0 || silent_s < JumpFilter::kSettled_s) return;
  pad.filter.settle();
  watch_sticks(pad, time_ns);
}

// Takes one report of the stream in. True if it announces a pad for the first time.
bool take_report(const Report& report, PadStream& stream, MonitoredPads& pads) {
  if (report.device == kNoDevice) return false;
  if (report.kind == ReportKind::added) {
    auto [pad, is_first] = pads.try_emplace(report.device);
    if (is_first) pad->second.config = stream.take_config(report.device);
    pad->second.is_plugged = true;
    return is_first;
  }
  const auto found = pads.find(report.device);
  if (found == pads.end()) return false;
  MonitoredPad& pad = found->second;
  if (report.kind == ReportKind::removed) {
    pad.is_plugged = false;
    pad.state = {};
    pad.filter = {};
    pad.new_values = {};
    pad.watch = {};
    pad.last_ns = 0;
    return false;
  }
  keep(pad.running.latency_us, static_cast<double>(now_ns() - report.time_ns) / 1e3);
  if (pad.last_ns != 0)
    keep(pad.running.interval_us, static_cast<double>(report.time_ns - pad.last_ns) / 1e3);
  pad.last_ns = report.time_ns;
  keep(pad.unshown_ns, report.time_ns);
  ++pad.running.reports;
  if (!decode(*pad.config.layout, report, pad.state)) {
    ++pad.running.bad_reports;
  } else {
    pad.filter.take(pad.state);
    const auto& axis = pad.state.axis;
    pad.new_values.take(report.time_ns, {axis[kLeftX], axis[kLeftY]},
                        {axis[kRightX], axis[kRightY]});
    watch_sticks(pad, report.time_ns);
  }
  return false;
}

// While a stick moved, since the pad was plugged in.
ordered_json movement_json(const NewValueCount& new_values) {
  const auto rate = new_values.rate();
  if (!rate) return nullptr;
  return {{"rate_hz", rate->report_hz},
          {"new_values_hz", rate->new_value_hz},
          {"repeats", rate->repeats()}};
}

ordered_json pad_json(std::uint16_t index, const MonitoredPad& pad, const PadStream& stream,
                      double time_s) {
  const DeviceInfo& info = stream.device(index).info;
  const Stick stick = stick_of(pad);
  const Triggers triggers = triggers_of(pad);
  const Window& w = pad.shown;
  return {{"device", index},
          {"name", info.name},
          {"driver", info.driver},
          {"time_s", time_s},
          {"plugged", pad.is_plugged},
          {"rate_hz", rate_hz(w)},
          {"moving", movement_json(pad.new_values)},
          {"interval_us_median", median(w.interval_us)},
          {"jitter_us", jitter(w.interval_us)},
          {"longest_gap_us", greatest(w.interval_us)},
          {"latency_us_median", median(w.latency_us)},
          {"latency_us_p99", percentile(w.latency_us, 99)},
          {"latency_us_max", greatest(w.latency_us)},
          {"bad_reports", w.bad_reports},
          {"lost", stream.counts().lost},
          {"axes", axes_json(pad.state)},
          {"sticks",
           {{"left", {stick.left.x, stick.left.y}}, {"right", {stick.right.x, stick.right.y}}}},
          {"untouched", pad.untouched},
          {"triggers", {{"left", triggers.left}, {"right", triggers.right}}},
          {"buttons", button_names(pad.state)},
          {"battery", battery_json(pad.battery)}};
}

// What a pad shows: one line, or three where the terminal is too narrow for it.
struct PadLine {
  std::string sticks, times, who;
};
const PadLine kHeader = {"left         right        triggers     Hz jitter   gap ms",
                         "  new  same latency max us frame p99 ms lost", "buttons, pad"};

void add_lines(const PadLine& pad, std::size_t columns, std::vector<std::string>& lines) {
  std::string line = fmt::format("{} {} {}", pad.sticks, pad.times, pad.who);
  if (columns >= 122 || pad.times.empty()) {
    lines.push_back(std::move(line));
  } else {
    lines.insert(lines.end(), {pad.sticks, "  " + pad.times, "  " + pad.who});
  }
}

std::string frame_text(const Window& window, std::size_t percent) {
  if (window.frame_us.empty()) return "-";
  return fmt::format("{:.1f}", percentile(window.frame_us, percent) / 1e3);
}

// New positions a second while a stick moved, and the share of reports that repeat one.
std::string movement_text(const NewValueCount& new_values) {
  const auto rate = new_values.rate();
  if (!rate) return fmt::format("{:>5} {:>5}", "-", "-");
  return fmt::format("{:>5.0f} {:>3.0f} %", rate->new_value_hz, 100.0 * rate->repeats());
}

PadLine pad_text(std::uint16_t index, const MonitoredPad& pad, const PadStream& stream) {
  const std::string who = pad_name(stream.device(index).info);
  if (!pad.is_plugged) return {"unplugged:", "", who};
  const Stick stick = stick_of(pad);
  const Triggers triggers = triggers_of(pad);
  const Window& w = pad.shown;
  std::string buttons;
  for (const std::string& name : button_names(pad.state)) buttons += name + " ";
  std::string battery;
  if (pad.battery)
    battery = pad.battery->percent ? fmt::format(", battery {} %", *pad.battery->percent)
                                   : ", battery " + pad.battery->level;
  return {fmt::format("{:+.2f} {:+.2f}  {:+.2f} {:+.2f}  {:.2f} {:.2f}  {:>5.0f} {:>6.2f} {:>8.1f}",
                      stick.left.x, stick.left.y, stick.right.x, stick.right.y, triggers.left,
                      triggers.right, rate_hz(w), jitter(w.interval_us) / 1e3,
                      greatest(w.interval_us) / 1e3),
          fmt::format("{} {:>7.0f} {:>6.0f} {:>5} {:>6} {:>4}", movement_text(pad.new_values),
                      median(w.latency_us), greatest(w.latency_us), frame_text(w, 50),
                      frame_text(w, 99), stream.counts().lost),
          buttons + who + battery};
}

// The line with these reports has just been written.
void note_shown(MonitoredPads& pads) {
  const std::int64_t time_ns = now_ns();
  for (auto& [index, pad] : pads) {
    for (const std::int64_t report_ns : std::exchange(pad.unshown_ns, {}))
      keep(pad.running.frame_us, static_cast<double>(time_ns - report_ns) / 1e3);
  }
}

// --- the command

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kRewriteNs = kSecondNs / 60;

struct MonitorArguments {
  PadWish wish;
  std::string map, calibration;
  double seconds = 0.0;
  bool as_json = false;
};

// Shows a line or a JSON object for each pad: in place on a terminal, else once a second.
class Display {
 public:
  explicit Display(const MonitorArguments& arguments)
      : as_json_(arguments.as_json), is_rewritten_(!as_json_ && line_.is_terminal()) {}
  StatusLine& line() { return line_; }

  void show(MonitoredPads& pads, const PadStream& stream) {
    const std::int64_t time_ns = now_ns();
    if (time_ns >= second_ns_ + kSecondNs) {
      end_second(pads, stream, time_ns);
      if (!is_rewritten_) print(pads, stream, time_ns);
    }
    if (!is_rewritten_ || time_ns < rewritten_ns_ + kRewriteNs) return;
    rewritten_ns_ = time_ns;
    const std::size_t columns = screen_size().columns;
    std::vector<std::string> lines;
    add_lines(kHeader, columns, lines);
    for (const auto& [index, pad] : pads) add_lines(pad_text(index, pad, stream), columns, lines);
    line_.show(lines);
    note_shown(pads);
  }

  // Prints the last second, which is shorter.
  void finish(MonitoredPads& pads, const PadStream& stream) {
    const auto is_news = [](const auto& entry) { return entry.second.running.reports > 0; };
    const std::int64_t time_ns = now_ns();
    if (is_rewritten_ || time_ns <= second_ns_ || std::ranges::none_of(pads, is_news)) return;
    end_second(pads, stream, time_ns);
    print(pads, stream, time_ns);
  }

 private:
  void end_second(MonitoredPads& pads, const PadStream& stream, std::int64_t time_ns) {
    for (auto& [index, pad] : pads) {
      look_at_battery(pad, stream.device(index).info, time_ns);
      pad.shown = std::exchange(pad.running, {});
      pad.shown.duration_s = static_cast<double>(time_ns - second_ns_) / 1e9;
    }
    second_ns_ = time_ns;
  }

  void print(const MonitoredPads& pads, const PadStream& stream, std::int64_t time_ns) {
    for (const auto& [index, pad] : pads) {
      if (as_json_) {
        print_json_line(
            pad_json(index, pad, stream, static_cast<double>(time_ns - start_ns_) / 1e9));
      } else {
        constexpr std::size_t kWhole = 1000;  // one line for each pad
        std::vector<std::string> lines;
        if (!std::exchange(has_header_, true)) add_lines(kHeader, kWhole, lines);
        add_lines(pad_text(index, pad, stream), kWhole, lines);
        for (const std::string& line : lines) fmt::print("{}\n", line);
      }
    }
  }

  StatusLine line_{1};
  bool as_json_, is_rewritten_, has_header_ = false;
  std::int64_t start_ns_ = now_ns(), second_ns_ = start_ns_, rewritten_ns_ = 0;
};

int run(const MonitorArguments& arguments) {
  RunEnd end;
  auto files = pad_files(arguments.map, arguments.calibration);
  if (!files) return fail("monitor", files.error().message);
  auto stream = PadStream::start({std::move(*files), arguments.wish});
  if (!stream) return fail("monitor", stream.error().message);
  end.end_after(arguments.seconds);
  MonitoredPads pads;
  Display display(arguments);
  MissingPad missing("monitor", arguments.wish);
  while (!end.is_reached() && !(*stream)->has_ended()) {
    (*stream)->wait(std::chrono::milliseconds(20));
    for (; const Report* report = (*stream)->front(); (*stream)->pop()) {
      if (take_report(*report, **stream, pads)) {
        const TraceDevice& device = (*stream)->device(report->device);
        print_remarks("monitor", {calibration_remark(device)}, &display.line());
      }
      if (end.is_reached()) break;
    }
    print_remarks("monitor", (*stream)->take_remarks(), &display.line());
    missing.look((*stream)->counts().plugged, display.line());
    for (auto& [index, pad] : pads) {
      take_silence(pad);
      if (pad.untouched == 0 || std::exchange(pad.is_warned, true)) continue;
      print_remarks("monitor", {untouched_warning(pad_name((*stream)->device(index).info))},
                    &display.line());
    }
    display.show(pads, **stream);
    if (std::fflush(stdout) != 0) break;  // main says so
  }
  display.finish(pads, **stream);
  missing.finish((*stream)->counts().plugged, display.line());
  return 0;
}

}  // namespace

void add_monitor(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("monitor", "shows live sticks, buttons, rate and latency");
  const auto arguments = std::make_shared<MonitorArguments>();
  add_pad_options(*command, arguments->wish);
  add_seconds_option(*command, arguments->seconds);
  command->add_option("--calibration", arguments->calibration, "calibration file of the stick");
  command->add_option("--map", arguments->map, "pad file that overrides config/pads");
  command->add_flag("--json", arguments->as_json, "one JSON object a pad and second");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad

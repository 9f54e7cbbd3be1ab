// gaitpad monitor [PAD]: sticks, buttons, rate and latency of live pads in the terminal.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "base/numeric.h"
#include "base/shown_number.h"
#include "gaitpad/calibration.h"
#include "gaitpad/pad_stream.h"
#include "pad_report/decode_report.h"
#include "pads/pad_meter.h"
#include "terminal/run_end.h"
#include "terminal/terminal.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

using nlohmann::ordered_json;

std::string pad_name(const DeviceInfo& info) {
  return fmt::format("{} ({})", printable(info.name),
                     info.driver.empty() ? "recording" : info.driver);
}

// The calibration in force: `PAD (DRIVER): calibration "NAME"`.
std::string calibration_remark(const TraceDevice& device) {
  const auto file = parse_calibration(device.calibration, "");
  const std::string name = file ? printable(file->name) : "";
  return fmt::format("{}: calibration \"{}\"", pad_name(device.info),
                     name.empty() ? "without a name" : name);
}

// Rates of new positions while a stick moved, since the pad was plugged in.
ordered_json movement_json(const NewValueCount& new_values) {
  const auto rate = new_values.rate();
  if (!rate) return nullptr;
  return {{"rate_hz", rate->report_hz},
          {"new_values_hz", rate->new_value_hz},
          {"repeats", rate->repeats()}};
}

ordered_json gyro_json(const GyroMeter& gyro) {
  if (!gyro.has_gyro()) return nullptr;
  ordered_json json = {{"rate_hz", gyro.sample_rate_hz()},
                       {"factory_calibration", gyro.has_factory_calibration()},
                       {"deg_s", nullptr},
                       {"bias_deg_s", nullptr},
                       {"noise_deg_s", nullptr},
                       {"rest_s", nullptr}};
  if (gyro.rates()) json["deg_s"] = in_degrees(*gyro.rates());
  if (const auto& rest = gyro.rest()) {
    json["bias_deg_s"] = in_degrees(rest->bias_rad_s);
    json["noise_deg_s"] = in_degrees(rest->noise_rad_s);
    json["rest_s"] = rest->duration_s;
  }
  return json;
}

ordered_json pad_json(std::uint16_t index, const MonitoredPad& pad, const PadStream& stream,
                      double time_s) {
  const DeviceInfo& info = stream.device(index).info;
  const Stick stick = stick_of(pad);
  const Triggers triggers = triggers_of(pad);
  const ReportWindow& w = pad.shown;
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
          {"gyro", gyro_json(pad.gyro)},
          {"battery", battery_json(pad.battery)}};
}

// The text for a pad: one line, or three if the terminal is too narrow.
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

std::string frame_text(const ReportWindow& window, std::size_t percent) {
  if (window.frame_us.empty()) return "-";
  return fmt::format("{:.1f}", percentile(window.frame_us, percent) / 1e3);
}

// New positions per second while a stick moved, and the share of repeated reports.
std::string movement_text(const NewValueCount& new_values) {
  const auto rate = new_values.rate();
  if (!rate) return fmt::format("{:>5} {:>5}", "-", "-");
  return fmt::format("{:>5.0f} {:>3.0f} %", rate->new_value_hz, 100.0 * rate->repeats());
}

// The gyroscope's samples a second; its pitch, yaw and roll while the pad lay still, and their
// noise.
std::string gyro_text(const GyroMeter& gyro) {
  if (gyro.sample_rate_hz() == 0.0) return "";
  std::string text = fmt::format(", gyro {:.0f} Hz", gyro.sample_rate_hz());
  const auto& rest = gyro.rest();
  if (!rest) return text;
  const TurnRates bias = in_degrees(rest->bias_rad_s), noise = in_degrees(rest->noise_rad_s);
  return text + fmt::format(" {} {} {} noise {:.2f} deg/s", signed_number(bias[0], 2),
                            signed_number(bias[1], 2), signed_number(bias[2], 2),
                            *std::ranges::max_element(noise));
}

PadLine pad_text(std::uint16_t index, const MonitoredPad& pad, const PadStream& stream) {
  const std::string who = pad_name(stream.device(index).info);
  if (!pad.is_plugged) return {"unplugged:", "", who};
  const Stick stick = stick_of(pad);
  const Triggers triggers = triggers_of(pad);
  const ReportWindow& w = pad.shown;
  std::string buttons;
  for (const std::string& name : button_names(pad.state)) buttons += name + " ";
  std::string battery;
  if (pad.battery)
    battery = pad.battery->percent ? fmt::format(", battery {} %", *pad.battery->percent)
                                   : ", battery " + pad.battery->level;
  return {fmt::format("{} {}  {} {}  {:.2f} {:.2f}  {:>5.0f} {:>6.2f} {:>8.1f}",
                      signed_number(stick.left.x, 2), signed_number(stick.left.y, 2),
                      signed_number(stick.right.x, 2), signed_number(stick.right.y, 2),
                      triggers.left, triggers.right, rate_hz(w), jitter(w.interval_us) / 1e3,
                      greatest(w.interval_us) / 1e3),
          fmt::format("{} {:>7.0f} {:>6.0f} {:>5} {:>6} {:>4}", movement_text(pad.new_values),
                      median(w.latency_us), greatest(w.latency_us), frame_text(w, 50),
                      frame_text(w, 99), stream.counts().lost),
          buttons + who + battery + gyro_text(pad.gyro)};
}

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kRewriteNs = kSecondNs / 60;

struct MonitorArguments {
  PadSelector selector;
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

  // Prints the last, incomplete second.
  void finish(MonitoredPads& pads, const PadStream& stream) {
    const auto is_news = [](const auto& entry) { return entry.second.running.reports > 0; };
    const std::int64_t time_ns = now_ns();
    if (is_rewritten_ || time_ns <= second_ns_ || std::ranges::none_of(pads, is_news)) return;
    end_second(pads, stream, time_ns);
    print(pads, stream, time_ns);
  }

 private:
  void end_second(MonitoredPads& pads, const PadStream& stream, std::int64_t time_ns) {
    const double duration_s = static_cast<double>(time_ns - second_ns_) / 1e9;
    for (auto& [index, pad] : pads) end_window(pad, stream.device(index).info, time_ns, duration_s);
    second_ns_ = time_ns;
  }

  void print(const MonitoredPads& pads, const PadStream& stream, std::int64_t time_ns) {
    for (const auto& [index, pad] : pads) {
      if (as_json_) {
        print_json_line(
            pad_json(index, pad, stream, static_cast<double>(time_ns - start_ns_) / 1e9));
      } else {
        constexpr std::size_t kWhole = 1000;  // columns; wide enough for one line for each pad
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
  auto stream = PadStream::start({std::move(*files), arguments.selector});
  if (!stream) return fail("monitor", stream.error().message);
  end.end_after(arguments.seconds);
  MonitoredPads pads;
  Display display(arguments);
  MissingPad missing("monitor", arguments.selector);
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
    if (std::fflush(stdout) != 0) break;  // main reports the failed write
  }
  display.finish(pads, **stream);
  missing.finish((*stream)->counts().plugged, display.line());
  return 0;
}

}  // namespace

void add_monitor(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("monitor", "shows live sticks, buttons, rate and latency");
  const auto arguments = std::make_shared<MonitorArguments>();
  add_pad_options(*command, arguments->selector);
  add_seconds_option(*command, arguments->seconds);
  command->add_option("--calibration", arguments->calibration, "calibration file of the stick");
  command->add_option("--map", arguments->map, "pad file that overrides config/pads");
  command->add_flag("--json", arguments->as_json, "print one JSON object for each pad and second");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad

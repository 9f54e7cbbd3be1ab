// gaitpad monitor [PAD]: sticks, buttons, rate and latency of live pads in the terminal.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "gaitpad/pad_stream.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/live_run.h"
#include "tools/gaitpad/pad_options.h"
#include "tools/gaitpad/pad_watch.h"
#include "tools/gaitpad/report_print.h"

namespace gaitpad {
namespace {

constexpr std::int64_t kSecondNs = 1'000'000'000;
constexpr std::int64_t kRewriteNs = kSecondNs / 20;

struct MonitorArguments {
  PadWish wish;
  std::string map, calibration;
  double seconds = 0.0;
  bool as_json = false;
};

// A line or an object a pad: in place on a terminal, else each second.
class Display {
 public:
  explicit Display(const MonitorArguments& arguments)
      : as_json_(arguments.as_json), is_rewritten_(!as_json_ && line_.is_terminal()) {}
  StatusLine& line() { return line_; }

  void show(MonitoredPads& pads, const PadStream& stream) {
    const std::int64_t time_ns = now_ns();
    if (time_ns >= second_ns_ + kSecondNs) {
      end_second(pads, time_ns);
      if (!is_rewritten_) print(pads, stream, time_ns);
    }
    if (!is_rewritten_ || time_ns < rewritten_ns_ + kRewriteNs) return;
    rewritten_ns_ = time_ns;
    std::vector<std::string> lines = {pad_header()};
    for (const auto& [index, pad] : pads) lines.push_back(pad_text(index, pad, stream));
    line_.show(lines);
  }

  // What a last, shorter second has brought.
  void finish(MonitoredPads& pads, const PadStream& stream) {
    const auto is_news = [](const auto& entry) { return entry.second.running.reports > 0; };
    const std::int64_t time_ns = now_ns();
    if (is_rewritten_ || time_ns <= second_ns_ || std::ranges::none_of(pads, is_news)) return;
    end_second(pads, time_ns);
    print(pads, stream, time_ns);
  }

 private:
  void end_second(MonitoredPads& pads, std::int64_t time_ns) {
    for (auto& [index, pad] : pads) {
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
        if (!std::exchange(has_header_, true)) fmt::print("{}\n", pad_header());
        fmt::print("{}\n", pad_text(index, pad, stream));
      }
    }
  }

  StatusLine line_{1};
  bool as_json_, is_rewritten_, has_header_ = false;
  std::int64_t start_ns_ = now_ns(), second_ns_ = start_ns_, rewritten_ns_ = 0;
};

int fail(const std::string& sentence) {
  fmt::print(stderr, "gaitpad monitor: {}\n", sentence);
  return 1;
}

int run(const MonitorArguments& arguments) {
  RunEnd end;
  auto files = pad_files(arguments.map, arguments.calibration);
  if (!files) return fail(files.error().message);
  auto stream = PadStream::start({std::move(*files), arguments.wish});
  if (!stream) return fail(stream.error().message);
  end.end_after(arguments.seconds);
  MonitoredPads pads;
  Display display(arguments);
  MissingPad missing("monitor", arguments.wish);
  while (!end.is_reached() && !(*stream)->has_ended()) {
    (*stream)->wait(std::chrono::milliseconds(20));
    for (; const Report* report = (*stream)->front(); (*stream)->pop()) {
      if (take(*report, **stream, pads)) {
        const TraceDevice& device = (*stream)->device(report->device);
        print_remarks("monitor", {calibration_remark(device)}, &display.line());
      }
      if (end.is_reached()) break;
    }
    print_remarks("monitor", (*stream)->take_remarks(), &display.line());
    missing.look((*stream)->counts().plugged, display.line());
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

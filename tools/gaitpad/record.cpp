// gaitpad record [PAD] --out FILE.hid: records one device's reports and its unplugging into a
// trace.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "gaitpad/pad_stream.h"
#include "session/recording.h"
#include "tools/gaitpad/commands.h"
#include "tools/gaitpad/options.h"
#include "tools/gaitpad/print.h"

namespace gaitpad {
namespace {

// Longest sleep between two looks for the recording's end.
constexpr std::chrono::milliseconds kRecordWait{20};

struct RecordArguments {
  PadSelector selector;
  std::string out, map, calibration;
  double seconds = 0.0;
  bool as_json = false;
};

// The result of the recording. The device is the first pad that came.
struct Recorded {
  std::uint16_t device = kNoDevice;
  std::int64_t reports = 0, unplugged = 0;
  std::int64_t first_ns = 0, last_ns = 0;
};

void take_report(const Report& report, Recording& recording, Recorded& recorded) {
  if (recorded.device == kNoDevice && report.kind == ReportKind::added)
    recorded.device = report.device;
  if (report.device != recorded.device || report.device == kNoDevice) return;
  recording.add(0, report);
  if (report.kind == ReportKind::removed) ++recorded.unplugged;
  if (report.kind != ReportKind::input) return;
  if (recorded.reports == 0) recorded.first_ns = report.time_ns;
  recorded.last_ns = report.time_ns;
  ++recorded.reports;
}

std::string status_text(const Recorded& recorded, const PadStream& stream) {
  if (recorded.device == kNoDevice) return "waiting for a pad";
  const double seconds = static_cast<double>(recorded.last_ns - recorded.first_ns) / 1e9;
  return fmt::format("{}  {:.1f} s  {} reports  lost {}",
                     printable(stream.device(recorded.device).info.name), seconds, recorded.reports,
                     stream.counts().lost);
}

Recorded record(const PadSelector& selector, RunEnd& end, PadStream& stream, Recording& recording) {
  Recorded recorded;
  StatusLine line(2);
  MissingPad missing("record", selector);
  const auto take_all = [&] {
    for (; const Report* report = stream.front(); stream.pop())
      take_report(*report, recording, recorded);
  };
  while (!end.is_reached() && !stream.has_ended() && !recording.problem()) {
    stream.wait(kRecordWait);
    take_all();
    print_remarks("record", stream.take_remarks(), &line);
    missing.look(stream.counts().plugged, line);
    line.show(status_text(recorded, stream));
  }
  take_all();
  missing.finish(stream.counts().plugged, line);
  return recorded;
}

void print_result(const RecordArguments& arguments, const Recorded& recorded,
                  const PadStream& stream, std::int64_t lost) {
  const DeviceInfo& info = stream.device(recorded.device).info;
  const double seconds = static_cast<double>(recorded.last_ns - recorded.first_ns) / 1e9;
  if (arguments.as_json) {
    print_json_line({{"file", arguments.out},
                     {"name", info.name},
                     {"driver", info.driver},
                     {"vendor", info.vendor},
                     {"product", info.product},
                     {"reports", recorded.reports},
                     {"seconds", seconds},
                     {"unplugged", recorded.unplugged},
                     {"lost", lost}});
  } else {
    say("{}: {} ({:04x}:{:04x}, {}), {} reports in {:.1f} s, {} lost\n", printable(arguments.out),
        printable(info.name), info.vendor, info.product,
        info.driver.empty() ? "a recording" : info.driver, recorded.reports, seconds, lost);
  }
}

int run(const RecordArguments& arguments) {
  RunEnd end;
  auto files = pad_files(arguments.map, arguments.calibration);
  if (!files) return fail("record", files.error().message);
  // The stream outlives the recording, which asks the stream for its devices.
  PadStreamOptions options{std::move(*files), arguments.selector};
  options.is_raw = true;
  auto stream = PadStream::start(std::move(options));
  if (!stream) return fail("record", stream.error().message);
  auto recording = Recording::start(
      {arguments.out, std::nullopt, {}},
      [&](std::uint16_t device) -> const TraceDevice& { return (*stream)->device(device); });
  if (!recording) return fail("record", recording.error().message);
  end.end_after(arguments.seconds);

  const Recorded recorded = record(arguments.selector, end, **stream, **recording);
  print_remarks("record", (*stream)->take_remarks());
  const auto remarks = (*recording)->finish(0, std::max(recorded.last_ns, now_ns()));
  if (!remarks) return fail("record", remarks.error().message);
  print_remarks("record", *remarks);
  if (recorded.device == kNoDevice) return 1;  // no pad came, as the remarks say
  print_result(arguments, recorded, **stream, (*stream)->counts().lost + (*recording)->lost());
  return 0;
}

}  // namespace

void add_record(CLI::App& app, int& status) {
  CLI::App* command = app.add_subcommand("record", "records a device into a trace (.hid)");
  const auto arguments = std::make_shared<RecordArguments>();
  add_pad_options(*command, arguments->selector);
  command->add_option("--out", arguments->out, "the file to write (.hid)")->required();
  add_seconds_option(*command, arguments->seconds);
  command->add_option("--calibration", arguments->calibration,
                      "calibration file of the stick; the recording contains it");
  command->add_option("--map", arguments->map, "pad file that overrides config/pads");
  command->add_flag("--json", arguments->as_json, "print what was recorded as JSON");
  command->callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace gaitpad
